#include "server/http/http_producer.h"

#include "base/mem.h"

#include <string.h>

/* The sizes of the pieces of an answer. The first piece has FIRST_PIECE bytes and each further one
 * twice as many as the one before, up to PIECE; so little work is lost if the client reads nothing.
 * A piece of PIECE bytes takes some milliseconds to compress, and is more than a socket accepts at
 * once. */
enum { PIECE = 128 * 1024, FIRST_PIECE = 16 * 1024 };

void srv_producer_clear(srv_producer *producer)
{
    he_mem_free(producer->piece);
    producer->piece = NULL;
}

int64_t srv_producer_take(srv_producer *producer, char *buffer, size_t size)
{
    size_t left = producer->to - producer->from;
    size_t take = left < size ? left : size;
    if (take > 0) {
        memcpy(buffer, producer->piece + producer->from, take);
        producer->from += take;
        return (int64_t)take;
    }
    if (producer->begun && producer->piece == NULL) {
        return producer->read(producer->context, buffer, size);
    }
    return producer->begun && producer->last <= 0 ? producer->last : SRV_PRODUCER_WAIT;
}

static void make(void *context)
{
    srv_producer *producer = context;
    size_t size = producer->size == 0      ? FIRST_PIECE
                  : producer->size < PIECE ? 2 * producer->size
                                           : PIECE;
    if (size != producer->size) {
        he_mem_free(producer->piece);
        producer->piece = he_mem_alloc(size);
        producer->size = size;
    }
    producer->begun = true;
    if (producer->piece != NULL) {
        producer->last = producer->read(producer->context, producer->piece, producer->size);
        producer->from = 0;
        producer->to = producer->last > 0 ? (size_t)producer->last : 0;
    }
    producer->resume(producer);
}

void srv_producer_make(srv_producer *producer, st_pool *threads)
{
    if (!st_pool_submit(threads, &(st_task){.work = make, .context = producer})) {
        make(producer);
    }
}
