/* resources.h - what the machine lets the daemon have: cores, descriptors, memory. */
#ifndef HE_SERVER_BOOT_RESOURCES_H
#define HE_SERVER_BOOT_RESOURCES_H

#include "server/config.h"
#include "server/http/http.h"

size_t srv_cores(void); /* one at least */

/* Sets the connections, sockets, deadlines and workers of `options`, within the descriptors that
 * this process may have, whose limit is raised to the most that the system allows. */
void srv_choose_connections(const srv_config *config, srv_http_options *options);

/* Puts the memory budget in force and tells the log what it is and why. */
void srv_choose_budget(srv_log *log, const srv_config *config);

#endif
