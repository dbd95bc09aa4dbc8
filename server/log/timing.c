#include "server/log/timing.h"

#include "system/lock.h"
#include "system/clock.h"

void srv_timing_begin(srv_timing *timing, uint64_t now)
{
    *timing = (srv_timing){.on = true, .part = SRV_PART_RECEIVE, .since = now};
}

void srv_timing_end(srv_timing *timing, uint64_t now)
{
    uint64_t spent = now - timing->since;
    if (timing->part == SRV_PART_WORK) {
        const uint64_t waited = st_lock_waited() - timing->waited;
        const uint64_t locked = waited < spent ? waited : spent;
        timing->parts[SRV_PART_LOCK] += locked;
        spent -= locked;
    }
    timing->parts[timing->part] += spent;
    timing->since = now;
}

void srv_timing_enter(srv_timing *timing, srv_part part)
{
    if (!timing->on) {
        return;
    }
    srv_timing_end(timing, st_clock_micros());
    timing->part = part;
    timing->waited = st_lock_waited();
}
