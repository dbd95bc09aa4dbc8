/* healthcheck.h - `hedged --healthcheck`: is a daemon answering? */
#ifndef HE_SERVER_NET_HEALTHCHECK_H
#define HE_SERVER_NET_HEALTHCHECK_H

#include <stdbool.h>
#include <stddef.h>

/* GET `url`, waiting 3 seconds at most: "http://127.0.0.1:8080/livez", "https://...", whose
 * certificate is not verified (tls_client.h), or "unix:/run/hedge/socket". The host is an address
 * or localhost; without a path, /livez is asked for. True for status 200; else `message` says what
 * came instead. */
bool srv_healthcheck(const char *url, char *message, size_t size);

#endif
