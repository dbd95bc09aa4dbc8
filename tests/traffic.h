/* traffic.h - records the requests of tests and their answers. In the last step of `make test`,
 * tests/web/check-traffic.mjs compares them with the served OpenAPI document.
 *
 * Each request with its answer is appended as one line of JSON to a file in the folder that the
 * environment variable TRAFFIC names; each process has a file of its own. Without the variable
 * nothing is recorded. Bodies are written in base64, because they may be any bytes. */
#ifndef TESTS_TRAFFIC_H
#define TESTS_TRAFFIC_H

#include <stddef.h>

/* The number of bytes that are recorded of a body; the recorded `length` is that of the whole body.
 * Bodies that are not JSON are not compared, so little of them is recorded. */
enum { TRAFFIC_JSON = 1 << 20, TRAFFIC_OTHER = 4 << 10 };

typedef struct traffic_message {
    /* The head of the message: lines "Name: value" that each end in CR LF; a request or status line
     * may come first. */
    const char *head;
    const char *body; /* the body of the message; NULL: unknown; "": there is none */
    size_t length;
} traffic_message;

void traffic_record(const char *method, const char *target, const traffic_message *request,
                    long status, const traffic_message *answer);

#endif
