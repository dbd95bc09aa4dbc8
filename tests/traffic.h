/* traffic.h - records the requests of tests and their answers for the last step of `make test`:
 * tests/web/check-traffic.mjs compares them with the served OpenAPI document.
 *
 * Each exchange is appended as one line of JSON to a file of this process in the folder TRAFFIC;
 * without that variable nothing is recorded. Bodies are base64, since they may be any bytes. */
#ifndef TESTS_TRAFFIC_H
#define TESTS_TRAFFIC_H

#include <stddef.h>

/* A longer body is recorded only up to this length; the recorded `length` is that of the whole
 * body. Bodies that are not JSON are not compared, so little of them is recorded. */
enum { TRAFFIC_JSON = 1 << 20, TRAFFIC_OTHER = 4 << 10 };

typedef struct traffic_message {
    const char *head; /* lines "Name: value" that end in CR LF, with or without a start line */
    const char *body; /* NULL: unknown; "": none */
    size_t length;
} traffic_message;

void traffic_record(const char *method, const char *target, const traffic_message *request,
                    long status, const traffic_message *answer);

#endif
