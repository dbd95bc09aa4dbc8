/* timing.h - measures where the time of one request goes, for the log's lines about slow requests.
 *
 * From its first line to its end a request is always in exactly one part (server/log/access.h), so
 * that the parts add up to the whole. Waiting for locks during the work is counted separately
 * (core/system/lock.h); so one thread must enter and leave SRV_PART_WORK. */
#ifndef HE_SERVER_LOG_TIMING_H
#define HE_SERVER_LOG_TIMING_H

#include "server/log/access.h"

/* Where the time of a request went so far. It is stored in the request, and written by the thread
 * that currently handles the request. */
typedef struct srv_timing {
    bool on;         /* false: nothing is measured */
    srv_part part;   /* the present part */
    uint64_t since;  /* microseconds of the monotonic clock */
    uint64_t waited; /* st_lock_waited of the thread at the beginning of the work */
    uint64_t parts[SRV_PARTS];
} srv_timing;

/* Begins the measurement at `now`, with the part SRV_PART_RECEIVE. */
void srv_timing_begin(srv_timing *timing, uint64_t now);
void srv_timing_enter(srv_timing *timing, srv_part part);
/* Ends the measurement at `now`; the last interval belongs to the present part. */
void srv_timing_end(srv_timing *timing, uint64_t now);

#endif
