/* watch.h - the periodic work of the main thread: it checks the disk and memory, reports their
 * state to systemd, and checks for systemd's watchdog whether a worker thread still answers. */
#ifndef HE_SERVER_BOOT_WATCH_H
#define HE_SERVER_BOOT_WATCH_H

#include "server/boot/parts.h"
#include "system/memory.h"

typedef struct srv_watch {
    st_memory_rest rest;
    st_health health;
    /* Time (st_clock_micros) at which a worker thread was last checked for systemd's watchdog. */
    uint64_t fed;
} srv_watch;

/* Writes the text that `systemctl status` shows while the daemon runs: "listening on URL", and what
 * is wrong with the disk if anything is. */
enum { SRV_STATUS = SRV_URL_TEXT + 128 };
void srv_watch_describe(const srv_parts *parts, char text[SRV_STATUS]);

/* Sends READY=1 and this text to systemd, when the daemon has started or was reloaded. If the
 * message is lost (notify.h), srv_watch_look sends it again. */
void srv_watch_announce(srv_parts *parts);

/* Does the periodic work; it must be called about once a second, with a `watch` that is zero at
 * first. Returns unused memory to the system, finds out whether memory is full, reports in the log
 * and to systemd when the disk is full, has space again or failed, and notifies systemd's
 * watchdog. */
void srv_watch_look(srv_watch *watch, srv_parts *parts);

#endif
