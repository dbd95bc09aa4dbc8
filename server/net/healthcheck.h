/* healthcheck.h - `hedged --healthcheck`: asks a daemon whether it answers. */
#ifndef HE_SERVER_NET_HEALTHCHECK_H
#define HE_SERVER_NET_HEALTHCHECK_H

#include <stdbool.h>
#include <stddef.h>

/* Sends GET to a URL and waits at most 3 seconds for the answer. The URL is
 * "http://127.0.0.1:8080/livez", "https://...", where the certificate is not verified
 * (tls_client.h), or "unix:/run/hedge/socket". Its host is an address or localhost; the default
 * path is /livez. Returns true if the status of the answer is 200; otherwise `message` says what
 * happened instead. */
bool srv_healthcheck(const char *url, char *message, size_t size);

#endif
