/* tls_client.h - one question over TLS, for a daemon's health check.
 *
 * Nothing of the certificate is verified, neither its name nor its end nor who vouches for it: the
 * question is whether the daemon at an address answers, and nothing secret is sent. */
#ifndef HE_SERVER_TLS_TLS_CLIENT_H
#define HE_SERVER_TLS_TLS_CLIENT_H

#include <stddef.h>

/* Sends `request` on a connected socket, whose timeouts are the caller's, and reads until `size`
 * bytes have come or no more will. Returns how many came, 0 when none did. */
size_t srv_tls_ask(int socket, const char *request, size_t length, char *answer, size_t size);

#endif
