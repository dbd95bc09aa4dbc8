/* memory.h - counts the memory of the daemon and keeps it within a budget.
 *
 * core and api allocate all their memory through a function that is installed here: arrays of mesh
 * elements at their full capacity, undo, snapshots, uploads, documents, answers. One atomic counter
 * counts the true sizes of blocks: malloc_usable_size and the word that the C library stores before
 * each block. Other memory of the process never causes a refusal, but makes the store evict meshes
 * earlier (resident.h).
 *
 * An allocation beyond the budget fails. The last sixteenth is reserved for blocks of at most 64
 * KiB, so that a server whose memory is full can still answer requests, refuse them and delete
 * meshes. */
#ifndef HE_SYSTEM_MEMORY_H
#define HE_SYSTEM_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Installs the function by which base/mem.h allocates. `budget` is in bytes, 0 for no limit. Must
 * be called before the first thread and the first allocation. */
void st_memory_install(uint64_t budget);
void st_memory_set_budget(uint64_t budget);

/* Counts memory that is not allocated through base/mem.h: memory that the system uses for sockets,
 * and libmicrohttpd for connections. `bytes` are added, or subtracted if negative. Such memory is
 * never refused, but leaves less of the budget for large blocks. */
void st_memory_count(int64_t bytes);
/* Returns the bytes that st_memory_count has added. */
uint64_t st_memory_outside(void);

/* Resizes a block like he_mem_resize, but is not refused when the budget is exceeded; the block is
 * counted all the same. Needed for a library (SQLite) that cannot undo its work if memory is
 * refused. */
void *st_memory_resize_unrefused(void *memory, size_t size);

/* A giver: a function that may free memory when an allocation of a thread would be refused. */
typedef struct st_memory_giver {
    /* Tries to free `bytes`. It is called under any locks that the thread holds, so it must not
     * wait long for a lock. Returns false if nothing was freed. */
    bool (*give)(void *context, uint64_t bytes);
    void *context;
} st_memory_giver;

/* Sets the giver, the function that is called before the calling thread is refused memory; NULL
 * means that no function is called. */
void st_memory_ask(const st_memory_giver *giver);

uint64_t st_memory_used(void);
uint64_t st_memory_budget(void);
/* Returns true if `bytes` bytes of the budget are free, including the part that is reserved for
 * small blocks. */
bool st_memory_has(uint64_t bytes);
/* Returns true if a block slightly larger than those for which the last part of the budget is
 * reserved would be refused now. */
bool st_memory_is_full(void);
/* Returns true if the last block that was refused was refused by the budget, and not by the C
 * library. All threads share this value, because one thread may allocate for the request of
 * another. */
bool st_memory_was_over_budget(void);
/* Memory is short when a block of one 64th of the budget would be refused, not only when all of the
 * budget is used: requests that need large blocks never use up all memory, because the block that
 * would do so is refused. */
enum { ST_MEMORY_SHORT_SHARE = 64 };
bool st_memory_is_short(void);

/* What st_memory_rests remembers: the processor time of the process, in microseconds, at the last
 * call (`looked`) and when memory was last returned to the system (`trimmed`). */
typedef struct st_memory_rest {
    uint64_t looked, trimmed;
} st_memory_rest;

/* Returns memory of freed blocks, which the C library keeps, to the system when the process is
 * idle: when the process used 20 ms or more of processor time since memory was last returned, and
 * less than 50 ms since the last call. `processor` is the processor time that the process has used
 * so far. The function must be called about once a second by a thread that serves no request,
 * because it takes the lock of each of the C library's heaps in turn. Returns true if memory was
 * returned. */
bool st_memory_rests(st_memory_rest *rest, uint64_t processor);

#endif
