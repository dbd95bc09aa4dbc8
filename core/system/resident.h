/* resident.h - measures the memory of the process that memory.h does not count.
 *
 * This memory is the program with its libraries, stacks, and heap fragmentation: where blocks of
 * many sizes are allocated and freed, pages stay resident in which some blocks are in use and the
 * rest is free. New blocks use this free space again, but never all of it: with small meshes that
 * are evicted and loaded again it grows to a sixth of the counted memory. So the budget limits the
 * sum of counted and uncounted memory.
 *
 * The uncounted memory is measured just before meshes are evicted (removed from memory), when the
 * heaps are as full as they get. After an eviction the difference between resident and counted
 * bytes says nothing: most of it is room for the meshes that are loaded next. */
#ifndef HE_SYSTEM_RESIDENT_H
#define HE_SYSTEM_RESIDENT_H

#include <stdbool.h>
#include <stdint.h>

/* Switches on the measuring of uncounted memory. Until then st_resident_beside returns 0. Tests
 * never switch it on, because their processes use other memory as well. Must be called before the
 * first thread. */
void st_resident_watch(void);

/* Returns how many bytes that memory.h does not count the process had at the last measurement, but
 * at most half of the memory budget, so that meshes always have the other half. */
uint64_t st_resident_beside(void);

/* Returns memory of freed blocks, which the C library keeps, to the system, then measures the
 * memory that memory.h does not count. Does nothing within 100 ms of the last measurement, because
 * it takes the lock of each of the C library's heaps in turn. */
void st_resident_measure(void);

/* Returns true if the resident memory is more than 31/32 of the budget, and has grown by a 192nd of
 * the budget since this function last returned true. */
bool st_resident_is_beyond(void);

#endif
