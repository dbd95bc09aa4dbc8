/* memory_limit.h - how much memory this process may take before the kernel ends it.
 *
 * A machine has so much, and a control group (cgroups(7)) may have less: the process's own, or any
 * above it. The groups are found as the process sees them, through /proc/self/cgroup and
 * /proc/self/mountinfo, in version 1, version 2 or both, also where a container shows only its own
 * part of the tree or has a namespace of its own. */
#ifndef HE_SYSTEM_MEMORY_LIMIT_H
#define HE_SYSTEM_MEMORY_LIMIT_H

#include <stddef.h>
#include <stdint.h>

enum { SRV_LIMIT_SOURCE = 512 };

typedef struct st_memory_limit {
    uint64_t bytes; /* UINT64_MAX when not even the machine says */
    /* What has this limit, such as "the machine" or "/sys/fs/cgroup/a/memory.max"; shortened at its
     * beginning where it would not fit. */
    char source[SRV_LIMIT_SOURCE];
} st_memory_limit;

/* The smallest limit there is. `root` is the folder that has proc and what is mounted: "" for the
 * system's, a test's own otherwise. `machine` is what the machine has in bytes, 0 when that is
 * unknown. What cannot be read is no limit. */
st_memory_limit st_memory_limit_find(const char *root, uint64_t machine);
/* The memory of this machine in bytes, 0 when the system does not say. */
uint64_t st_memory_limit_machine(void);

#endif
