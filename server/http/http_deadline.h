/* http_deadline.h - closes connections that take their time.
 *
 * libmicrohttpd's timeout is about silence: one byte now and then keeps a connection for ever. A
 * thread of this module looks at every connection twice a second and shuts down the socket of one
 * that outstays its stage; libmicrohttpd then sees the end and cleans up.
 *
 *     HANDSHAKE                       of TLS; a plain connection begins with IDLE
 *         |
 *     IDLE    --first byte-->  HEAD  --headers-->  BODY  --all of it-->  WORK  --queued--> ANSWER
 *       ^                                                                                       |
 *       +---------------------------------- completed ------------------------------------------+
 *
 *     HANDSHAKE  head seconds; like IDLE a short while only when there are too many connections
 *     IDLE    idle seconds; a short while only when there are too many connections, or too many of
 *             its address
 *     HEAD    head seconds
 *     BODY    `total` seconds, and after `grace` seconds min_rate bytes a second on average. Like
 *             HEAD not at all when the client has closed its side, which libmicrohttpd leaves to
 *             time out
 *     WORK    not limited here: the client is waiting for us. Who works asks whether it still does:
 *             work for a client that was reset ends at once, for one that closed its side after a
 *             second, before which it gets its answer
 *     ANSWER  while bytes wait to be taken: min_rate bytes a second, over `grace` seconds. What
 *             counts is what the client's side has acknowledged, not what fits the socket's buffer;
 *             on a Unix socket, which acknowledges nothing, what the client has read. So it goes on
 * while IDLE, when all of an answer is in that buffer LIVE    an answer that goes on (http_live.h),
 * in place of ANSWER: while bytes wait to be taken, one a second over `total` seconds
 *
 * Closing costs the workers, who clean up, and the clients' side. So that a thousand slow clients
 * who came together do not keep others waiting when they are closed together, at most SRV_CLOSES
 * are closed at once, and the next a hundredth of a second later. The lock of the list is held for
 * as many, or for SRV_LOOKS looks.
 *
 * It also drains connections that were answered before their body was read: closing a socket with
 * unread data resets it, and a reset can take the answer away before the client has read it. */
#ifndef HE_SERVER_HTTP_HTTP_DEADLINE_H
#define HE_SERVER_HTTP_HTTP_DEADLINE_H

#include "api/metric/metrics.h"
#include "server/http/syntax/http_syntax.h"
#include "server/net/address.h"
#include "server/tls/certificate.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum srv_stage {
    SRV_STAGE_IDLE,
    SRV_STAGE_HEAD,
    SRV_STAGE_BODY,
    SRV_STAGE_WORK,
    SRV_STAGE_ANSWER,
    SRV_STAGE_LIVE,
    SRV_STAGE_HANDSHAKE
} srv_stage;

typedef struct srv_deadline_options {
    uint64_t idle, head, grace, total; /* seconds */
    uint64_t min_rate;                 /* bytes a second, 0: none */
    uint64_t max_connections;
    api_metrics *metrics; /* where connections that are closed are counted, NULL: nowhere */
} srv_deadline_options;

typedef struct srv_deadlines srv_deadlines;

enum { SRV_CLOSES = 16, SRV_LOOKS = 64 };

/* One open socket. Its stage is set by the worker that serves it and read by the thread. */
typedef struct srv_connection {
    struct srv_connection *next, *previous;
    int socket;
    _Atomic int stage;
    _Atomic uint64_t since;   /* microseconds of the monotonic clock */
    _Atomic uint64_t bytes;   /* received in this stage */
    bool drain;               /* drain after closing */
    gnutls_session_t session; /* NULL: plain */
    srv_certificates *certificates;
    srv_certificate *certificate; /* held from the handshake on; NULL: none is */
    bool is_proxy;                /* a trusted one: what it tells of its client is believed */
    api_rate_key client;          /* of its address */
    uint32_t of_peer;             /* peers.h */
    _Atomic bool beyond;          /* its address had as many connections as it may before */
    uint32_t buffer;              /* http_buffer.h */
    /* The worker's own. */
    srv_syntax syntax;
    uint64_t requests;   /* begun so far, as libmicrohttpd sees it */
    bool widened;        /* the socket has SRV_SEND_BUFFER, not SRV_FIRST_SEND_BUFFER */
    bool tells_end;      /* the kernel says with what is read whether there is more: http_recv.h */
    bool may_have_ended; /* it said so of what was read last */
    bool counts_sent;    /* of a Unix socket the kernel does not say how much was sent */
    _Atomic uint64_t sent; /* bytes, as far as they are counted; also read by the thread */
    /* The thread's own. */
    uint64_t acked;                /* the most that it ever found acknowledged */
    uint64_t window, window_acked; /* since when it measures an answer, 0: not */
    uint64_t taken;                /* `since` of the IDLE stage in which no byte waited, 0: none */
    uint64_t kept;                 /* bytes the kernel had for it, as they were counted last */
    bool late;                     /* it was closed for taking too long */
    uint64_t closed;               /* `since` of the stage in which the client closed, 0: not */
    uint64_t closed_bytes;
    char peer[SRV_ADDRESS_TEXT];
} srv_connection;

/* NULL when memory, descriptors or threads are out. */
srv_deadlines *srv_deadlines_new(const srv_deadline_options *options);
/* No connection may be left. */
void srv_deadlines_free(srv_deadlines *deadlines);

/* `session` NULL: no TLS. NULL when memory is out: then the socket is not watched. */
srv_connection *srv_deadlines_add(srv_deadlines *deadlines, int socket, const struct sockaddr *peer,
                                  gnutls_session_t session, uint32_t buffer);
/* The socket is about to be closed. Accepts NULL. */
void srv_deadlines_remove(srv_deadlines *deadlines, srv_connection *connection);
size_t srv_deadlines_count(const srv_deadlines *deadlines);

/* Accept NULL. */
void srv_connection_enter(srv_connection *connection, srv_stage stage, uint64_t now);
void srv_connection_moved(srv_connection *connection, uint64_t bytes);
/* Has the client left while its request is worked on? True when the connection was reset, and when
 * the client closed its side and its request has been in this stage for SRV_CLOSED_MICROS: a client
 * that only closed its writing side may still read, but is not told from one that is gone. For the
 * thread that works for the connection. */
enum { SRV_CLOSED_MICROS = 1000000 };
bool srv_connection_is_left(const srv_connection *connection, uint64_t now);

/* Has this connection outstayed its stage at `now`? `crowded`: there are too many. Not for
 * answers. */
bool srv_connection_is_late(const srv_connection *connection, const srv_deadline_options *options,
                            bool crowded, uint64_t now);
/* Does the client take its answer too slowly? To be asked again and again, with the bytes that
 * wait in the socket and all that were ever acknowledged. */
bool srv_connection_is_stuck(srv_connection *connection, const srv_deadline_options *options,
                             uint64_t outstanding, uint64_t acknowledged, uint64_t now);

#endif
