/* memory_limit.h - finds how much memory this process may use before the kernel kills it.
 *
 * The machine has a limit, and a control group (cgroups(7)) may have a lower one: the process's own
 * group, or any above it. The groups are found through /proc/self/cgroup and /proc/self/mountinfo,
 * whether the system uses control groups of version 1, version 2 or both, and also in a container
 * that sees only its own part of the tree of groups or has a namespace of its own. */
#ifndef HE_SYSTEM_MEMORY_LIMIT_H
#define HE_SYSTEM_MEMORY_LIMIT_H

#include <stddef.h>
#include <stdint.h>

enum { SRV_LIMIT_SOURCE = 512 };

typedef struct st_memory_limit {
    uint64_t bytes; /* the limit in bytes; UINT64_MAX if not even the machine's memory is known */
    /* What sets the limit, such as "the machine" or "/sys/fs/cgroup/a/memory.max"; a long name is
     * cut at its beginning. */
    char source[SRV_LIMIT_SOURCE];
} st_memory_limit;

/* Finds the smallest limit: that of the machine or of a control group. `root` is the folder in
 * which proc and the mounted folders are looked for: "" for those of the system, else the folder of
 * a test. `machine` is the machine's memory in bytes, 0 if unknown. A limit that cannot be read is
 * ignored. */
st_memory_limit st_memory_limit_find(const char *root, uint64_t machine);
/* Returns the memory of this machine in bytes, 0 if it is unknown. */
uint64_t st_memory_limit_machine(void);

#endif
