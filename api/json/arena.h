/* arena.h - memory that lives as long as one request.
 *
 * Blocks are taken from mem.h and given back together. What the arena hands out is aligned for any
 * type and is never freed alone. {0} is an empty arena. */
#ifndef HE_API_JSON_ARENA_H
#define HE_API_JSON_ARENA_H

#include <stddef.h>

typedef struct api_block api_block;

typedef struct api_arena {
    api_block *blocks; /* newest first */
} api_arena;

/* NULL when memory is out; the arena is then as it was. Not zeroed. */
void *api_arena_alloc(api_arena *arena, size_t size);
/* count * size bytes, NULL as well where the product does not fit. */
void *api_arena_array(api_arena *arena, size_t count, size_t size);
/* A copy that ends in NUL, NULL when memory is out. */
char *api_arena_copy(api_arena *arena, const char *bytes, size_t length);
/* Forget all that was handed out but keep the newest block for what comes next. */
void api_arena_empty(api_arena *arena);
void api_arena_clear(api_arena *arena); /* frees */

#endif
