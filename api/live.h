/* live.h - an answer that goes on: what a client listens to.
 *
 * A source is pulled like any stream, but may have nothing to give at the moment. The server then
 * puts the connection aside until the source calls `wake`, and pulls again:
 *
 *       start            once, before the first read
 *         |
 *       read  --> bytes -------------> read ...
 *         |   --> API_READ_WAIT -----> (aside) ... wake, once ... read ...
 *         |   --> 0                    the end
 *       finish           the server is about to stop: what is read from here on says goodbye and
 *         |              ends, without waiting
 *       free
 *
 * start, read, finish and free are called by one thread at a time. wake is called from any thread,
 * at most once for each API_READ_WAIT and once more when the client's token is dropped, never from
 * inside one of the four, and never after free has returned. */
#ifndef HE_API_LIVE_H
#define HE_API_LIVE_H

#include <stddef.h>
#include <stdint.h>

enum { API_READ_WAIT = -2 }; /* of read: nothing now, but more will come */

typedef struct api_source {
    void *self;
    void (*start)(void *self, void (*wake)(void *context), void *context);
    /* Up to `size` bytes; 0 at the end, API_READ_WAIT, or -1 on failure. Does not block. */
    int64_t (*read)(void *self, char *buffer, size_t size);
    void (*finish)(void *self);
    void (*free)(void *self);
} api_source;

#endif
