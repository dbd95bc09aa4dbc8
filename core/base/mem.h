/* mem.h - every byte core holds comes from here.
 *
 * The hook is the only global in core. It is set once, before the first thread; tests install
 * one that fails the N-th call, the server one that counts. All functions accept NULL where free
 * does. Sizes are multiplied with an overflow check: a product that does not fit fails like an
 * allocation. Blocks of 4 MiB and more that are a mapping of their own are put on huge pages where
 * the system offers them. */
#ifndef HE_BASE_MEM_H
#define HE_BASE_MEM_H

#include "base/status.h"

#include <stddef.h>

/* realloc with its meaning fixed: size 0 frees and returns NULL. */
typedef struct he_mem_hook {
    void *(*resize)(void *context, void *memory, size_t size);
    void *context;
} he_mem_hook;

/* NULL restores the C library's allocator. Not thread-safe: call before threads start. */
void he_mem_set_hook(const he_mem_hook *hook);

void *he_mem_alloc(size_t size);
void *he_mem_resize(void *memory, size_t size);
void he_mem_free(void *memory);
/* count * size bytes, zeroed. */
void *he_mem_zero(size_t count, size_t size);
/* Grow or make an array: on failure NULL, and the old block is still the caller's. */
void *he_mem_array(void *memory, size_t count, size_t size);

/* The capacity to grow to so that `need` fits and appending stays amortised constant. */
size_t he_mem_grown(size_t capacity, size_t need);

/* A growable list of ids, used for every answer of unknown length. {0} is empty. */
typedef struct he_ids {
    uint32_t *ids;
    size_t count, capacity;
} he_ids;

HE_NODISCARD he_status he_ids_reserve(he_ids *list, size_t extra, he_error *err);
HE_NODISCARD he_status he_ids_add(he_ids *list, uint32_t id, he_error *err);
void he_ids_reverse(he_ids *list);
/* In rising order, each id once. On HE_NO_MEMORY the list is as it was. */
HE_NODISCARD he_status he_ids_sort(he_ids *list, he_error *err);
void he_ids_clear(he_ids *list); /* frees */

/* A set of bits, all zero at first. NULL when memory is out. */
uint64_t *he_bits_new(size_t count);
static inline int he_bits_get(const uint64_t *bits, size_t i)
{
    return (int)(bits[i >> 6] >> (i & 63) & 1);
}
static inline void he_bits_set(uint64_t *bits, size_t i)
{
    bits[i >> 6] |= (uint64_t)1 << (i & 63);
}

#endif
