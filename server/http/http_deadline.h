/* http_deadline.h - closes connections that are too slow.
 *
 * libmicrohttpd only has a timeout for connections on which no byte arrives: one byte now and then
 * keeps a connection open for ever. A thread of this module checks every connection twice a second.
 * If a connection exceeds the time of its stage, the thread shuts down its socket; libmicrohttpd
 * then sees the end of the stream and closes the connection. The stages are
 *
 *     HANDSHAKE                       of TLS; a connection without TLS begins with IDLE
 *         |
 *     IDLE    --first byte-->  HEAD  --headers-->  BODY  --all of it-->  WORK  --queued--> ANSWER
 *       ^                                                                                       |
 *       +---------------------------------- completed ------------------------------------------+
 *
 * and their limits, with the members of srv_deadline_options:
 *
 *     HANDSHAKE  `head` seconds, or two seconds if there are too many connections in all or of this
 *             client's address
 *     IDLE    `idle` seconds, or two seconds in the same cases
 *     HEAD    `head` seconds
 *     BODY    `total` seconds in all, and after the first `grace` seconds an average of at least
 *             min_rate bytes a second
 *     WORK    no limit, because the client waits for the server. The thread that works on the
 *             request checks whether the client still waits: it stops at once if the connection was
 *             reset, and after a second if the client has closed its side, so that short work is
 *             still answered
 *     ANSWER  at least min_rate bytes a second, measured over `grace` seconds, while bytes wait to
 *             be read by the client. Bytes count when the client's system has acknowledged them,
 *             not when they are in the socket's buffer; on a Unix socket, which acknowledges
 *             nothing, they count when the client has read them. The limit applies during IDLE,
 *             too, while the rest of an answer is in that buffer
 *     LIVE    the stage of a stream of events (http_stream.h) instead of ANSWER: at least one byte
 * a second, measured over `total` seconds, while bytes wait to be read by the client
 *
 * In the stages HEAD and BODY a connection is also closed if the client has closed its side, so
 * that the request can never become complete.
 *
 * Closing a connection costs the worker threads time, because they clean up. If a thousand slow
 * clients connected at the same time, other clients must not be delayed when they are closed: so at
 * most SRV_CLOSES connections are closed at once, and the next ones a hundredth of a second later.
 * The lock of the list of connections is held for at most SRV_CLOSES closes or SRV_LOOKS checks.
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
    /* Least speed of a body or an answer, in bytes a second; 0: no minimum. */
    uint64_t min_rate;
    uint64_t max_connections;
    api_metrics *metrics; /* counts connections that are closed; NULL: not counted */
} srv_deadline_options;

typedef struct srv_deadlines srv_deadlines;

enum { SRV_CLOSES = 16, SRV_LOOKS = 64 };

/* One open connection. The worker thread that serves the connection sets its stage; the thread of
 * this module reads the stage. */
typedef struct srv_connection {
    struct srv_connection *next, *previous;
    int socket;
    _Atomic int stage;
    _Atomic uint64_t since;   /* when the stage began, in microseconds of the monotonic clock */
    _Atomic uint64_t bytes;   /* bytes received in this stage */
    bool drain;               /* whether the connection is to be drained when it is closed */
    gnutls_session_t session; /* the TLS session; NULL if the connection does not use TLS */
    /* Metrics that count the connection's handshake; NULL: it is not counted. */
    api_metrics *metrics;
    srv_certificates *certificates;
    /* Reference to the certificate that the handshake shows; NULL before the handshake. */
    srv_certificate *certificate;
    bool is_proxy;       /* whether the peer is a trusted proxy: proxy.h */
    api_rate_key client; /* key of the peer's address, by srv_address_key */
    uint32_t of_peer;    /* the peer's entry, which srv_peers_enter returned for the connection */
    _Atomic bool beyond; /* whether the peer's address has more connections than allowed */
    uint32_t buffer;     /* number of the connection's memory buffer (http_buffer.h) */
    /* The members from here on are used only by the worker thread that serves the connection. */
    srv_syntax syntax;
    uint64_t requests; /* number of requests of the connection that libmicrohttpd has begun */
    /* Whether the socket's send buffer has SRV_SEND_BUFFER bytes rather than
     * SRV_FIRST_SEND_BUFFER. */
    bool widened;
    /* Whether the kernel reports with each read whether there is more to read: http_recv.h. */
    bool tells_end;
    /* True if the client's stream may have ended after the bytes of the last read. */
    bool may_have_ended;
    /* True if `sent` is counted, because the connection is a Unix socket, for which the kernel does
     * not report how many bytes were sent. */
    bool counts_sent;
    /* Number of bytes that were sent, if they are counted. The thread that checks connections reads
     * it, too. */
    _Atomic uint64_t sent;
    /* The members from here on are used only by the thread that checks connections, except
     * `peer`. */
    /* Number of bytes that the client had received at the last check. */
    uint64_t acked;
    /* The time, and the value of `acked`, when the present measurement of the rate began; 0: no
     * measurement. */
    uint64_t window, window_acked;
    /* Identifies, by its value of `since`, the IDLE stage in which the client was found to have
     * read all of the last answer; 0: there is none. */
    uint64_t taken;
    uint64_t kept; /* number of the answer's bytes in the kernel's buffer at the last check */
    bool late;     /* whether the connection was counted as closed for being too slow */
    /* Identifies, by its value of `since`, the stage in which the client closed its side; 0: it has
     * not. */
    uint64_t closed;
    uint64_t closed_bytes;       /* `bytes` when `closed` was set */
    char peer[SRV_ADDRESS_TEXT]; /* the peer's address, without a port */
} srv_connection;

/* Makes an empty list of connections, and starts the thread that checks them. Returns NULL when
 * memory, descriptors or threads are out. */
srv_deadlines *srv_deadlines_new(const srv_deadline_options *options);
/* Ends the thread and frees the list, which must be empty. */
void srv_deadlines_free(srv_deadlines *deadlines);

/* Adds a connection to the list. `session` is NULL if the connection does not use TLS, `buffer` is
 * its number in http_buffer.h. Returns NULL when memory is out; then the connection has no limits.
 */
srv_connection *srv_deadlines_add(srv_deadlines *deadlines, int socket, const struct sockaddr *peer,
                                  gnutls_session_t session, uint32_t buffer);
/* Removes a connection, which may be NULL, from the list. Must be called before the socket is
 * closed. */
void srv_deadlines_remove(srv_deadlines *deadlines, srv_connection *connection);
size_t srv_deadlines_count(const srv_deadlines *deadlines);

/* srv_connection_enter records that a connection has entered a stage, the next function that bytes
 * of the request have been handled. Both do nothing for NULL. */
void srv_connection_enter(srv_connection *connection, srv_stage stage, uint64_t now);
void srv_connection_moved(srv_connection *connection, uint64_t bytes);
/* Returns true if the client has left while a thread works on its request: if the connection was
 * reset, or if the client has closed its side and the request has been in this stage for
 * SRV_CLOSED_MICROS. (A client that closed only its writing side may still read, but cannot be
 * distinguished from a client that is gone.) Called by the thread that works on the request. */
enum { SRV_CLOSED_MICROS = 1000000 };
bool srv_connection_is_left(const srv_connection *connection, uint64_t now);

/* Returns true if the connection has exceeded the time of its stage at `now`; `crowded` is true if
 * there are too many connections. The stages ANSWER and LIVE are not checked by this function. */
bool srv_connection_is_late(const srv_connection *connection, const srv_deadline_options *options,
                            bool crowded, uint64_t now);
/* Returns true if the client reads its answer too slowly. Must be called again and again during the
 * answer; `outstanding` is the number of bytes that wait in the socket's buffer, `acknowledged` the
 * number of bytes of the connection that the client has acknowledged so far. */
bool srv_connection_is_stuck(srv_connection *connection, const srv_deadline_options *options,
                             uint64_t outstanding, uint64_t acknowledged, uint64_t now);

#endif
