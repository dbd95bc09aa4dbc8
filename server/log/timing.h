/* timing.h - measures where the time of one request goes, for the log's lines about slow requests.
 *
 * The duration of a request is divided into parts (srv_part of server/log/access.h). From its first
 * line to its end a request is always in exactly one part, so that the parts add up to the whole.
 * The time that its thread waits for locks during SRV_PART_WORK (core/system/lock.h) is counted as
 * another part; so the thread that enters SRV_PART_WORK must also leave it. */
#ifndef HE_SERVER_LOG_TIMING_H
#define HE_SERVER_LOG_TIMING_H

#include "server/log/access.h"

/* The measurement of one request. It is stored in the request, and only the thread that currently
 * handles the request writes it. */
typedef struct srv_timing {
    bool on;       /* false: nothing is measured */
    srv_part part; /* the part in which the request is now */
    /* Time at which the present part began, in microseconds of the monotonic clock. */
    uint64_t since;
    uint64_t waited; /* what st_lock_waited returned when the present part began */
    uint64_t parts[SRV_PARTS];
} srv_timing;

/* Begins the measurement at `now`, with the part SRV_PART_RECEIVE. */
void srv_timing_begin(srv_timing *timing, uint64_t now);
void srv_timing_enter(srv_timing *timing, srv_part part);
/* Ends the measurement at `now`; the time since the last call counts for the present part. */
void srv_timing_end(srv_timing *timing, uint64_t now);

#endif
