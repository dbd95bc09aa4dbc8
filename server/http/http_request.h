/* http_request.h - a request from its first line to its completion, and the only door to
 * libmicrohttpd.
 *
 * This is the one file that includes <microhttpd.h>, and only the sources of server/http include
 * it; lint checks both. Headers only declare srv_request.
 *
 *     http.c          the daemon: options, start, stop, callbacks of libmicrohttpd
 *     http_handle.c   transitions of a request between its states: reading, waiting
 *     http_answer.c   sending the answer
 *     http_request.c  beginning and end of a request, and how it is suspended
 *
 * Each calls those below it in this list, none those above.
 *
 * The states of a request follow. libmicrohttpd calls `handle` once with the headers, once for each
 * piece of the body and once at its end, and once more after each resume; srv_request_handle makes
 * every transition but the two marked with a star.
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
 * In WORK and HELD the connection is suspended and no thread of libmicrohttpd touches it; the job
 * or the wait for durability resumes it exactly once. A stream is DONE, and `pull_live` suspends it
 * again and again: see http_live.h. `pull_ahead` does that with an answer that is made ahead:
 * http_ahead.h.
 */
#ifndef HE_SERVER_HTTP_HTTP_REQUEST_H
#define HE_SERVER_HTTP_HTTP_REQUEST_H

#include "api/json/problem.h"
#include "server/http/http.h"
#include "server/http/http_admit.h"
#include "server/http/http_ahead.h"
#include "server/http/http_gate.h"
#include "server/http/http_live.h"
#include "server/log/timing.h"
#include "server/log/trace.h"
#include "server/net/peers.h"
#include "store/publish/durability_wait.h"

#include <microhttpd.h>
#include <stdatomic.h>

typedef enum srv_state { SRV_FRESH, SRV_BODY, SRV_WORK, SRV_HELD, SRV_DONE, SRV_CUT } srv_state;

/* The server. It is made and freed by http.c, and outlives its requests. */
struct srv_http {
    struct MHD_Daemon *daemon;
    srv_http_options options;
    srv_deadlines *deadlines;
    srv_peers *peers; /* NULL: no limit of connections per address */
    srv_live *live;
    unsigned port;
    srv_ids ids;
    srv_spans spans;
    _Atomic bool stopping;
    srv_gate gate;
    _Atomic size_t downloads; /* number of answers sent piece by piece, except streams of events */
};

typedef struct srv_request {
    srv_http *http;
    struct MHD_Connection *connection;
    srv_connection *socket; /* NULL: not watched */
    srv_state state;
    bool counted; /* counted by the gate */
    bool aside;   /* counted by the gate as suspended, until it runs again or has completed */
    bool whole;   /* the whole body has arrived */
    uint64_t started;
    uint64_t number; /* number of the request on its connection, from 1 */
    uint64_t bytes_in, bytes_out;
    uint64_t announced; /* Content-Length; UINT64_MAX: chunked */
    uint64_t swallowed; /* bytes of the body skipped since the answer was known */
    char request_id[SRV_REQUEST_ID + 1];
    char *joined; /* headers whose lines were joined (http_headers.h); NULL: none */
    srv_client client;
    bool close;

    api_exchange *exchange; /* NULL: the answer is `refusal` */
    api_step step;
    api_problem refusal;
    api_text text;               /* the refusal as JSON */
    api_rate_fields rate_fields; /* of the exchange that the refusal took the place of */
    bool preflight;
    st_wait hold;
    uint64_t work_until; /* microseconds of the monotonic clock; UINT64_MAX: no limit */
    srv_stream stream;
    srv_ahead ahead;
    size_t block; /* bytes libmicrohttpd allocated for a download; 0: none */
    int status;
    srv_trace trace;
    srv_timing timing;

    char method[SRV_METHOD + 1];
    const char *path; /* NULL before the headers were read */
    char target[];    /* raw */
} srv_request;

/* Begins a request when its request line has arrived. Returns NULL when memory is out, or if its
 * bytes were not checked (http_recv.h): the connection is then closed without an answer. */
srv_request *srv_request_begin(srv_http *http, const char *uri, struct MHD_Connection *connection);
/* Ends a request that was answered or whose client is gone: logs it and frees it. The server may be
 * freed right afterwards. */
void srv_request_end(srv_request *r);

/* Returns the address of the client, such as "192.0.2.1": THE address by which clients are counted
 * and distinguished. It is what a trusted proxy says (--trusted-proxy), else the address of the
 * connection. On a Unix socket it is the user, "unix:uid=1000". It is "" until the headers have
 * been read, and valid as long as the request. Without --trusted-proxy all clients of a proxy have
 * the proxy's address. */
static inline const char *srv_request_client(const srv_request *r)
{
    return r->client.address;
}

/* Suspends the connection, if that is still allowed. Call it before another thread gets the
 * request; that thread then resumes it with MHD_resume_connection, exactly once. Returns false if
 * the gate is closed: nothing is suspended, and the connection must be closed. */
bool srv_request_suspend(srv_request *r);
/* Records that the worker owns the request again. It must be called first in each callback before
 * which the request may have been suspended. */
void srv_request_resumed(srv_request *r);

#endif
