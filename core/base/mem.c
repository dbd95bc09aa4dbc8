#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>

static void *library_resize(void *context, void *memory, size_t size)
{
    (void)context;
    if (size == 0) {
        free(memory);
        return NULL;
    }
    return realloc(memory, size);
}

static he_mem_hook hook = {library_resize, NULL};

void he_mem_set_hook(const he_mem_hook *replacement)
{
    hook = replacement != NULL ? *replacement : (he_mem_hook){library_resize, NULL};
}

/* If the ids of a large mesh are in no spatial order, reading it misses the TLB as often as the
 * caches. Transparent huge pages avoid the TLB misses; the system uses huge pages only where
 * madvise asks for them. The call covers every page of the block, because the system can move a
 * mapping to grow it only if all its pages have equal flags; otherwise it must copy the bytes. */
enum { PAGE = 4096, LARGE_BLOCK = 4 << 20, HEADER = 2 * sizeof(size_t) };

static void ask_for_huge_pages(void *memory, size_t size)
{
    size_t before = (uintptr_t)memory % PAGE, length = (before + size + PAGE - 1) / PAGE * PAGE;
    if (before <= HEADER) {
        /* The result of madvise is ignored: without huge pages the program only runs slower. */
        (void)madvise((char *)memory - before, length, MADV_HUGEPAGE);
    }
}

/* Rounds the size of a large block up, so that the mapping that the C library makes for it, with
 * its header, is a whole number of huge pages. The system then puts the mapping at an address that
 * is a multiple of a huge page. When a block grows, the system often moves its mapping; it moves
 * whole huge pages only between such addresses, and otherwise breaks all of them up into small
 * pages. */
static size_t whole_huge_pages(size_t size)
{
    enum { HUGE_PAGE = 2 << 20 };
    size_t room = size + 2 * HEADER + HUGE_PAGE - 1;
    return room < size ? size : room / HUGE_PAGE * HUGE_PAGE - 2 * HEADER;
}

void *he_mem_resize(void *memory, size_t size)
{
    if (memory != NULL && size >= LARGE_BLOCK) {
        size = whole_huge_pages(size);
    }
    void *resized = hook.resize(hook.context, memory, size);
    if (size >= LARGE_BLOCK && resized != NULL) {
        ask_for_huge_pages(resized, size);
    }
    return resized;
}

/* The size is not rounded up: that could make the block larger than it is, which the memory budget
 * may refuse. */
void *he_mem_shrink(void *memory, size_t size)
{
    void *shrunk = hook.resize(hook.context, memory, size == 0 ? 1 : size);
    return shrunk == NULL ? memory : shrunk;
}

void *he_mem_alloc(size_t size)
{
    return he_mem_resize(NULL, size == 0 ? 1 : size);
}

void he_mem_free(void *memory)
{
    if (memory != NULL) {
        hook.resize(hook.context, memory, 0);
    }
}

void *he_mem_array(void *memory, size_t count, size_t size)
{
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes)) {
        return NULL;
    }
    return he_mem_resize(memory, bytes == 0 ? 1 : bytes);
}

void *he_mem_zero(size_t count, size_t size)
{
    void *memory = he_mem_array(NULL, count, size);
    if (memory != NULL) {
        memset(memory, 0, count * size);
    }
    return memory;
}

size_t he_mem_grown(size_t capacity, size_t need)
{
    size_t grown = capacity + capacity / 2;
    if (grown < capacity || grown < need) {
        grown = need;
    }
    return grown < 8 ? 8 : grown;
}

he_status he_ids_reserve(he_ids *list, size_t extra, he_error *err)
{
    if (extra <= list->capacity - list->count) {
        return HE_OK;
    }
    size_t need;
    if (__builtin_add_overflow(list->count, extra, &need)) {
        return he_fail_plain(err, HE_NO_MEMORY, "a list of ids is too long");
    }
    size_t capacity = he_mem_grown(list->capacity, need);
    uint32_t *ids = he_mem_array(list->ids, capacity, sizeof *ids);
    if (ids == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a list of %zu ids", need);
    }
    list->ids = ids;
    list->capacity = capacity;
    return HE_OK;
}

he_status he_ids_add(he_ids *list, uint32_t id, he_error *err)
{
    if (list->count == list->capacity) {
        he_status status = he_ids_reserve(list, 1, err);
        if (status != HE_OK) {
            return status;
        }
    }
    list->ids[list->count++] = id;
    return HE_OK;
}

void he_ids_reverse(he_ids *list)
{
    for (size_t i = 0, j = list->count; i + 1 < j; i++) {
        uint32_t id = list->ids[i];
        list->ids[i] = list->ids[--j];
        list->ids[j] = id;
    }
}

/* Up to FEW ids are sorted by insertion, more ids by radix sort. */
enum { FEW = 96 };

static void sort_few(uint32_t *ids, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        uint32_t id = ids[i];
        size_t k = i;
        for (; k > 0 && ids[k - 1] > id; k--) {
            ids[k] = ids[k - 1];
        }
        ids[k] = id;
    }
}

static he_status sort_many(he_ids *list, he_error *err)
{
    uint32_t *from = list->ids, *to = he_mem_array(NULL, list->capacity, sizeof *to);
    if (to == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to sort %zu ids", list->count);
    }
    for (unsigned shift = 0; shift < 32; shift += 8) {
        size_t starts[257] = {0};
        for (size_t i = 0; i < list->count; i++) {
            starts[(from[i] >> shift & 255) + 1]++;
        }
        for (size_t b = 1; b < 257; b++) {
            starts[b] += starts[b - 1];
        }
        for (size_t i = 0; i < list->count; i++) {
            to[starts[from[i] >> shift & 255]++] = from[i];
        }
        uint32_t *swap = from;
        from = to;
        to = swap;
    }
    he_mem_free(to);
    list->ids = from;
    return HE_OK;
}

static bool is_sorted(const he_ids *list)
{
    size_t i = 1;
    while (i < list->count && list->ids[i - 1] <= list->ids[i]) {
        i++;
    }
    return i == list->count;
}

he_status he_ids_sort(he_ids *list, he_error *err)
{
    if (list->count < 2) {
        return HE_OK;
    }
    if (list->count <= FEW) {
        sort_few(list->ids, list->count);
    } else if (!is_sorted(list)) {
        he_status status = sort_many(list, err);
        if (status != HE_OK) {
            return status;
        }
    }
    size_t kept = 1;
    for (size_t i = 1; i < list->count; i++) {
        if (list->ids[i] != list->ids[kept - 1]) {
            list->ids[kept++] = list->ids[i];
        }
    }
    list->count = kept;
    return HE_OK;
}

void he_ids_clear(he_ids *list)
{
    he_mem_free(list->ids);
    *list = (he_ids){0};
}

uint64_t *he_bits_new(size_t count)
{
    return he_mem_zero(count / 64 + 1, sizeof(uint64_t));
}
