/* resident.h - measures the memory of the process beside the blocks that memory.h counts.
 *
 * That is the program with its libraries, stacks, and heap fragmentation: where blocks of many
 * sizes are allocated and freed, pages stay resident in which some blocks are in use and the rest
 * is free. This free space is used again, but never all of it: with small meshes that are evicted
 * and loaded again it grows to a sixth of the counted memory. So the budget limits counted memory
 * and this together.
 *
 * It is measured just before meshes are evicted, when the heaps are as full as they get. After an
 * eviction the difference between resident and counted bytes says nothing: most of it is room for
 * the meshes that are loaded next. */
#ifndef HE_SYSTEM_RESIDENT_H
#define HE_SYSTEM_RESIDENT_H

#include <stdbool.h>
#include <stdint.h>

/* Switches measuring on. Until then the result is 0, as in a test, whose process also holds other
 * things. Must be called before the first thread. */
void st_resident_watch(void);

/* Returns the measured bytes that the process holds beside counted blocks, but at most half of the
 * memory budget: the other half stays for blocks, however small the budget is beside the
 * program. */
uint64_t st_resident_beside(void);

/* Returns memory of freed blocks, which the C library keeps, to the system, then measures. Does
 * nothing within 100 ms of the last time, because it takes the lock of each heap in turn. */
void st_resident_measure(void);

/* Returns true if the resident memory is more than 31/32 of the budget, and has grown by a sixth of
 * a thirty-second since this last returned true. */
bool st_resident_is_beyond(void);

#endif
