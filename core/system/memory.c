#include "system/memory.h"

#include "base/mem.h"

#include <malloc.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { SMALL = 64 * 1024, RESERVE_SHARE = 16 };

static _Atomic uint64_t used;
static _Atomic uint64_t outside; /* how many of the used bytes were counted by st_memory_count */
static _Atomic uint64_t budget_bytes;
/* True if the last allocation that failed was refused by the memory budget; false if it was refused
 * by the C library. */
static _Atomic bool over_budget;
static _Thread_local bool is_unrefused;
static _Thread_local const st_memory_giver *asked;

/* Adds `size` bytes to the used bytes, unless that exceeds the budget. The bytes are added first
 * and subtracted again if the sum is too large, so that two threads cannot exceed the budget
 * together. */
static bool try_take(size_t size)
{
    uint64_t budget = atomic_load_explicit(&budget_bytes, memory_order_relaxed);
    uint64_t after = atomic_fetch_add_explicit(&used, size, memory_order_relaxed) + size;
    if (budget == 0 || is_unrefused) {
        return true;
    }
    uint64_t limit = size <= SMALL ? budget : budget - budget / RESERVE_SHARE;
    if (after <= limit) {
        return true;
    }
    atomic_fetch_sub_explicit(&used, size, memory_order_relaxed);
    return false;
}

/* Takes `size` bytes from the memory budget. If too few bytes are left, first calls the giver of
 * this thread, a function that frees memory. If the giver itself allocates memory, it is not called
 * again. */
static bool take(size_t size)
{
    const st_memory_giver *giver = asked;
    bool taken = try_take(size);
    if (!taken && giver != NULL) {
        asked = NULL;
        taken = giver->give(giver->context, size) && try_take(size);
        asked = giver;
    }
    return taken;
}

void st_memory_ask(const st_memory_giver *giver)
{
    asked = giver;
}

static void give_back(size_t size)
{
    atomic_fetch_sub_explicit(&used, size, memory_order_relaxed);
}

/* Returns the bytes of a block of memory, including the word that the C library stores before
 * it. */
static size_t block_bytes(void *memory)
{
    return malloc_usable_size(memory) + sizeof(size_t);
}

/* Changes the size of a block of memory. How many bytes the new block takes is known only
 * afterwards, so the requested growth is first taken from the budget and then corrected. */
static void *resize(void *context, void *memory, size_t size)
{
    (void)context;
    size_t before = memory == NULL ? 0 : block_bytes(memory);
    if (size == 0) {
        free(memory);
        give_back(before);
        return NULL;
    }
    size_t growth = size > before ? size - before : 0;
    if (growth > 0 && !take(growth)) {
        atomic_store_explicit(&over_budget, true, memory_order_relaxed);
        return NULL;
    }
    void *resized = realloc(memory, size);
    if (resized == NULL) {
        atomic_store_explicit(&over_budget, false, memory_order_relaxed);
        give_back(growth);
        return NULL;
    }
    size_t after = block_bytes(resized);
    /* The subtraction is unsigned and wraps around, so adding its result is right even if the block
     * has become smaller. */
    atomic_fetch_add_explicit(&used, (uint64_t)after - before - growth, memory_order_relaxed);
    return resized;
}

/* The C library gives a block of at least this size its own mapping (mmap). Such a block grows by
 * moving page tables and not bytes, so the first edit of a large mesh does not copy the mesh; and
 * its memory returns to the system when it is freed. Without this setting, glibc raises the limit
 * up to 32 MB as blocks are freed. */
enum { OWN_MAPPING_BYTES = 1 << 20 };

/* The C library keeps so many free bytes at the end of its heap instead of returning them to the
 * system. An operation allocates and frees tables of some 100 KB again and again, and each time
 * they came from the system, that would clear their pages. */
enum { KEPT_BYTES = 2 << 20 };

void st_memory_install(uint64_t budget)
{
    mallopt(M_MMAP_THRESHOLD, OWN_MAPPING_BYTES);
    mallopt(M_TRIM_THRESHOLD, KEPT_BYTES);
    st_memory_set_budget(budget);
    he_mem_set_hook(&(he_mem_hook){resize, NULL});
}

void st_memory_set_budget(uint64_t budget)
{
    atomic_store(&budget_bytes, budget);
}

void st_memory_count(int64_t bytes)
{
    /* The addition is unsigned and wraps around, so adding a negative number subtracts. */
    atomic_fetch_add_explicit(&used, (uint64_t)bytes, memory_order_relaxed);
    atomic_fetch_add_explicit(&outside, (uint64_t)bytes, memory_order_relaxed);
}

uint64_t st_memory_outside(void)
{
    return atomic_load_explicit(&outside, memory_order_relaxed);
}

void *st_memory_resize_unrefused(void *memory, size_t size)
{
    is_unrefused = true;
    void *resized = he_mem_resize(memory, size);
    is_unrefused = false;
    return resized;
}

uint64_t st_memory_used(void)
{
    return atomic_load_explicit(&used, memory_order_relaxed);
}

uint64_t st_memory_budget(void)
{
    return atomic_load(&budget_bytes);
}

bool st_memory_has(uint64_t bytes)
{
    uint64_t budget = st_memory_budget();
    return budget == 0 || st_memory_used() + bytes <= budget;
}

bool st_memory_is_full(void)
{
    uint64_t budget = st_memory_budget();
    return budget != 0 && st_memory_used() >= budget - budget / RESERVE_SHARE;
}

bool st_memory_was_over_budget(void)
{
    return atomic_load_explicit(&over_budget, memory_order_relaxed);
}

bool st_memory_is_short(void)
{
    uint64_t budget = st_memory_budget();
    return budget != 0 &&
           st_memory_used() + budget / ST_MEMORY_SHORT_SHARE > budget - budget / RESERVE_SHARE;
}

/* Free memory is returned to the system when the process is idle: when it has used at least
 * WORKED_MICROS of processor time since the last return, and less than RESTING_MICROS since the
 * last call of st_memory_rests. By itself, glibc returns only the free end of a heap, and each
 * thread has a heap. Free pages in the middle stay; after minutes of mixed requests they are more
 * than all memory in use. */
enum { WORKED_MICROS = 20 * 1000, RESTING_MICROS = 50 * 1000 };

bool st_memory_rests(st_memory_rest *rest, uint64_t processor)
{
    bool resting = processor - rest->looked < RESTING_MICROS;
    rest->looked = processor;
    if (!resting || processor - rest->trimmed < WORKED_MICROS) {
        return false;
    }
    malloc_trim(0);
    rest->trimmed = processor;
    return true;
}
