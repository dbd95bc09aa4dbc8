/* sse.h - a parser for server-sent events (text/event-stream). */
#ifndef TESTS_SSE_H
#define TESTS_SSE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct sse {
    char *bytes; /* bytes of the event stream that were received but not parsed yet */
    size_t length, capacity;
    char *block; /* lines of the event that was parsed last */
    char id[64]; /* id in the last `id:` line, even if that block had no data */
    size_t idle; /* number of comments received */
    size_t blocks;
} sse;

typedef struct sse_event {
    const char *name; /* name of the event; "message" if it has none */
    /* Data of the event, NUL-terminated; name and data are valid until the next call. */
    const char *data;
} sse_event;

void sse_clear(sse *s);
void sse_add(sse *s, const char *bytes, size_t length);
/* Finds the next event that has data; returns false if no such event has arrived completely. */
bool sse_next(sse *s, sse_event *out);

#endif
