/* start.h - the lines that the daemon logs at its start, and the settings of its log. */
#ifndef HE_SERVER_BOOT_START_H
#define HE_SERVER_BOOT_START_H

#include "server/config.h"
#include "server/log/log.h"

/* Returns true if the log on standard error is written as JSON. */
bool srv_start_is_json(const srv_config *config);
/* Returns the log settings of the configuration. */
srv_log_settings srv_start_log_settings(const srv_config *config);

/* Logs versions, the options in effect, and a warning with the variables of `environment` that
 * begin with HEDGE_ and belong to no option. No token is logged, only the path of their file. */
void srv_start_tell(srv_log *log, const srv_config *config, char *const *environment);

#endif
