/* resources.h - what the machine allows the daemon: cores, descriptors, memory. */
#ifndef HE_SERVER_BOOT_RESOURCES_H
#define HE_SERVER_BOOT_RESOURCES_H

#include "server/config.h"
#include "server/http/http.h"

#include "system/memory_limit.h"

size_t srv_cores(void); /* at least one */

/* Sets connections, sockets, deadlines and workers of `options` within the number of descriptors,
 * whose limit is raised to the maximum that the system allows. */
void srv_choose_connections(const srv_config *config, srv_http_options *options);

/* Sets the memory budget. Returns the limit that the machine sets. */
st_memory_limit srv_choose_budget(const srv_config *config);
/* Logs the memory budget with its reason; `limit` is what srv_choose_budget returned. */
void srv_tell_budget(srv_log *log, const srv_config *config, const st_memory_limit *limit);

#endif
