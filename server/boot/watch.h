/* watch.h - periodic work of the main thread: checking the disk, and checking for systemd's
 * watchdog whether a worker still answers. */
#ifndef HE_SERVER_BOOT_WATCH_H
#define HE_SERVER_BOOT_WATCH_H

#include "server/boot/parts.h"
#include "system/memory.h"

typedef struct srv_watch {
    st_memory_rest rest;
    st_health health;
    uint64_t fed; /* when systemd was last notified that a worker answered, st_clock_micros */
} srv_watch;

/* Does the periodic work; it must be called about once a second, with a `watch` that is zero at
 * first. Returns unused memory to the system, logs when the disk is full, has space again or
 * failed, and notifies systemd's watchdog. */
void srv_watch_look(srv_watch *watch, const srv_parts *parts);

#endif
