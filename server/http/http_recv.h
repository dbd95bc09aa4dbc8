/* http_recv.h - replaces recv() and gnutls_record_recv(), so that libmicrohttpd reads checked
 * bytes.
 *
 * This module defines both for the whole program, and the dynamic linker binds libmicrohttpd's
 * calls to them, as it does for a replaced malloc(). A call without flags for a watched socket,
 * which is how libmicrohttpd calls, passes the bytes through the socket's state machine
 * (http_syntax.h). Over TLS gnutls_record_recv() does that, and recv(), with which gnutls reads
 * encrypted bytes, does not. All other calls go to the system and to gnutls unchanged.
 *
 *   R1  A recv() makes at most one system call: recvmsg(), or recvfrom() where the socket is not
 *       watched. It calls the C library's function of that name, so that the sanitizers see it. A
 *       gnutls_record_recv() makes one gnutls_record_recv_seq().
 *   R2  After a fault nothing more is read from the socket: the calls return the ending that the
 *       state machine puts in place of the rest, then nothing (EAGAIN), until the handler's answer
 *       closes the connection.
 *   R3  A call returns fewer bytes than asked for only if the socket had no more, or after a fault:
 *       libmicrohttpd then assumes that the socket is empty and waits for its next edge-triggered
 *       event.
 *   R4  The state machine is found in a table by descriptor, without a lock. A slot is written only
 *       by the worker that owns the descriptor, after accept() and before close(): in between no
 *       other socket has its number.
 *   R5  If the end of the client's stream arrives together with the last bytes, it is noticed then.
 *       No further event reports it, so libmicrohttpd would wait for the next request until the
 *       idle timeout. The kernel reports with the bytes whether there is more to read (TCP_INQ),
 *       and counts the end as more. Over TLS libmicrohttpd itself reads on until there is no more,
 *       and finds the end.
 *   R6  A connection enters SRV_STAGE_HEAD with the first byte of a request, and a TLS connection
 *       SRV_STAGE_IDLE when it is first read from, which libmicrohttpd does after the handshake.
 *
 * It also defines send() and sendmsg(), which call the system's and count the bytes:
 * http_deadline.h needs the number of bytes sent, and the kernel does not report it for Unix
 * sockets. */
#ifndef HE_SERVER_HTTP_HTTP_RECV_H
#define HE_SERVER_HTTP_HTTP_RECV_H

#include "server/http/http_deadline.h"

#include <sys/types.h>

/* The largest number of descriptors that Linux allows a process, unless fs.nr_open was raised. */
enum { SRV_MAX_DESCRIPTORS = 1 << 20 };

/* Makes all recv() calls for the connection's socket pass through its state machine, which must be
 * {0}. Returns false if the descriptor is outside of the table: the socket must then not be
 * served. */
bool srv_recv_watch(srv_connection *connection);
/* Ends the checking of a socket. It must be called before the socket is closed. */
void srv_recv_forget(int socket);
/* Returns the connection of a TLS session, or NULL if it is not watched. */
srv_connection *srv_recv_find(gnutls_session_t session);
/* Returns true if the client has closed its side and sends no other request after the present one,
 * so that the present answer is the last. Called by the worker of the connection. Takes NULL and
 * returns false. */
bool srv_recv_has_ended(const srv_connection *connection);

/* Writes to the client directly; libmicrohttpd must not be in the middle of an answer. Returns
 * false if the socket, which does not block, did not take all of it. */
bool srv_recv_send(srv_connection *connection, const char *bytes, size_t length);

/* Reads bytes with the function `receive`, which returns like recv(), and checks them. Returns like
 * recv(): -1 with EAGAIN after the ending of a fault. */
ssize_t srv_recv_checked(srv_syntax *syntax, char *buffer, size_t size,
                         ssize_t (*receive)(void *context, char *buffer, size_t size),
                         void *context);

#endif
