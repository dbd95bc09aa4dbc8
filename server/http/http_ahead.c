#include "server/http/http_ahead.h"

#include "base/mem.h"

#include <string.h>

/* The sizes of the pieces of an answer. The first piece has FIRST_PIECE bytes and each further one
 * twice as many as the one before, up to PIECE; so little work is lost if the client reads nothing.
 * A piece of PIECE bytes takes some milliseconds to compress, and is more than a socket accepts at
 * once. */
enum { PIECE = 128 * 1024, FIRST_PIECE = 16 * 1024 };

void srv_ahead_clear(srv_ahead *ahead)
{
    he_mem_free(ahead->piece);
    ahead->piece = NULL;
}

int64_t srv_ahead_take(srv_ahead *ahead, char *buffer, size_t size)
{
    size_t left = ahead->to - ahead->from;
    size_t take = left < size ? left : size;
    if (take > 0) {
        memcpy(buffer, ahead->piece + ahead->from, take);
        ahead->from += take;
        return (int64_t)take;
    }
    if (ahead->begun && ahead->piece == NULL) {
        return ahead->read(ahead->context, buffer, size);
    }
    return ahead->begun && ahead->last <= 0 ? ahead->last : SRV_AHEAD_WAIT;
}

static void make(void *context)
{
    srv_ahead *ahead = context;
    size_t size = ahead->size == 0 ? FIRST_PIECE : ahead->size < PIECE ? 2 * ahead->size : PIECE;
    if (size != ahead->size) {
        he_mem_free(ahead->piece);
        ahead->piece = he_mem_alloc(size);
        ahead->size = size;
    }
    ahead->begun = true;
    if (ahead->piece != NULL) {
        ahead->last = ahead->read(ahead->context, ahead->piece, ahead->size);
        ahead->from = 0;
        ahead->to = ahead->last > 0 ? (size_t)ahead->last : 0;
    }
    ahead->resume(ahead);
}

void srv_ahead_make(srv_ahead *ahead, st_pool *threads)
{
    if (!st_pool_submit(threads, &(st_task){.work = make, .context = ahead})) {
        make(ahead);
    }
}
