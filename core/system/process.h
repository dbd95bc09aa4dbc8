/* process.h - facts about this process, from the system. */
#ifndef HE_SYSTEM_PROCESS_H
#define HE_SYSTEM_PROCESS_H

#include <stdint.h>

/* Facts about this process. A fact that the system does not reveal is 0. */
typedef struct st_process {
    double processor;          /* seconds of processor time */
    double started;            /* seconds since 1970 UTC */
    uint64_t resident;         /* bytes of resident memory */
    uint64_t address_space;    /* bytes of address space */
    uint64_t descriptors;      /* number of open descriptors */
    uint64_t most_descriptors; /* limit of open descriptors */
} st_process;

/* Reads the facts about this process from /proc, which does not wait for a disk. */
void st_process_read(st_process *out);

#endif
