/* framing_cases.h - requests as bytes, each with the answer that the daemon must give according to
 * RFC 9112.
 *
 * Two tests share the table: test_srv_syntax.c passes the bytes through the request parser alone,
 * split at every position; test_framing.c sends them to a real daemon. */
#ifndef TESTS_FRAMING_CASES_H
#define TESTS_FRAMING_CASES_H

#include <stdbool.h>
#include <stddef.h>

/* A case. The bytes of its request are `head`, then `unit` repeated `times` times, then `tail`. */
typedef struct framing_case {
    const char *name;
    const char *head;
    size_t head_length;
    const char *unit;
    int times;
    const char *tail;
    size_t tail_length;
    int status;
    const char *code; /* error code of the expected problem; NULL: the answer is no problem */
    bool fault;       /* whether the framing (where the request ends) is faulty; if not, the request
                         reaches a handler */
    /* Whether the daemon must close the connection, as it does after every fault. */
    bool closes;
} framing_case;

size_t framing_case_count(void);
const framing_case *framing_case_at(size_t i);
/* Returns the bytes of a case, which the caller must free. */
char *framing_case_bytes(const framing_case *c, size_t *length);

#endif
