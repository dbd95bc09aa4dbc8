/* healthcheck.h - `hedged --healthcheck`: is a daemon answering? */
#ifndef HE_SERVER_NET_HEALTHCHECK_H
#define HE_SERVER_NET_HEALTHCHECK_H

#include <stdbool.h>
#include <stddef.h>

/* GET `url` ("http://127.0.0.1:8080/livez"; the host an address or localhost), or /livez at
 * `listen` when `url` is NULL, waiting 3 seconds at most. True for status 200; else `message` says
 * what came instead. */
bool srv_healthcheck(const char *url, const char *listen, char *message, size_t size);

#endif
