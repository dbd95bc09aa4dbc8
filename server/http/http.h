/* http.h - sockets on one side, exchanges of api/request/api.h on the other.
 *
 * Only the sources of server/http know libmicrohttpd, through http_request.h, where the states of a
 * request and who moves it are drawn. Workers never block: what api calls long work runs on the
 * pool while the connection is suspended, and so waits an answer whose revision is not yet durable
 * (D1). */
#ifndef HE_SERVER_HTTP_HTTP_H
#define HE_SERVER_HTTP_HTTP_H

#include "api/request/api.h"
#include "server/http/http_deadline.h"
#include "server/http/http_policy.h"
#include "server/log/log.h"
#include "server/net/address.h"
#include "store/store.h"
#include "system/thread_pool.h"

typedef struct srv_http srv_http;

/* Everything is borrowed and outlives the server. */
typedef struct srv_http_options {
    srv_address address;
    int listening; /* a socket that listens on a path already; -1: `address` is bound here */
    srv_certificates *certificates; /* a pair is in force; NULL: no TLS */
    api_service *service;
    st_store *store;
    st_pool *pool;
    st_pool *makers; /* for answers that are made while they are sent: http_ahead.h */
    srv_log *log;    /* NULL: none */
    const srv_policy *policy;
    srv_deadline_options deadlines;
    size_t max_sockets; /* above deadlines.max_connections: those between are answered 503 */
    size_t address_connections; /* of one address at once; 0: as many as there are */
    size_t workers;             /* threads, from 1 */
    uint64_t read_seconds;      /* that a client may wait for what it reads */
    uint64_t heartbeat_micros;  /* of silence, after which an answer that goes on sends a comment */
} srv_http_options;

/* The connections that wait to be accepted. */
enum { SRV_BACKLOG = 1024 };

/* Begins to accept. NULL with a sentence in `message` when it cannot. */
srv_http *srv_http_start(const srv_http_options *options, char *message, size_t size);
unsigned srv_http_port(const srv_http *http);
/* Accept nothing more, answer 503 to what comes on open connections, let what runs end, for at most
 * `millis`. True when all has ended and the server is freed; false when work still runs: then
 * nothing it may use can be freed, and the process should exit. */
bool srv_http_stop(srv_http *http, unsigned millis);

/* The version of libmicrohttpd that the process was given; static. */
const char *srv_http_library(void);

#endif
