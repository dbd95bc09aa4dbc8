/* http_request.h - a request from its first line to its completion, and the house's door to
 * libmicrohttpd.
 *
 * This is the one file that includes <microhttpd.h>, and only the sources server/http*.c include
 * it; lint looks after both. Headers name a srv_request without its inside.
 *
 *     http.c          the daemon: options, start, stop, what libmicrohttpd calls
 *     http_handle.c   the moves of a request between its states: reading, waiting
 *     http_answer.c   sending what it is answered
 *     http_request.c  its beginning and end, and how it is suspended
 *
 * Each knows those below it, none those above.
 *
 * A request's states. libmicrohttpd calls `handle` once with the headers, once for each piece of
 * the body and once at its end, and once more after each resume; srv_request_handle makes every
 * move but the two marked.
 *
 *     FRESH -- headers --> BODY -- its end, the answer is there -----------------> DONE
 *       |                   |  \                                                    ^
 *       |                   |   +-- its end, long: begin_work --> WORK --do_work* ---+
 *       |                   |                                                       |
 *       |                   +-- refused while reading, much left: CUT               |
 *       +-- refused at once, much to come ------------------------------------------+
 *
 *     instead of DONE, when what the answer shows is not durable: HELD --resume_held*--> DONE
 *
 * While WORK or HELD the connection is suspended and no thread of libmicrohttpd touches it; the job
 * or the hold resumes it exactly once. An answer that goes on is DONE and suspended again and again
 * by `pull_live`: see http_live.h. So is one that is made ahead, by `pull_ahead`: http_ahead.h.
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
#include "store/durability_wait.h"

#include <microhttpd.h>
#include <stdatomic.h>

typedef enum srv_state { SRV_FRESH, SRV_BODY, SRV_WORK, SRV_HELD, SRV_DONE, SRV_CUT } srv_state;

/* Made and freed by http.c; outlives its requests. */
struct srv_http {
    struct MHD_Daemon *daemon;
    srv_http_options options;
    srv_deadlines *deadlines;
    srv_peers *peers; /* NULL: addresses may have as many connections as there are */
    srv_live *live;
    unsigned port;
    srv_ids ids;
    srv_spans spans;
    _Atomic bool stopping;
    srv_gate gate;
    _Atomic size_t downloads; /* answers that are sent piece by piece, but for those that go on */
};

typedef struct srv_request {
    srv_http *http;
    struct MHD_Connection *connection;
    srv_connection *socket; /* NULL when it is not watched */
    srv_state state;
    bool counted; /* by the gate */
    bool aside;   /* counted by the gate as suspended: until it runs again or has completed */
    bool whole;   /* all of the body has arrived */
    uint64_t started;
    uint64_t number; /* on its connection, from 1 */
    uint64_t bytes_in, bytes_out;
    uint64_t announced; /* Content-Length; UINT64_MAX when chunked */
    uint64_t swallowed; /* since the answer was known */
    char request_id[SRV_REQUEST_ID + 1];
    char *joined; /* headers whose lines were joined (http_headers.h), NULL: none were */
    srv_client client;
    const char *cors; /* the origin to be named, NULL: none */
    bool close;

    api_exchange *exchange; /* NULL: the answer is `refusal` */
    api_step step;
    api_problem refusal;
    api_text text;               /* the refusal as JSON */
    api_rate_fields rate_fields; /* of the exchange that the refusal took the place of */
    bool preflight;
    st_wait hold;
    uint64_t work_until; /* microseconds of the monotonic clock; UINT64_MAX: as long as it takes */
    srv_stream stream;
    srv_ahead ahead;
    size_t block; /* bytes libmicrohttpd holds for a download, 0: it is none */
    int status;
    srv_trace trace;
    srv_timing timing;

    char method[SRV_METHOD + 1];
    const char *path; /* NULL until the headers were read */
    char target[];    /* raw */
} srv_request;

/* The request line has arrived. NULL when memory is out, or when its bytes were not checked
 * (http_recv.h): then the connection is closed without an answer. */
srv_request *srv_request_begin(srv_http *http, const char *uri, struct MHD_Connection *connection);
/* Answered, or its client was lost: tells the log and frees the request. The
 * server may be freed at once after that. */
void srv_request_end(srv_request *r);

/* The address of the client, "192.0.2.1", THE one by which clients are counted and told apart: what
 * a trusted proxy tells (--trusted-proxy), else that of the connection. On a Unix socket it is the
 * user, "unix:uid=1000". It is known when the headers have been read, valid as long as the request,
 * and "" before that. Without --trusted-proxy all clients of a proxy have the proxy's address. */
static inline const char *srv_request_client(const srv_request *r)
{
    return r->client.address;
}

/* Suspend the connection, as long as that is allowed: to be called before another thread is told of
 * the request, which then resumes it, with MHD_resume_connection, exactly once. False when the gate
 * is closed: then nothing is suspended, and the connection is to be closed. */
bool srv_request_suspend(srv_request *r);
/* Its worker has it again: first in each callback before which it may have been suspended. */
void srv_request_resumed(srv_request *r);

#endif
