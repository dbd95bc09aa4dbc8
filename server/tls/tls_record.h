/* tls_record.h - receives and sends the decrypted bytes of a TLS session. */
#ifndef HE_SERVER_TLS_TLS_RECORD_H
#define HE_SERVER_TLS_TLS_RECORD_H

#include <gnutls/gnutls.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* Receives bytes as gnutls_record_recv(3) does, but by another function of gnutls, because
 * server/http/http_recv.c replaces gnutls_record_recv in the whole program. */
ssize_t srv_tls_receive(gnutls_session_t session, void *buffer, size_t size);
/* Sends bytes in a session whose socket does not block. Returns false if the socket did not take
 * all bytes; then nothing more can be sent in the session. */
bool srv_tls_send(gnutls_session_t session, const char *bytes, size_t length);

#endif
