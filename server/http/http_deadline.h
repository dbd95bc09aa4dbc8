/* http_deadline.h - closes connections that are too slow.
 *
 * libmicrohttpd has a timeout of silence only: one byte now and then keeps a connection open for
 * ever. A thread of this module checks every connection twice a second and shuts down the socket of
 * one that exceeds the time of its stage; libmicrohttpd then sees the end and cleans up.
 *
 *     HANDSHAKE                       of TLS; a plain connection begins with IDLE
 *         |
 *     IDLE    --first byte-->  HEAD  --headers-->  BODY  --all of it-->  WORK  --queued--> ANSWER
 *       ^                                                                                       |
 *       +---------------------------------- completed ------------------------------------------+
 *
 *     HANDSHAKE  `head` seconds; only a short time if there are too many connections
 *     IDLE    `idle` seconds; only a short time if there are too many connections, or too many of
 *             its address
 *     HEAD    `head` seconds
 *     BODY    `total` seconds, and after `grace` seconds min_rate bytes a second on average.
 *             Neither BODY nor HEAD is ended here if the client has closed its side:
 *             libmicrohttpd's timeout does that
 *     WORK    not limited here, because the client waits for the server. The working thread checks
 *             whether it still does: work for a connection that was reset ends at once, work for a
 *             client that closed its side after a second, so that short work is still answered
 *     ANSWER  while bytes wait to be read: min_rate bytes a second, over `grace` seconds. Bytes
 *             count when the client's side has acknowledged them, not when they are in the socket's
 *             buffer; on a Unix socket, which acknowledges nothing, when the client has read them.
 *             The check continues during IDLE if the rest of an answer is in that buffer
 *     LIVE    a stream (http_live.h), in place of ANSWER: while bytes wait to be read, one a second
 *             over `total` seconds
 *
 * Closing a connection costs time of the workers, which clean up, and of the clients' side. A
 * thousand slow clients that connected together must not delay others when they are closed
 * together: at most SRV_CLOSES are closed at once, and the next ones a hundredth of a second later.
 * The lock of the list is held for as many, or for SRV_LOOKS checks.
 *
 * The module also drains connections that were answered before their body was read: closing a
 * socket with unread data resets it, and a reset can discard the answer before the client has read
 * it. */
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
    uint64_t idle, head, grace, total; /* in seconds */
    uint64_t min_rate;                 /* in bytes a second; 0: no minimum */
    uint64_t max_connections;
    api_metrics *metrics; /* counts connections that are closed; NULL: not counted */
} srv_deadline_options;

typedef struct srv_deadlines srv_deadlines;

enum { SRV_CLOSES = 16, SRV_LOOKS = 64 };

/* One open socket. The worker that serves it sets its stage; the thread of this module reads the
 * stage. */
typedef struct srv_connection {
    struct srv_connection *next, *previous;
    int socket;
    _Atomic int stage;
    _Atomic uint64_t since;   /* start of the stage, microseconds of the monotonic clock */
    _Atomic uint64_t bytes;   /* received in this stage */
    bool drain;               /* drain the socket after closing */
    gnutls_session_t session; /* NULL: plain */
    api_metrics *metrics;     /* count its handshake; NULL: not counted */
    srv_certificates *certificates;
    srv_certificate *certificate; /* a reference from the handshake on; NULL: none */
    bool is_proxy;                /* a trusted proxy: what it says about its client is believed */
    api_rate_key client;          /* key of its address */
    uint32_t of_peer;             /* entry in peers.h */
    _Atomic bool beyond;          /* its address already had the maximum of connections */
    uint32_t buffer;              /* its buffer in http_buffer.h */
    /* Used by the worker only. */
    srv_syntax syntax;
    uint64_t requests;   /* requests begun so far, as counted from libmicrohttpd's calls */
    bool widened;        /* the socket has SRV_SEND_BUFFER rather than SRV_FIRST_SEND_BUFFER */
    bool tells_end;      /* the kernel reports with each read whether there is more: http_recv.h */
    bool may_have_ended; /* it did so for the last read */
    bool counts_sent;    /* bytes sent are counted, because a Unix socket does not report them */
    _Atomic uint64_t sent; /* bytes sent, if they are counted; the thread reads it, too */
    /* Used by the thread only. */
    uint64_t acked;                /* the most bytes found acknowledged so far */
    uint64_t window, window_acked; /* start of the measured interval of an answer, 0: none */
    uint64_t taken;  /* `since` of an IDLE stage in which no byte was waiting, 0: none */
    uint64_t kept;   /* bytes in the kernel's buffer at the last count */
    bool late;       /* it was closed for being too slow */
    uint64_t closed; /* `since` of the stage in which the client closed its side, 0: none */
    uint64_t closed_bytes;
    char peer[SRV_ADDRESS_TEXT];
} srv_connection;

/* Makes the watch over connections, with its thread. Returns NULL when memory, descriptors or
 * threads are out. */
srv_deadlines *srv_deadlines_new(const srv_deadline_options *options);
/* Ends the thread and frees the watch. No connection may be left. */
void srv_deadlines_free(srv_deadlines *deadlines);

/* Adds a connection whose time is to be limited. `session` is NULL without TLS. Returns NULL when
 * memory is out; the socket is then not watched. */
srv_connection *srv_deadlines_add(srv_deadlines *deadlines, int socket, const struct sockaddr *peer,
                                  gnutls_session_t session, uint32_t buffer);
/* Removes a connection, which may be NULL. It must be called before the socket is closed. */
void srv_deadlines_remove(srv_deadlines *deadlines, srv_connection *connection);
size_t srv_deadlines_count(const srv_deadlines *deadlines);

/* Both take NULL. */
void srv_connection_enter(srv_connection *connection, srv_stage stage, uint64_t now);
void srv_connection_moved(srv_connection *connection, uint64_t bytes);
/* Returns true if the client has left while its request is worked on: if the connection was reset,
 * or if the client closed its side and the request has been in this stage for SRV_CLOSED_MICROS. (A
 * client that closed only its writing side may still read, but cannot be distinguished from one
 * that is gone.) Called by the thread that works on the request. */
enum { SRV_CLOSED_MICROS = 1000000 };
bool srv_connection_is_left(const srv_connection *connection, uint64_t now);

/* Returns true if the connection has exceeded the time of its stage at `now`. `crowded` says that
 * there are too many connections. It is not used for answers. */
bool srv_connection_is_late(const srv_connection *connection, const srv_deadline_options *options,
                            bool crowded, uint64_t now);
/* Returns true if the client reads its answer too slowly. It must be called repeatedly, with the
 * bytes waiting in the socket and all bytes ever acknowledged. */
bool srv_connection_is_stuck(srv_connection *connection, const srv_deadline_options *options,
                             uint64_t outstanding, uint64_t acknowledged, uint64_t now);

#endif
