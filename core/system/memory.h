/* memory.h - counts the memory of the daemon and keeps it within a budget.
 *
 * Everything core and api allocate comes through the hook installed here: columns at their
 * capacity, undo, snapshots, uploads, documents, answers. It is counted as the C library sees it
 * (malloc_usable_size and its word before each block), in one atomic counter. Memory that the
 * process holds beside that never refuses an allocation, but makes the store evict meshes earlier
 * (resident.h).
 *
 * An allocation beyond the budget fails. The last sixteenth is reserved for blocks of at most 64
 * KiB, so that a full server still answers, refuses and deletes. */
#ifndef HE_SYSTEM_MEMORY_H
#define HE_SYSTEM_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Installs the hook of base/mem.h. `budget` is in bytes, 0 for none. Must be called before the
 * first thread and the first allocation. */
void st_memory_install(uint64_t budget);
void st_memory_set_budget(uint64_t budget);

/* Counts memory that does not come from the hook: the kernel's for sockets, libmicrohttpd's for
 * connections. `bytes` are added, or subtracted if negative. Such memory is never refused, but
 * leaves less for large blocks. */
void st_memory_count(int64_t bytes);
/* Returns the memory counted by st_memory_count. */
uint64_t st_memory_outside(void);

/* Resizes like he_mem_resize, for a library that cannot undo its work if memory is refused: a block
 * beyond the budget is allocated and counted, too. */
void *st_memory_resize_unrefused(void *memory, size_t size);

/* A function that may free memory for a thread that needs it. */
typedef struct st_memory_giver {
    /* Tries to free `bytes`. It is called under any locks that the thread holds, so it must not
     * wait long for a lock. Returns false if nothing was freed. */
    bool (*give)(void *context, uint64_t bytes);
    void *context;
} st_memory_giver;

/* Sets the function that is called before this thread is refused memory; NULL sets none. */
void st_memory_ask(const st_memory_giver *giver);

uint64_t st_memory_used(void);
uint64_t st_memory_budget(void);
/* Returns true if this much memory is free, including the part that is reserved for small
 * blocks. */
bool st_memory_has(uint64_t bytes);
/* Returns true if a block that is barely large would be refused now. */
bool st_memory_is_full(void);
/* Returns true if the budget refused the last block that was refused, and not the C library.
 * Threads are not told apart: a block may be refused to a thread that works for another one. */
bool st_memory_was_over_budget(void);
/* Returns true if a block of this share of the budget would be refused now. Where requests need
 * large blocks, memory that is used up never becomes full: the block that would fill it is
 * refused. */
enum { ST_MEMORY_SHORT_SHARE = 64 };
bool st_memory_is_short(void);

/* What st_memory_rests remembers: the processor time of the process at its last call, and when
 * memory was last returned; in microseconds. */
typedef struct st_memory_rest {
    uint64_t looked, trimmed;
} st_memory_rest;

/* Returns memory of freed blocks, which the C library keeps, to the system once the process is
 * idle: it worked for 20 ms or more since the last time, and for less than 50 ms since the last
 * call. `processor` is its processor time until now. Must be called about once a second by a thread
 * that serves no request, because it takes the lock of each heap in turn. Returns true if memory
 * was returned. */
bool st_memory_rests(st_memory_rest *rest, uint64_t processor);

#endif
