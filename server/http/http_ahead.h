/* http_ahead.h - answers whose bytes take their time to make: made ahead, on threads of their own.
 *
 * While a piece is made the connection is suspended and the worker serves others; while it is sent
 * nothing is made. The threads are not those of long work, behind which a download would stand
 * still.
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

/* In the storage of the request. The rest is the module's. */
typedef struct srv_ahead {
    int64_t (*read)(void *context, char *buffer, size_t size); /* as in api_answer */
    void *context;
    void (*resume)(struct srv_ahead *ahead);
    size_t size; /* of the piece that was made last, 0: none was */
    char *piece; /* NULL without memory: then it is made as it is taken */
    size_t from, to;
    int64_t last; /* of read: 0 or -1 when there is no more */
    bool begun;
} srv_ahead;

void srv_ahead_clear(srv_ahead *ahead);

/* Bytes that were made, 0 at the end, -1 on failure, or SRV_AHEAD_WAIT. */
int64_t srv_ahead_take(srv_ahead *ahead, char *buffer, size_t size);
/* After SRV_AHEAD_WAIT. The caller touches nothing of the request after that. Where too much
 * waits for the threads it is made here. */
void srv_ahead_make(srv_ahead *ahead, st_pool *threads);

#endif
