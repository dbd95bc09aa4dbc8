/* http.h - connects sockets with the exchanges of api/request/api.h.
 *
 * Only the sources of server/http know libmicrohttpd, through http_request.h, which draws the
 * states of a request and their transitions. Workers never block: long work runs on the pool while
 * the connection is suspended, and a connection also stays suspended until the revision in its
 * answer is durable (D1). */
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

/* What the server is started with. Everything is borrowed and must outlive the server. */
typedef struct srv_http_options {
    srv_address address;
    int listening;                  /* a listening socket; -1: the server binds `address` */
    srv_certificates *certificates; /* with a pair in force; NULL: no TLS */
    api_service *service;
    st_store *store;
    st_pool *pool;
    st_pool *makers; /* makes answers while they are sent: http_ahead.h */
    srv_log *log;    /* NULL: none */
    const srv_policy *policy;
    srv_deadline_options deadlines;
    size_t max_sockets; /* above deadlines.max_connections: those in between are answered 503 */
    size_t address_connections; /* maximum per address; 0: no limit */
    size_t workers;             /* threads, at least 1 */
    uint64_t read_seconds;      /* maximum duration of reads that the client waits for */
    uint64_t heartbeat_micros;  /* of silence, after which an open stream sends a comment */
} srv_http_options;

/* The number of connections that may wait to be accepted (the listen backlog). */
enum { SRV_BACKLOG = 1024 };

/* Starts to accept connections. Returns NULL with a sentence in `message` if it cannot. */
srv_http *srv_http_start(const srv_http_options *options, char *message, size_t size);
unsigned srv_http_port(const srv_http *http);
/* Stops accepting, answers 503 to new requests on open connections, and waits for running ones, for
 * at most `millis`. Returns true when all have ended and the server is freed. Returns false if work
 * is still running: then nothing that it may use can be freed, and the process should exit. */
bool srv_http_stop(srv_http *http, unsigned millis);

/* Returns the version of the libmicrohttpd that was loaded; static. */
const char *srv_http_library(void);

#endif
