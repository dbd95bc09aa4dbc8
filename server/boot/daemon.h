/* daemon.h - everything a running hedged is made of, put together and taken apart.
 *
 *     store <- api service <- http <- clients
 *                  ^            |
 *                jobs <---------+       log <- http, and all that happens to the daemon itself  */
#ifndef HE_SERVER_BOOT_DAEMON_H
#define HE_SERVER_BOOT_DAEMON_H

#include "server/config.h"

/* What the process was started with; all borrowed. */
typedef struct srv_started {
    const srv_config *config; /* read from the others */
    int argc;
    char *const *argv; /* without the program's name */
    char *const *environment;
} srv_started;

/* Serve until SIGTERM or SIGINT; SIGHUP has read again what reload.c lists. The process's exit
 * status: 0 after a stop, 1 when it could not start, with a line in the log that says why. To be
 * called from the only thread. */
int srv_daemon_run(const srv_started *started);

#endif
