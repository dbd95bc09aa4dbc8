/* maintenance.h - what hedged does with a store besides serving it: --backup, --restore, --verify,
 * --dump. */
#ifndef HE_SERVER_MAINTENANCE_H
#define HE_SERVER_MAINTENANCE_H

#include "server/config.h"

/* Does the configuration ask for any of them? */
bool srv_maintenance_asked(const srv_config *config);
/* Does it, and tells on stdout what came of it. The process's exit status: 0, or 1 with a line on
 * stderr that says why. */
int srv_maintenance_run(const srv_config *config);

#endif
