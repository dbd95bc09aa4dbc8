/* framing_cases.h - requests as bytes: what RFC 9112 says of each, and what the daemon answers.
 *
 * The table serves two tests: test_srv_syntax.c takes the bytes through the state machine alone,
 * cut at every place, test_framing.c sends them to a real daemon. */
#ifndef TESTS_FRAMING_CASES_H
#define TESTS_FRAMING_CASES_H

#include <stdbool.h>
#include <stddef.h>

/* The bytes are `head`, then `unit` so many `times`, then `tail`. */
typedef struct framing_case {
    const char *name;
    const char *head;
    size_t head_length;
    const char *unit;
    int times;
    const char *tail;
    size_t tail_length;
    int status;
    const char *code; /* of the problem; NULL: none is answered */
    bool fault;       /* found in the bytes, before the handler; else the handler answers */
    bool closes;      /* the connection; every fault does */
} framing_case;

size_t framing_case_count(void);
const framing_case *framing_case_at(size_t i);
/* The caller's to free. */
char *framing_case_bytes(const framing_case *c, size_t *length);

#endif
