/* start.h - what the daemon says of itself when it starts, and how its log is set. */
#ifndef HE_SERVER_BOOT_START_H
#define HE_SERVER_BOOT_START_H

#include "server/config.h"
#include "server/log/log.h"

/* Is what is written on standard error JSON? */
bool srv_start_is_json(const srv_config *config);
/* What the configuration says of the log. */
srv_log_settings srv_start_log_settings(const srv_config *config);

/* The lines of a start: versions, the options in effect, and a warning that names the variables of
 * `environment` that no option has. No token is among them, but the path of their file. */
void srv_start_tell(srv_log *log, const srv_config *config, char *const *environment);

#endif
