/* arena.h - memory that lives as long as one request.
 *
 * Blocks come from mem.h and are freed together. Each allocation is aligned for any type and is
 * never freed alone. {0} is an empty arena. */
#ifndef HE_API_JSON_ARENA_H
#define HE_API_JSON_ARENA_H

#include <stddef.h>

typedef struct api_block api_block;

typedef struct api_arena {
    api_block *blocks; /* list of blocks, the newest first */
} api_arena;

/* Returns `size` bytes of memory, which is not zeroed. Returns NULL, with the arena unchanged, when
 * memory is out. */
void *api_arena_alloc(api_arena *arena, size_t size);
/* Allocates count * size bytes. Returns NULL also when the product overflows. */
void *api_arena_array(api_arena *arena, size_t count, size_t size);
/* Returns a copy of `bytes` that ends in NUL, or NULL when memory is out. */
char *api_arena_copy(api_arena *arena, const char *bytes, size_t length);
/* Invalidates all allocations of the arena, but keeps its newest block of memory for later
 * allocations. */
void api_arena_empty(api_arena *arena);
void api_arena_clear(api_arena *arena); /* frees all blocks */

#endif
