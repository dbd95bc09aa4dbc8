/* tls_record.h - the bytes that a TLS session carries. */
#ifndef HE_SERVER_TLS_TLS_RECORD_H
#define HE_SERVER_TLS_TLS_RECORD_H

#include <gnutls/gnutls.h>
#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* What gnutls_record_recv(3) does, by another function of the library: that one is defined by
 * server/http/http_recv.c for the whole program. */
ssize_t srv_tls_receive(gnutls_session_t session, void *buffer, size_t size);
/* Sends all of it on a socket that does not block. False when the socket would not take it all:
 * then nothing more can be sent on it. */
bool srv_tls_send(gnutls_session_t session, const char *bytes, size_t length);

#endif
