/* mem.h - the allocator: all memory of core and api comes from here.
 *
 * The hook, which can replace the C library's allocator, is the only global variable of the kernel.
 * It is set once, before the first thread starts; tests install one that fails the N-th call, the
 * server one that counts bytes. Every function that frees or resizes accepts a NULL block, as free
 * and realloc do. Sizes are multiplied with an overflow check: a product that does not fit fails
 * like an allocation. A block of 4 MiB or more that the C library maps for itself (mmap) uses
 * transparent huge pages where the system has them. */
#ifndef HE_BASE_MEM_H
#define HE_BASE_MEM_H

#include "base/status.h"

#include <stddef.h>

/* The functions of an allocator. `resize` works like realloc, except that size 0 always frees the
 * block and returns NULL. */
typedef struct he_mem_hook {
    void *(*resize)(void *context, void *memory, size_t size);
    void *context;
} he_mem_hook;

/* Installs an allocator; NULL restores that of the C library. It is not thread-safe: it must be
 * called before threads start. */
void he_mem_set_hook(const he_mem_hook *hook);

void *he_mem_alloc(size_t size);
void *he_mem_resize(void *memory, size_t size);
/* Gives back what a block has beyond `size` bytes, which must not be more than it has. Returns the
 * block, which may have moved. If it cannot be shrunk, returns it as it is, so the call never
 * fails. */
void *he_mem_shrink(void *memory, size_t size);
void he_mem_free(void *memory);
/* Allocates count * size bytes, all zero; returns NULL if memory is out. */
void *he_mem_zero(size_t count, size_t size);
/* Allocates an array if `memory` is NULL, else resizes the array at `memory`. Returns NULL if
 * memory is out; the caller then still owns the old block. */
void *he_mem_array(void *memory, size_t count, size_t size);

/* Returns the capacity to which an array should grow so that `need` elements fit and appending
 * takes amortised constant time. */
size_t he_mem_grown(size_t capacity, size_t need);

/* A growable list of ids. {0} is the empty list. */
typedef struct he_ids {
    uint32_t *ids;
    size_t count, capacity;
} he_ids;

HE_NODISCARD he_status he_ids_reserve(he_ids *list, size_t extra, he_error *err);
HE_NODISCARD he_status he_ids_add(he_ids *list, uint32_t id, he_error *err);
void he_ids_reverse(he_ids *list);
/* Sorts the ids and removes repeats.
 * Returns HE_NO_MEMORY if memory is out; the list is then as it was. */
HE_NODISCARD he_status he_ids_sort(he_ids *list, he_error *err);
void he_ids_clear(he_ids *list); /* frees the array */

/* Returns a bit set with all bits zero; NULL if memory is out. */
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
