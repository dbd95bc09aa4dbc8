/* framing_cases.h - requests as bytes, with what RFC 9112 says about each and what the daemon
 * answers.
 *
 * Two tests share the table: test_srv_syntax.c passes the bytes through the state machine alone,
 * split at every position; test_framing.c sends them to a real daemon. */
#ifndef TESTS_FRAMING_CASES_H
#define TESTS_FRAMING_CASES_H

#include <stdbool.h>
#include <stddef.h>

/* A case: its bytes are `head`, then `unit` repeated `times` times, then `tail`. */
typedef struct framing_case {
    const char *name;
    const char *head;
    size_t head_length;
    const char *unit;
    int times;
    const char *tail;
    size_t tail_length;
    int status;
    const char *code; /* of the expected problem; NULL: the answer is no problem */
    bool fault;       /* the fault is found in the bytes; otherwise the handler answers */
    bool closes;      /* the connection closes, as after every fault */
} framing_case;

size_t framing_case_count(void);
const framing_case *framing_case_at(size_t i);
/* Returns the bytes of a case, which the caller must free. */
char *framing_case_bytes(const framing_case *c, size_t *length);

#endif
