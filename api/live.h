/* live.h - an answer without a known end, such as a stream of events.
 *
 * The server reads pieces of the answer from its source, which may have nothing to send at the
 * moment. The server then suspends the connection until the source calls `wake`, and reads again:
 *
 *       start            once, before the first read
 *         |
 *       read  --> bytes -------------> read ...
 *         |   --> API_READ_WAIT -----> (suspended) ... wake, once ... read ...
 *         |   --> 0                    the end
 *       finish           the server is about to stop: the next reads give a closing message and
 *         |              the end, without waiting
 *       free
 *
 * start, read, finish and free are called by one thread at a time. wake may be called from any
 * thread: at most once for each API_READ_WAIT, and once more when the client's token is revoked. It
 * is never called from inside one of the four functions, and never after free has returned. */
#ifndef HE_API_LIVE_H
#define HE_API_LIVE_H

#include <stddef.h>
#include <stdint.h>

/* result of `read`: there is nothing to send now, but more will come */
enum { API_READ_WAIT = -2 };

typedef struct api_source {
    void *self;
    void (*start)(void *self, void (*wake)(void *context), void *context);
    /* Reads up to `size` bytes without blocking. Returns their number, 0 at the end, API_READ_WAIT,
     * or -1 on failure. */
    int64_t (*read)(void *self, char *buffer, size_t size);
    void (*finish)(void *self);
    void (*free)(void *self);
    const char *idle; /* a literal that is sent now and then to keep an idle connection open */
} api_source;

#endif
