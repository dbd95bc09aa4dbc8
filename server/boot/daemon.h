/* daemon.h - everything a running hedged is made of, put together and taken apart.
 *
 *     store <- api service <- http <- clients
 *                  ^            |
 *                jobs <---------+       access log <- http                                   */
#ifndef HE_SERVER_BOOT_DAEMON_H
#define HE_SERVER_BOOT_DAEMON_H

#include "server/config.h"

/* Serve until SIGTERM or SIGINT; SIGHUP has the tokens read again. The process's exit status: 0
 * after a stop, 1 when it could not start, with a line on stderr that says why. To be called from
 * the only thread. */
int srv_daemon_run(const srv_config *config);

#endif
