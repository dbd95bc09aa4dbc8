/* tls_client.h - sends one request over TLS, for the health check of a daemon.
 *
 * The certificate is not verified at all: the check only asks whether the daemon at an address
 * answers, and sends nothing secret. */
#ifndef HE_SERVER_TLS_TLS_CLIENT_H
#define HE_SERVER_TLS_TLS_CLIENT_H

#include <stddef.h>

/* Sends `request` on a connected socket, whose timeouts the caller has set, and reads the answer
 * until `size` bytes have arrived or the answer ends. Returns the number of bytes read, 0 on
 * failure. */
size_t srv_tls_ask(int socket, const char *request, size_t length, char *answer, size_t size);

#endif
