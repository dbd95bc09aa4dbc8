/* traffic.h - what a test asked and was told, for the last step of `make test`:
 * tests/web/check-traffic.mjs compares it with the served OpenAPI document.
 *
 * One line of JSON an exchange is appended to a file of this process in the folder TRAFFIC; without
 * that variable nothing is kept. Bodies are base64, since they may be any bytes. */
#ifndef TESTS_TRAFFIC_H
#define TESTS_TRAFFIC_H

#include <stddef.h>

/* Of a longer body this much is kept, and `length` beside it says that there was more. What is not
 * JSON is not looked into. */
enum { TRAFFIC_JSON = 1 << 20, TRAFFIC_OTHER = 4 << 10 };

typedef struct traffic_message {
    const char *head; /* "Name: value" lines that end in CR LF, a start line before them or not */
    const char *body; /* NULL: not known; "": none */
    size_t length;
} traffic_message;

void traffic_record(const char *method, const char *target, const traffic_message *request,
                    long status, const traffic_message *answer);

#endif
