/* http_producer.h - lets other threads make the pieces of an answer that is slow to make.
 *
 * While a piece is made, the connection is suspended and the worker thread serves other
 * connections; while a piece is sent, no further piece is made. The threads are not those of the
 * pool for long work, because a download would have to wait behind that work.
 *
 *     srv_producer_take --- returns bytes, the end or a failure: the caller sends this result
 *        ^      `------- returns SRV_PRODUCER_WAIT: the caller suspends the connection, then calls
 *        |               srv_producer_make
 *        +--- `resume` is called by a thread, exactly once, when the piece has been made */
#ifndef HE_SERVER_HTTP_HTTP_PRODUCER_H
#define HE_SERVER_HTTP_HTTP_PRODUCER_H

#include "system/thread_pool.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_PRODUCER_WAIT = -2 };

/* The state of an answer whose pieces other threads make. It is stored in the request; the caller
 * sets the members up to `resume` and uses no others. */
typedef struct srv_producer {
    int64_t (*read)(void *context, char *buffer, size_t size); /* as in api_answer */
    void *context;
    void (*resume)(struct srv_producer *producer);
    size_t size; /* bytes allocated for the last piece; 0 if no piece was made yet */
    /* The last piece; NULL if memory was out: then srv_producer_take calls `read` itself. */
    char *piece;
    size_t from, to;
    int64_t last; /* the last result of the function `read` of the answer; 0 or -1 at the end */
    bool begun;
} srv_producer;

void srv_producer_clear(srv_producer *producer);

/* Copies bytes of the piece that was made to `buffer`. Returns their number, 0 at the end of the
 * answer, -1 on failure, or SRV_PRODUCER_WAIT if the next piece must be made first. */
int64_t srv_producer_take(srv_producer *producer, char *buffer, size_t size);
/* Lets one of the threads make the next piece. Must be called after srv_producer_take returned
 * SRV_PRODUCER_WAIT; the caller must not touch the request afterwards. If the queue of the threads
 * is full, the calling thread makes the piece. */
void srv_producer_make(srv_producer *producer, st_pool *threads);

#endif
