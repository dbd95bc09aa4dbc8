#include "api/header/compression.h"

#include "base/mem.h"

#include <stdint.h>

/* A header that precedes each block, so that the size of the block is known when it is freed. */
typedef union head {
    size_t size;
    max_align_t align;
} head;

static void give_back(void *context, void *block)
{
    api_compression_memory *memory = context;
    if (block != NULL) {
        head *h = (head *)block - 1;
        if (memory != NULL) {
            atomic_fetch_sub_explicit(memory->lent, h->size, memory_order_relaxed);
        }
        he_mem_free(h);
    }
}

/* Counts an allocation if the sum stays below the ceiling. The function compares and adds in one
 * atomic step, so that two threads cannot exceed the ceiling together, and the counter never
 * includes an allocation that was refused. */
static bool fits(api_compression_memory *memory, size_t size)
{
    size_t lent = atomic_load_explicit(memory->lent, memory_order_relaxed);
    do {
        if (size > memory->most || lent > memory->most - size) {
            return false;
        }
    } while (!atomic_compare_exchange_weak_explicit(memory->lent, &lent, lent + size,
                                                    memory_order_relaxed, memory_order_relaxed));
    return true;
}

static bool lend(api_compression_memory *memory, size_t size)
{
    bool lent = fits(memory, size);
    while (!lent && size <= memory->most && memory->make_room(memory->context)) {
        lent = fits(memory, size);
    }
    memory->refused = memory->refused || !lent;
    return lent;
}

static void *take(void *context, size_t size)
{
    api_compression_memory *memory = context;
    if (size > SIZE_MAX - sizeof(head)) {
        return NULL;
    }
    size += sizeof(head);
    if (memory != NULL && !lend(memory, size)) {
        return NULL;
    }
    head *h = he_mem_alloc(size);
    if (h == NULL) {
        if (memory != NULL) {
            atomic_fetch_sub_explicit(memory->lent, size, memory_order_relaxed);
        }
        return NULL;
    }
    h->size = size;
    return h + 1;
}

static void *zlib_take(void *context, unsigned count, unsigned size)
{
    /* `count` and `size` have 32 bits, so their product does not overflow. */
    return take(context, (size_t)count * size);
}

void api_compression_zlib(z_stream *stream, api_compression_memory *memory)
{
    *stream = (z_stream){.zalloc = zlib_take, .zfree = give_back, .opaque = memory};
}

ZSTD_customMem api_compression_zstd(api_compression_memory *memory)
{
    return (ZSTD_customMem){take, give_back, memory};
}
