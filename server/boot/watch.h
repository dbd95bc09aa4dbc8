/* watch.h - what the main thread looks at while others serve: the health of the disk, and whether a
 * worker still answers, which systemd's watchdog is told. */
#ifndef HE_SERVER_BOOT_WATCH_H
#define HE_SERVER_BOOT_WATCH_H

#include "server/boot/parts.h"
#include "system/memory.h"

typedef struct srv_watch {
    st_memory_rest rest;
    st_health health;
    uint64_t fed; /* when systemd was told that a worker answered, st_clock_micros */
} srv_watch;

/* To be called about once a second, on a `watch` that is zero at first: gives unused memory back,
 * says on stderr when the disk is full, has space again or failed, and feeds systemd's watchdog. */
void srv_watch_look(srv_watch *watch, const srv_parts *parts);

#endif
