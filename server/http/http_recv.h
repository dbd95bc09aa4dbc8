/* http_recv.h - what libmicrohttpd gets when it calls recv().
 *
 * This module defines recv() for the whole program, and the dynamic linker binds libmicrohttpd's
 * calls to it, as it does with an allocator of one's own. A call for a watched socket with no
 * flags, as libmicrohttpd makes it, hands the bytes through the socket's state machine
 * (http_syntax.h). All other calls, of other sockets or with flags, are the system's, unchanged.
 *
 *   R1  A recv() makes at most one system call: recvmsg(), or recvfrom() where the socket is not
 *       watched. It goes through the C library's function of that name, so that the sanitizers see
 *       it.
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
 *   R6  A connection enters SRV_STAGE_HEAD with the first byte of a request.
 *
 * A TLS listener needs gnutls_record_recv() beside it, which libmicrohttpd imports as well: defined
 * here, with srv_recv_checked and a `receive` that calls the library's own, found by
 * dlsym(RTLD_NEXT). Its sockets must not be in this table, since gnutls calls recv() to read what
 * is still encrypted: their machine is found by session. Until that is written, no request that
 * came over TLS would be served: the machine has not counted it (S4). */
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
/* Has the client closed its side, and is no request begun beside the one that is served? Then its
 * answer is the last. For the worker of the connection. Accepts NULL: false. */
bool srv_recv_has_ended(const srv_connection *connection);

/* Reads by `receive`, which returns like recv(), and checks what came. Like recv(), -1 with EAGAIN
 * after the end of a fault. */
ssize_t srv_recv_checked(srv_syntax *syntax, char *buffer, size_t size,
                         ssize_t (*receive)(void *context, char *buffer, size_t size),
                         void *context);

#endif
