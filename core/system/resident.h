/* resident.h - what the process holds in memory beside the blocks that memory.h counts.
 *
 * That is the program with its libraries, stacks, and holes: where blocks of many sizes come and
 * go, pages stay in which some blocks are in use and the rest is free. Holes are used again, but
 * never all of them: with small meshes that leave memory and come back they grow to a sixth of
 * what is counted. So the budget is compared with what is counted and this beside it.
 *
 * It is measured just before meshes leave memory, for then the holes are as full as they get. After
 * meshes have left, the difference between resident and counted bytes says nothing: most of it is
 * room for those that come next. */
#ifndef HE_SYSTEM_RESIDENT_H
#define HE_SYSTEM_RESIDENT_H

#include <stdbool.h>
#include <stdint.h>

/* From now on it is measured; until then it is 0, as in a test, whose process holds other things.
 * Before the first thread. */
void st_resident_watch(void);

/* Bytes at the last measuring. At most half of the memory budget: the other half is for blocks,
 * however small the budget is beside the program. */
uint64_t st_resident_beside(void);

/* Gives back to the system what the C library keeps of freed blocks, then measures. Does nothing
 * within 100 ms of the last time, for it takes the lock of each heap in turn. */
void st_resident_measure(void);

/* Is more resident than the budget less a thirty-second of it, and more by the sixth part of that
 * than when this was last asked and found so? */
bool st_resident_is_beyond(void);

#endif
