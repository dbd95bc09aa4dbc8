/* http_request.h - a request from its first line to its completion, and the only header that gives
 * access to libmicrohttpd.
 *
 * This is the one file that includes <microhttpd.h>, and only the sources of server/http include
 * it; lint checks both. Headers only declare srv_request.
 *
 *     http.c          the daemon: options, start, stop, callbacks of libmicrohttpd
 *     http_handle.c   transitions of a request between its states: reading, waiting
 *     http_answer.c   sending the answer
 *     http_request.c  beginning and end of a request, and how it is suspended
 *
 * Each of these files calls only functions of files below it in this list.
 *
 * The states of a request follow. libmicrohttpd calls `handle` once with the headers, once for each
 * piece of the body and once at its end, and once more after each resume; srv_request_handle makes
 * every transition except the two marked with a star.
 *
 *     FRESH -- headers --> BODY -- its end, the answer is there -----------------> DONE
 *       |                   |  \                                                    ^
 *       |                   |   +-- its end, long: begin_work --> WORK --do_work* ---+
 *       |                   |                                                       |
 *       |                   +-- refused while reading, much left: CUT               |
 *       +-- refused at once, much to come ------------------------------------------+
 *
 *     instead of DONE, while the answer is not durable: HELD --resume_held*--> DONE
 *
 * In WORK and HELD the connection is suspended and no thread of libmicrohttpd touches it; the
 * thread that has done the work, or the store when the changes are durable, resumes it exactly
 * once. In DONE an answer that is sent piece by piece may be suspended again and again: a stream of
 * events by `pull_live` (http_stream.h), and an answer made by other threads by `pull_producer`
 * (http_producer.h).
 */
#ifndef HE_SERVER_HTTP_HTTP_REQUEST_H
#define HE_SERVER_HTTP_HTTP_REQUEST_H

#include "api/json/problem.h"
#include "server/http/http.h"
#include "server/http/http_admit.h"
#include "server/http/http_inflight.h"
#include "server/http/http_producer.h"
#include "server/http/http_stream.h"
#include "server/log/timing.h"
#include "server/log/trace.h"
#include "server/net/peers.h"
#include "store/publish/durability_wait.h"
#include "system/spare.h"

#include <microhttpd.h>
#include <stdatomic.h>

typedef enum srv_state { SRV_FRESH, SRV_BODY, SRV_WORK, SRV_HELD, SRV_DONE, SRV_CUT } srv_state;

/* The HTTP server. It is made and freed by http.c, and outlives its requests. */
struct srv_http {
    struct MHD_Daemon *daemon;
    srv_http_options options;
    srv_deadlines *deadlines;
    srv_peers *peers; /* counts connections by address; NULL if they are not limited */
    srv_streams *streams;
    unsigned port;
    srv_ids ids;
    srv_spans spans;
    _Atomic bool stopping;
    srv_inflight inflight;
    st_spares requests;       /* freed blocks of requests, each of SRV_REQUEST_BLOCK bytes */
    _Atomic size_t downloads; /* number of answers sent piece by piece, except streams of events */
};

typedef struct srv_request {
    srv_http *http;
    struct MHD_Connection *connection;
    /* The connection as http_recv.h watches it; NULL if it is not watched. */
    srv_connection *socket;
    srv_state state;
    bool counted; /* true while http_inflight.h counts the request as running */
    bool aside;   /* true while http_inflight.h counts the connection as suspended */
    bool whole;   /* whether the whole body of the request has arrived */
    uint64_t started;
    uint64_t number; /* number of the request on its connection, from 1 */
    uint64_t bytes_in, bytes_out;
    uint64_t announced; /* Content-Length; UINT64_MAX: chunked */
    /* Number of bytes of the body that were skipped because the answer was known already. */
    uint64_t swallowed;
    char request_id[SRV_REQUEST_ID + 1];
    char *joined; /* values of headers with several lines (http_headers.h); NULL if none */
    srv_client client;
    bool close;    /* whether the connection is to be closed after the answer */
    bool is_spare; /* whether the block of the request is one of srv_http.requests */

    /* The exchange that makes the answer; NULL if the answer is `refusal`. */
    api_exchange *exchange;
    api_step step;
    api_problem refusal;
    api_text text; /* the refusal as JSON */
    /* The rate-limit headers of an exchange that was replaced by the refusal. */
    api_rate_fields rate_fields;
    bool preflight; /* whether the request is a CORS preflight request */
    st_wait hold;   /* the wait for durability in the state HELD */
    /* Time (st_clock_micros) at which the work must end; UINT64_MAX: no limit. */
    uint64_t work_until;
    srv_stream stream;
    srv_producer producer;
    size_t block; /* number of bytes that libmicrohttpd allocated to send a download; 0: none */
    int status;
    srv_trace trace;
    srv_timing timing;

    char method[SRV_METHOD + 1];
    const char *path; /* path of the request; NULL before the headers were read */
    char target[];    /* the request target as the client sent it */
} srv_request;

/* The size of the blocks of requests that are kept for further requests. A request whose target
 * does not fit has a block of its own, larger than this. */
enum { SRV_REQUEST_BLOCK = sizeof(srv_request) + 256 };

/* Begins a request whose request line has arrived. Returns NULL when memory is out, or if the bytes
 * of the request were not checked (http_recv.h); then the connection is closed without an answer.
 */
srv_request *srv_request_begin(srv_http *http, const char *uri, struct MHD_Connection *connection);
/* Ends a request that was answered or whose client is gone: logs it and frees it. The server may be
 * freed right afterwards. */
void srv_request_end(srv_request *r);

/* Returns the address of the client, such as "192.0.2.1", by which the limits and the log
 * distinguish clients. If the connection comes from a trusted proxy (--trusted-proxy), it is the
 * address that the proxy reports, else that of the connection; on a Unix socket it is the user,
 * "unix:uid=1000". So all clients of a proxy that is not trusted have the proxy's address. The text
 * is "" until the headers have been read, and valid as long as the request. */
static inline const char *srv_request_client(const srv_request *r)
{
    return r->client.address;
}

/* Suspends the connection. Must be called before the request is passed to another thread, which
 * then resumes the connection with MHD_resume_connection, exactly once. Returns false if the gate
 * of http_inflight.h is closed, because the server stops: then the connection is not suspended and
 * must be closed. */
bool srv_request_suspend(srv_request *r);
/* Records that the connection is not suspended any more. Must be called at the beginning of each
 * callback before which the connection may have been suspended. */
void srv_request_resumed(srv_request *r);

#endif
