/* http_recv.h - replaces recv() and gnutls_record_recv(), so that libmicrohttpd reads checked
 * bytes.
 *
 * This module defines both functions for the whole program, and the dynamic linker binds
 * libmicrohttpd's calls to these definitions, as it does for a replaced malloc(). If recv() is
 * called without flags for a watched socket, which is how libmicrohttpd calls it, the bytes pass
 * through the state machine of that connection (http_syntax.h). If the connection uses TLS, the
 * bytes of gnutls_record_recv() pass through it, and not the encrypted bytes of recv(). All other
 * calls go to the system and to gnutls unchanged.
 *
 *   R1  A call of recv() makes at most one system call: recvmsg(), or recvfrom() if the socket is
 *       not watched. It makes it through the C library's function of that name, so that the
 *       sanitizers notice. A call of gnutls_record_recv() makes one of gnutls_record_recv_seq().
 *   R2  After a fault nothing more is read from the socket: the calls return the bytes with which
 *       the state machine ends the faulty request, and then -1 with EAGAIN, until the handler has
 *       answered and the connection is closed.
 *   R3  A call returns fewer bytes than asked for only if the socket had no more, or after a fault.
 *       libmicrohttpd relies on that: after such a call it waits for the next edge-triggered event
 *       of the socket.
 *   R4  The connection of a socket is found in a table by descriptor, without a lock. An entry is
 *       written only by the worker thread that owns the descriptor, after accept() and before
 *       close(); in between no other socket has this descriptor.
 *   R5  If the end of the client's stream arrives together with the last bytes, it is noticed when
 *       they are read. No further event reports it, so libmicrohttpd would wait for the next
 *       request until the idle timeout. The kernel reports with the bytes whether there is more to
 *       read (TCP_INQ), and counts the end of the stream as more. Over TLS libmicrohttpd itself
 *       reads until there is no more, and finds the end.
 *   R6  A connection enters SRV_STAGE_HEAD with the first byte of a request. A TLS connection
 *       enters SRV_STAGE_IDLE when bytes are first read from it, which libmicrohttpd does after the
 *       handshake.
 *
 * The module also defines send() and sendmsg(), which make the system call and count the bytes:
 * http_deadline.h needs the number of bytes sent, and the kernel does not report it for Unix
 * sockets. */
#ifndef HE_SERVER_HTTP_HTTP_RECV_H
#define HE_SERVER_HTTP_HTTP_RECV_H

#include "server/http/http_deadline.h"

#include <sys/types.h>

/* The largest number of descriptors that Linux allows a process, unless the system's setting
 * fs.nr_open was raised. */
enum { SRV_MAX_DESCRIPTORS = 1 << 20 };

/* Makes the bytes that are received on a connection pass through its state machine, which must be
 * {0}. Returns false if the descriptor is too large for the table: then the connection must not be
 * served. */
bool srv_recv_watch(srv_connection *connection);
/* Ends the checking of a socket. It must be called before the socket is closed. */
void srv_recv_forget(int socket);
/* Returns the connection of a TLS session, or NULL if its bytes are not checked. */
srv_connection *srv_recv_find(gnutls_session_t session);
/* Returns true if the client has closed its side after the present request, so that the present
 * answer is the last on this connection. Called by the worker thread of the connection. Returns
 * false for NULL. */
bool srv_recv_has_ended(const srv_connection *connection);

/* Sends bytes to the client without libmicrohttpd, which must not be sending an answer. Returns
 * false if the socket, which does not block, did not take all bytes. */
bool srv_recv_send(srv_connection *connection, const char *bytes, size_t length);

/* Reads bytes with the function `receive`, whose result is like that of recv(), and passes them
 * through the state machine. The result is like that of recv(), too; after a fault, see R2. */
ssize_t srv_recv_checked(srv_syntax *syntax, char *buffer, size_t size,
                         ssize_t (*receive)(void *context, char *buffer, size_t size),
                         void *context);

#endif
