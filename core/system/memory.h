/* memory.h - how much memory the daemon holds, and the budget it stays within.
 *
 * Everything core and api allocate comes through the hook installed here: columns at their
 * capacity, undo, snapshots, uploads, documents, answers. It is counted as the C library sees it
 * (malloc_usable_size and its word before each block), in one atomic counter. What the process
 * holds beside that is not refused to anybody, but has meshes leave earlier (resident.h).
 *
 * What would exceed the budget fails like an allocation. The last sixteenth is kept for blocks of
 * at most 64 KiB, so that a full server still answers, refuses and deletes. */
#ifndef HE_SYSTEM_MEMORY_H
#define HE_SYSTEM_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Install the hook of base/mem.h. `budget` in bytes, 0 for none. Before the first thread and the
 * first allocation. */
void st_memory_install(uint64_t budget);
void st_memory_set_budget(uint64_t budget);

/* Count `bytes` more, or fewer, that others hold for us: the kernel in sockets, libmicrohttpd for
 * connections. Never refused; what is there is only no longer there for large blocks. */
void st_memory_count(int64_t bytes);
/* What was counted so. */
uint64_t st_memory_outside(void);

/* As he_mem_resize, for a library whose work cannot be taken back where memory is refused: what is
 * beyond the budget is counted all the same. */
void *st_memory_resize_unrefused(void *memory, size_t size);

/* Somebody who may free memory that others want. */
typedef struct st_memory_giver {
    /* Tries to have `bytes` more. Called under whatever locks the thread holds, and waits for no
     * lock for long. False where nothing was freed. */
    bool (*give)(void *context, uint64_t bytes);
    void *context;
} st_memory_giver;

/* From now on the giver is asked before this thread is refused memory. NULL: nobody is. */
void st_memory_ask(const st_memory_giver *giver);

uint64_t st_memory_used(void);
uint64_t st_memory_budget(void);
/* Is there still so much, counting what is kept for small blocks? */
bool st_memory_has(uint64_t bytes);
/* Would a large block be refused now? */
bool st_memory_is_full(void);

/* The processor time of the process at the last look, and when pages were given back, in
 * microseconds. */
typedef struct st_memory_rest {
    uint64_t looked, trimmed;
} st_memory_rest;

/* Give back to the system what the C library keeps of freed blocks, once the process rests: it
 * worked for 20 ms or more since that was done, and for less than 50 ms since the last call.
 * `processor` is its processor time until now. To be called about once a second by one thread that
 * serves nobody, for it takes the lock of each heap in turn. True when it was done. */
bool st_memory_rests(st_memory_rest *rest, uint64_t processor);

#endif
