/* timing.h - where the time of one request goes, for the log's lines of slow requests.
 *
 * A request is in one part (server/log/access.h) at every moment from its first line to its end, so
 * that the parts add up to the whole. While it works, what its thread waits for locks is counted
 * apart (core/system/lock.h): it enters and leaves SRV_PART_WORK on one thread. */
#ifndef HE_SERVER_LOG_TIMING_H
#define HE_SERVER_LOG_TIMING_H

#include "server/log/access.h"

/* In the storage of the request; the thread that moves the request writes it. */
typedef struct srv_timing {
    bool on;         /* otherwise nothing is measured */
    srv_part part;   /* in which it is */
    uint64_t since;  /* microseconds of the monotonic clock */
    uint64_t waited; /* st_lock_waited of the thread, when the work began */
    uint64_t parts[SRV_PARTS];
} srv_timing;

/* From `now` on it is received. */
void srv_timing_begin(srv_timing *timing, uint64_t now);
void srv_timing_enter(srv_timing *timing, srv_part part);
/* It has ended: what has passed until `now` belongs to the part in which it is. */
void srv_timing_end(srv_timing *timing, uint64_t now);

#endif
