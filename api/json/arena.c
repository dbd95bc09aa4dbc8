#include "api/json/arena.h"

#include "base/mem.h"

#include <stdalign.h>
#include <stdint.h>
#include <string.h>

/* The size of the first block, which holds all texts of an ordinary request, and the most by which
 * a block may be larger than needed. The first block with its header is small enough for malloc to
 * serve it from the thread's own cache, without a lock or a search. */
enum { FIRST_BLOCK = 1024 - 64, LARGEST_STEP = 1 << 20 };

struct api_block {
    api_block *older;
    size_t used, size; /* size: number of bytes in `bytes`; used: how many of them were allocated */
    alignas(max_align_t) unsigned char bytes[];
};

void *api_arena_alloc(api_arena *arena, size_t size)
{
    const size_t align = alignof(max_align_t);
    if (size > SIZE_MAX / 2) {
        return NULL;
    }
    size = (size + align - 1) / align * align;
    api_block *block = arena->blocks;
    if (block == NULL || size > block->size - block->used) {
        /* Doubling the size of blocks keeps their number small; the maximum limits unused space. */
        size_t room = block == NULL ? FIRST_BLOCK : block->size * 2;
        room = room > LARGEST_STEP ? LARGEST_STEP : room;
        room = room < size ? size : room;
        block = he_mem_alloc(sizeof *block + room);
        if (block == NULL) {
            return NULL;
        }
        *block = (api_block){.older = arena->blocks, .size = room};
        arena->blocks = block;
    }
    void *memory = block->bytes + block->used;
    block->used += size;
    return memory;
}

void *api_arena_array(api_arena *arena, size_t count, size_t size)
{
    size_t total;
    return __builtin_mul_overflow(count, size, &total) ? NULL : api_arena_alloc(arena, total);
}

char *api_arena_copy(api_arena *arena, const char *bytes, size_t length)
{
    char *copy = api_arena_alloc(arena, length + 1);
    if (copy != NULL) {
        if (length > 0) {
            memcpy(copy, bytes, length);
        }
        copy[length] = '\0';
    }
    return copy;
}

static void free_from(api_block *block)
{
    while (block != NULL) {
        api_block *older = block->older;
        he_mem_free(block);
        block = older;
    }
}

void api_arena_empty(api_arena *arena)
{
    if (arena->blocks != NULL) {
        free_from(arena->blocks->older);
        arena->blocks->older = NULL;
        arena->blocks->used = 0;
    }
}

void api_arena_clear(api_arena *arena)
{
    free_from(arena->blocks);
    arena->blocks = NULL;
}
