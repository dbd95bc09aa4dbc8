/* sse.h - a parser for text/event-stream. */
#ifndef TESTS_SSE_H
#define TESTS_SSE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct sse {
    char *bytes; /* not parsed yet */
    size_t length, capacity;
    char *block; /* the block parsed last */
    char id[64]; /* the last id received, with or without an event */
    size_t idle; /* number of comments */
    size_t blocks;
} sse;

typedef struct sse_event {
    const char *name; /* "message" if the event has no name */
    const char *data; /* ends in NUL; both texts live until the next call */
} sse_event;

void sse_clear(sse *s);
void sse_add(sse *s, const char *bytes, size_t length);
/* Returns the next event that has data; false if it has not arrived completely. */
bool sse_next(sse *s, sse_event *out);

#endif
