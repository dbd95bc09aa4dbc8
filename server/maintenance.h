/* maintenance.h - what hedged does with a store instead of serving it: --backup, --restore,
 * --verify, --dump. */
#ifndef HE_SERVER_MAINTENANCE_H
#define HE_SERVER_MAINTENANCE_H

#include "server/config.h"

/* Returns true if the configuration asks for one of these operations. */
bool srv_maintenance_asked(const srv_config *config);
/* Runs the operation that the configuration asks for, and prints the result on stdout. Returns the
 * exit status of the process: 0, or 1 with the reason on stderr. */
int srv_maintenance_run(const srv_config *config);

#endif
