/* spare.h - keeps a few freed blocks of one size for the next users.
 *
 * The C library serves blocks of up to 1,032 bytes from a cache of each thread. For a larger block,
 * such as the state of a request, it first merges all small blocks that were freed before, and then
 * searches; after many edits that took a tenth of the time of a small request. Kept blocks count as
 * used memory, like all blocks of base/mem.h, but none is kept while memory is full. */
#ifndef HE_SYSTEM_SPARE_H
#define HE_SYSTEM_SPARE_H

#include <stdatomic.h>
#include <stddef.h>

enum { ST_SPARES = 4 };

/* {0} keeps no blocks. All functions but st_spares_clear may be called from several threads. */
typedef struct st_spares {
    _Atomic(void *) blocks[ST_SPARES];
} st_spares;

/* Returns a block that was kept, or else a new block of `size` bytes; its bytes are undefined. All
 * calls for the same st_spares must have the same size. Returns NULL when memory is out. */
void *st_spares_take(st_spares *spares, size_t size);
/* Keeps a block that st_spares_take has returned, or frees it if enough are kept. */
void st_spares_put(st_spares *spares, void *block);
/* Frees the blocks that are kept. */
void st_spares_clear(st_spares *spares);

#endif
