/* daemon.h - all parts of a running hedged, put together and taken apart.
 *
 *     store <- api service <- http <- clients
 *                  ^            |
 *                jobs <---------+       log <- http, and all events of the daemon itself */
#ifndef HE_SERVER_BOOT_DAEMON_H
#define HE_SERVER_BOOT_DAEMON_H

#include "server/config.h"

/* What the process was started with; everything is borrowed. */
typedef struct srv_started {
    const srv_config *config; /* made from the other members */
    int argc;
    char *const *argv; /* without the program's name */
    char *const *environment;
} srv_started;

/* Serves until SIGTERM or SIGINT. Returns the exit status of the process: 0 after a stop, 1 if it
 * could not start, with the reason in the log. Must be called from the only thread. */
int srv_daemon_run(const srv_started *started);

#endif
