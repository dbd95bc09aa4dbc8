/* http.h - the HTTP server: it passes requests that arrive on sockets to api/request/api.h, and
 * sends the answers.
 *
 * Only the sources of server/http know libmicrohttpd, through http_request.h, which draws the
 * states of a request and their transitions. Worker threads, which serve the connections, never
 * block: long work runs on a pool of other threads while the connection is suspended. A connection
 * also stays suspended until the revision in its answer is durable (D1). */
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

/* The options with which the server is started. All pointers are borrowed and must outlive the
 * server. */
typedef struct srv_http_options {
    srv_address address;
    int listening; /* a listening socket; -1 if the server is to bind `address` */
    /* The TLS certificates, which must have a certificate and key in force; NULL if TLS is not
     * used. */
    srv_certificates *certificates;
    api_service *service;
    st_store *store;
    st_pool *pool;
    st_pool *makers; /* threads that make pieces of answers: http_producer.h */
    srv_log *log;    /* NULL if nothing is logged */
    const srv_policy *policy;
    srv_deadline_options deadlines;
    /* The most sockets. Connections beyond deadlines.max_connections, up to this number, are
     * answered 503. */
    size_t max_sockets;
    size_t address_connections; /* maximum of connections per address; 0: no limit */
    size_t workers;             /* number of worker threads, at least 1 */
    /* Most seconds for which a request that only reads may work while its client waits. */
    uint64_t read_seconds;
    uint64_t heartbeat_micros; /* time without an event after which a stream sends a comment */
} srv_http_options;

/* The number of connections that may wait to be accepted (the listen backlog). */
enum { SRV_BACKLOG = 1024 };

/* Starts to accept connections. On failure returns NULL with a sentence in `message`. */
srv_http *srv_http_start(const srv_http_options *options, char *message, size_t size);
unsigned srv_http_port(const srv_http *http);
/* Stops accepting connections, answers 503 to new requests on open connections, and waits at most
 * `millis` until the running requests have ended. Returns true after the server was stopped and
 * freed. Returns false if work is still running: then nothing that this work may use can be freed,
 * and the process should exit. */
bool srv_http_stop(srv_http *http, unsigned millis);

/* Returns the version of the libmicrohttpd that was loaded, as a static text. */
const char *srv_http_library(void);

#endif
