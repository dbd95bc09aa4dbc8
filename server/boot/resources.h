/* resources.h - what the machine allows the daemon: cores, descriptors, memory. */
#ifndef HE_SERVER_BOOT_RESOURCES_H
#define HE_SERVER_BOOT_RESOURCES_H

#include "server/config.h"
#include "server/http/http.h"

#include "system/memory_limit.h"

size_t srv_cores(void); /* at least one */

/* Sets the numbers of connections, sockets and worker threads, and the deadlines, in `options`.
 * Raises the limit of open descriptors to the maximum that the system allows, from which the
 * numbers of connections and sockets follow. */
void srv_choose_connections(const srv_config *config, srv_http_options *options);

/* Sets the memory budget of the process. Returns how much memory the machine, or a control group,
 * allows. */
st_memory_limit srv_choose_budget(const srv_config *config);
/* Logs the memory budget and how it was chosen; `limit` is what srv_choose_budget returned. */
void srv_tell_budget(srv_log *log, const srv_config *config, const st_memory_limit *limit);

#endif
