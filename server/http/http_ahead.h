/* http_ahead.h - answers that are slow to make: other threads make them ahead.
 *
 * While a piece is made the connection is suspended and the worker serves others; while a piece is
 * sent, no other one is made. The threads are not those of long work, because a download would have
 * to wait behind that.
 *
 *     srv_ahead_take ---- bytes, the end or a failure: send that
 *        ^      `-------- SRV_AHEAD_WAIT: suspend the connection, then srv_ahead_make
 *        +--- resume, by a thread, exactly once, when a piece is there */
#ifndef HE_SERVER_HTTP_HTTP_AHEAD_H
#define HE_SERVER_HTTP_HTTP_AHEAD_H

#include "system/thread_pool.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_AHEAD_WAIT = -2 };

/* An answer that is made ahead. It is stored in the request; the caller uses only the members up to
 * `resume`. */
typedef struct srv_ahead {
    int64_t (*read)(void *context, char *buffer, size_t size); /* as in api_answer */
    void *context;
    void (*resume)(struct srv_ahead *ahead);
    size_t size; /* of the last piece; 0: none was made */
    char *piece; /* NULL without memory: each piece is then made when it is taken */
    size_t from, to;
    int64_t last; /* the last result of `read`: 0 or -1 at the end */
    bool begun;
} srv_ahead;

void srv_ahead_clear(srv_ahead *ahead);

/* Takes the piece that was made. Returns the number of bytes, 0 at the end, -1 on failure, or
 * SRV_AHEAD_WAIT if the next piece must be made first. */
int64_t srv_ahead_take(srv_ahead *ahead, char *buffer, size_t size);
/* Makes the next piece, after SRV_AHEAD_WAIT. The caller must not touch the request afterwards. If
 * the queue of the threads is full, the piece is made by the calling thread. */
void srv_ahead_make(srv_ahead *ahead, st_pool *threads);

#endif
