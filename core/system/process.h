/* process.h - what the system says of this process. */
#ifndef HE_SYSTEM_PROCESS_H
#define HE_SYSTEM_PROCESS_H

#include <stdint.h>

/* What the system does not tell is 0. */
typedef struct st_process {
    double processor;          /* seconds of processor time */
    double started;            /* seconds since 1970 UTC */
    uint64_t resident;         /* bytes of memory, */
    uint64_t address_space;    /* and of addresses */
    uint64_t descriptors;      /* that are open, */
    uint64_t most_descriptors; /* and may be */
} st_process;

/* Reads /proc; does not wait for a disk. */
void st_process_read(st_process *out);

#endif
