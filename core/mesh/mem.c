#include "mesh/mem.h"

#include <stdlib.h>
#include <string.h>

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

void *he_mem_resize(void *memory, size_t size)
{
    return hook.resize(hook.context, memory, size);
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

void he_ids_clear(he_ids *list)
{
    he_mem_free(list->ids);
    *list = (he_ids){0};
}

uint64_t *he_bits_new(size_t count)
{
    return he_mem_zero(count / 64 + 1, sizeof(uint64_t));
}
