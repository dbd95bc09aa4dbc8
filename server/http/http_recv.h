/* http_recv.h - what libmicrohttpd gets when it calls recv() or gnutls_record_recv().
 *
 * This module defines both for the whole program, and the dynamic linker binds libmicrohttpd's
 * calls to them, as it does with an allocator of one's own. A call for a watched socket with no
 * flags, as libmicrohttpd makes it, hands the bytes through the socket's state machine
 * (http_syntax.h); over TLS it is gnutls_record_recv() that does, and recv(), by which gnutls
 * reads what is encrypted, does not. All other calls, of other sockets or with flags, are those of
 * the system and of gnutls, unchanged.
 *
 *   R1  A recv() makes at most one system call: recvmsg(), or recvfrom() where the socket is not
 *       watched. It goes through the C library's function of that name, so that the sanitizers see
 *       it. A gnutls_record_recv() is one gnutls_record_recv_seq().
 *   R2  After a fault nothing more is read from the socket: the ending that the machine puts in
 *       place of the rest is handed out, then nothing (EAGAIN), until the handler's answer closes
 *       the connection.
 *   R3  Fewer bytes than asked for are returned only where the socket had no more, or after a
 *       fault: libmicrohttpd takes that for an empty socket and waits for its next edge-triggered
 *       event.
 *   R4  The machine is found in a table by descriptor, without a lock. A slot is written only by
 *       the worker that owns the descriptor, after accept() and before close(): between those no
 *       other socket has its number.
 *   R5  The end of what a client sends is seen when it comes with the last bytes before it. No
 *       further event tells of it, and so libmicrohttpd would wait for the next request until the
 *       connection is idle for too long. The kernel says with the bytes whether there is more to
 *       read (TCP_INQ), which an end is.
 *       Over TLS libmicrohttpd itself reads on until there is no more, and finds the end.
 *   R6  A connection enters SRV_STAGE_HEAD with the first byte of a request, and a TLS connection
 *       SRV_STAGE_IDLE when it is first read from, which libmicrohttpd does after the handshake.
 *
 * It also defines send() and sendmsg(), which are the system's but for a count: of a Unix socket
 * the kernel does not say how much was ever sent, which http_deadline.h wants to know. */
#ifndef HE_SERVER_HTTP_HTTP_RECV_H
#define HE_SERVER_HTTP_HTTP_RECV_H

#include "server/http/http_deadline.h"

#include <sys/types.h>

/* Linux gives no process more descriptors than this, unless fs.nr_open was raised. */
enum { SRV_MAX_DESCRIPTORS = 1 << 20 };

/* From here on recv() of the connection's socket goes through its state machine, which is {0}.
 * False when the descriptor is beyond the table: the socket must not be served. */
bool srv_recv_watch(srv_connection *connection);
/* To be called before the socket is closed. */
void srv_recv_forget(int socket);
/* The connection of a TLS session; NULL where it is not watched. */
srv_connection *srv_recv_find(gnutls_session_t session);
/* Has the client closed its side, and is no request begun beside the one that is served? Then its
 * answer is the last. For the worker of the connection. Accepts NULL: false. */
bool srv_recv_has_ended(const srv_connection *connection);

/* Writes to the client past libmicrohttpd, which must not be in the middle of an answer. False when
 * the socket, which does not block, would not take all of it. */
bool srv_recv_send(srv_connection *connection, const char *bytes, size_t length);

/* Reads by `receive`, which returns like recv(), and checks what came. Like recv(), -1 with EAGAIN
 * after the end of a fault. */
ssize_t srv_recv_checked(srv_syntax *syntax, char *buffer, size_t size,
                         ssize_t (*receive)(void *context, char *buffer, size_t size),
                         void *context);

#endif
