/* tls_record.h - reading and writing the plain bytes of a TLS session. */
#ifndef HE_SERVER_TLS_TLS_RECORD_H
#define HE_SERVER_TLS_TLS_RECORD_H

#include <gnutls/gnutls.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* Does what gnutls_record_recv(3) does, by another function of the library: server/http/http_recv.c
 * redefines gnutls_record_recv for the whole program. */
ssize_t srv_tls_receive(gnutls_session_t session, void *buffer, size_t size);
/* Sends all bytes on a socket that does not block. Returns false if the socket did not take all of
 * them; nothing more can be sent on it then. */
bool srv_tls_send(gnutls_session_t session, const char *bytes, size_t length);

#endif
