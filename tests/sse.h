/* sse.h - a reader of text/event-stream: bytes in, events out. */
#ifndef TESTS_SSE_H
#define TESTS_SSE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct sse {
    char *bytes; /* not yet read */
    size_t length, capacity;
    char *block; /* the one read last */
    char id[64]; /* the last that came, with an event or without */
    size_t idle; /* comments */
    size_t blocks;
} sse;

typedef struct sse_event {
    const char *name; /* "message" where none was said */
    const char *data; /* ends in NUL; both until the next call */
} sse_event;

void sse_clear(sse *s);
void sse_add(sse *s, const char *bytes, size_t length);
/* The next event that has data; false when it has not come as a whole. */
bool sse_next(sse *s, sse_event *out);

#endif
