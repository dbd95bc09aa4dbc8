/* sse.h - a parser for server-sent events (text/event-stream). */
#ifndef TESTS_SSE_H
#define TESTS_SSE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct sse {
    char *bytes; /* bytes that are not parsed yet */
    size_t length, capacity;
    char *block; /* the block parsed last */
    char id[64]; /* the last id received, with or without an event */
    size_t idle; /* number of comments */
    size_t blocks;
} sse;

typedef struct sse_event {
    const char *name; /* "message" if the event has no name */
    const char *data; /* NUL-terminated; both texts live until the next call */
} sse_event;

void sse_clear(sse *s);
void sse_add(sse *s, const char *bytes, size_t length);
/* Finds the next event that has data; returns false if none has arrived completely. */
bool sse_next(sse *s, sse_event *out);

#endif
