#include "server/boot/watch.h"

#include "server/net/healthcheck.h"
#include "server/net/notify.h"
#include "system/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <time.h>

static uint64_t processor_micros(void)
{
    struct timespec time = {0};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (uint64_t)time.tv_sec * 1000000 + (uint64_t)time.tv_nsec / 1000;
}

/* Logs that the disk is full, that it has space again, or that it failed. If the disk was full for
 * a while between two checks, that is logged, too. If it was full at both checks, but had space
 * between them, that is not logged. */
static void tell_health(srv_log *log, const st_health *before, const st_health *now,
                        const char *folder)
{
    const bool was_full = before->status == ST_FULL;
    const bool found_full = !was_full && now->fulls != before->fulls;
    if (found_full) {
        srv_log_tell(log, SRV_LEVEL_ERROR,
                     "the disk of %s is full: changes are refused, but reads and DELETE continue. "
                     "Make space on this disk, or delete meshes",
                     folder);
    }
    if ((was_full || found_full) && now->status == ST_OK) {
        srv_log_tell(log, SRV_LEVEL_INFO, "the disk of %s has space again: changes are accepted",
                     folder);
    }
    if (now->damaged_keys > 0 && before->damaged_keys == 0) {
        srv_log_tell(log, SRV_LEVEL_WARNING,
                     "the store in %s has %llu damaged records of requests with an "
                     "Idempotency-Key: if such a request is sent again, the server refuses it or, "
                     "if the record's key cannot be read, does it a second time",
                     folder, (unsigned long long)now->damaged_keys);
    }
    if (now->status == ST_FAILED && before->status != ST_FAILED) {
        srv_log_tell(
            log, SRV_LEVEL_ERROR,
            "the disk of %s failed%s%s: reads continue, but changes are refused. Check the disk "
            "and start hedged again: every change that was acknowledged is on the disk",
            folder, now->reason[0] == '\0' ? "" : ", ", now->reason);
    }
}

void srv_watch_describe(const srv_parts *parts, char text[SRV_STATUS])
{
    st_health health;
    st_store_health(parts->store, &health);
    snprintf(text, SRV_STATUS, "listening on %s%s", parts->url,
             health.status == ST_FULL     ? "; the disk is full, and changes are refused"
             : health.status == ST_FAILED ? "; the disk failed, and changes are refused"
                                          : "");
}

/* Sends the lines `head`, which may be empty, and the STATUS. Returns what srv_notify returns. */
static bool tell_systemd(const srv_parts *parts, const char *head)
{
    char status[SRV_STATUS], text[SRV_STATUS + 32];
    srv_watch_describe(parts, status);
    snprintf(text, sizeof text, "%sSTATUS=%s", head, status);
    return srv_notify(text);
}

void srv_watch_announce(srv_parts *parts)
{
    if (!tell_systemd(parts, "READY=1\n")) {
        atomic_store(&parts->unannounced, true);
    }
}

/* Notifies systemd's watchdog twice within its timeout, if a worker thread still answers requests;
 * *fed is the time at which a worker thread was last checked. */
static void feed_watchdog(const srv_parts *parts, uint64_t *fed)
{
    const uint64_t patience = srv_notify_watchdog();
    char message[128];
    if (patience == 0 || st_clock_micros() - *fed < patience / 2) {
        return;
    }
    *fed = st_clock_micros();
    if (srv_healthcheck(parts->url, message, sizeof message)) {
        srv_notify("WATCHDOG=1");
    } else {
        srv_log_tell(parts->log, SRV_LEVEL_WARNING,
                     "the watchdog is not notified, because the daemon does not answer its own "
                     "request for /livez: %s",
                     message);
    }
}

void srv_watch_look(srv_watch *watch, srv_parts *parts)
{
    const st_health before = watch->health;
    if (atomic_exchange(&parts->unannounced, false)) {
        srv_watch_announce(parts);
    }
    feed_watchdog(parts, &watch->fed);
    st_memory_rests(&watch->rest, processor_micros());
    st_store_rest(parts->store);
    atomic_store(&parts->full, st_store_is_full(parts->store));
    st_store_health(parts->store, &watch->health);
    tell_health(parts->log, &before, &watch->health, srv_config_folder(parts->config));
    if (watch->health.status != before.status) {
        tell_systemd(parts, "");
    }
}
