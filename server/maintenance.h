/* maintenance.h - operations on a store that no daemon serves meanwhile: --backup, --restore,
 * --verify, --dump. */
#ifndef HE_SERVER_MAINTENANCE_H
#define HE_SERVER_MAINTENANCE_H

#include "server/config.h"

/* Does the configuration ask for one of them? */
bool srv_maintenance_asked(const srv_config *config);
/* Runs it and prints the result on stdout. Returns the exit status of the process: 0, or 1 with the
 * reason on stderr. */
int srv_maintenance_run(const srv_config *config);

#endif
