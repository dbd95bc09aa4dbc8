/* daemon.h - opens all parts of hedged, serves requests until a signal arrives, and closes them.
 *
 *     store <- api service <- http <- clients
 *                  ^            |
 *                jobs <---------+       log <- http, and all events of the daemon itself */
#ifndef HE_SERVER_BOOT_DAEMON_H
#define HE_SERVER_BOOT_DAEMON_H

#include "server/config.h"

/* The arguments and the environment of the process; all pointers are borrowed. */
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
