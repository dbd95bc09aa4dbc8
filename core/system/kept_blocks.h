/* kept_blocks.h - blocks of memory of one to eight kilobytes that each thread keeps when they are
 * freed.
 *
 * A request needs a few blocks of this size. The C library's own cache for each thread ends at
 * 1,032 bytes, and what is larger it takes from the heap that all threads share: it merges and
 * searches free blocks each time. So each thread keeps a few blocks here, and frees them when it
 * ends. If a sanitizer is used, nothing is kept, so that it finds the use of freed blocks. */
#ifndef HE_SYSTEM_KEPT_BLOCKS_H
#define HE_SYSTEM_KEPT_BLOCKS_H

#include <stddef.h>

/* Allocates a block of at least `size` bytes (> 0): one that the thread has kept, or a new one.
 * Returns NULL when memory is out. The block may be passed to realloc and free, too. */
void *st_kept_alloc(size_t size);
/* Frees a block that was allocated by st_kept_alloc, malloc or realloc, or keeps it. `memory` may
 * be NULL. */
void st_kept_free(void *memory);

#endif
