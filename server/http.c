#include "server/http.h"

#include "api/limits.h"
#include "api/problem.h"
#include "server/clock.h"
#include "server/held.h"
#include "server/http_admit.h"
#include "server/http_ahead.h"
#include "server/http_framing.h"
#include "server/http_gate.h"
#include "server/http_lists.h"
#include "server/http_live.h"
#include "server/http_wire.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <microhttpd.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A request's states. libmicrohttpd calls `handle` once with the headers, once for each piece of
 * the body and once at its end, and once more after each resume; `handle` makes every move but
 * the two marked.
 *
 *     FRESH -- headers --> BODY -- its end, the answer is there -----------------> DONE
 *       |                   |  \                                                    ^
 *       |                   |   +-- its end, long: begin_work --> WORK --do_job* ---+
 *       |                   |                                                       |
 *       |                   +-- refused while reading, much left: CUT               |
 *       +-- refused at once, much to come ------------------------------------------+
 *
 *     instead of DONE, when what the answer shows is not durable: HELD --resume_held*--> DONE
 *
 * While WORK or HELD the connection is suspended and no thread of libmicrohttpd touches it; the job
 * or the hold resumes it exactly once. An answer that goes on is DONE and suspended again and again
 * by `pull_live`: see http_live.h. So is one that is slow to make, by `pull_ahead`: http_ahead.h.
 */
typedef enum state { FRESH, BODY, WORK, HELD, DONE, CUT } state;

enum {
    /* Of a connection's buffer: above SRV_MAX_HEAD and API_MAX_URI, so that we refuse first. No
     * larger: libmicrohttpd zeroes all of it after each request, and with 64 connections of
     * 128 KiB that leaves the cache and costs more than half of the throughput. */
    POOL_BYTES = 32 * 1024,
    SWALLOW = 256 * 1024,     /* of a refused body, rather than close the connection */
    ANSWER_BLOCK = 64 * 1024, /* asked of a reader at once */
    LIVE_BLOCK = 1024,        /* the same, where thousands wait; used by HTTP/1.0 only */
    BACKLOG = 1024
};

struct srv_http {
    struct MHD_Daemon *daemon;
    srv_http_options options;
    srv_deadlines *deadlines;
    srv_live *live;
    unsigned port;
    srv_ids ids;
    _Atomic bool stopping;
    srv_gate gate;
};

typedef struct request {
    srv_http *http;
    struct MHD_Connection *connection;
    srv_connection *socket; /* NULL when it is not watched */
    state state;
    bool counted; /* by the gate */
    bool aside;   /* counted by the gate as suspended: until it runs again or has completed */
    bool whole;   /* all of the body has arrived */
    uint64_t started;
    uint64_t bytes_in, bytes_out;
    uint64_t announced; /* Content-Length; UINT64_MAX when chunked */
    uint64_t swallowed; /* since the answer was known */
    char request_id[SRV_REQUEST_ID + 1];
    srv_lists lists;
    const char *cors; /* the origin to be named, NULL: none */
    bool close;

    api_exchange *exchange; /* NULL: the answer is `refusal` */
    api_step step;
    api_problem refusal;
    api_text text; /* the refusal as JSON */
    bool preflight;
    srv_hold hold;
    srv_stream stream;
    srv_ahead ahead;
    int status;

    char method[SRV_METHOD + 1];
    const char *path; /* NULL until the headers were read */
    char target[];    /* raw */
} request;

/* --- life --- */

static srv_connection *socket_of(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info == NULL ? NULL : info->socket_context;
}

/* The request line has arrived. Longer targets than are allowed are kept to one character more. */
static void *request_begin(void *context, const char *uri, struct MHD_Connection *connection)
{
    size_t length = strnlen(uri, API_MAX_URI + 1);
    request *r = he_mem_zero(1, sizeof *r + length + 1);
    if (r == NULL) {
        return NULL;
    }
    memcpy(r->target, uri, length);
    r->http = context;
    r->connection = connection;
    r->socket = socket_of(connection);
    r->started = srv_clock_micros();
    srv_connection_enter(r->socket, SRV_STAGE_HEAD, r->started);
    return r;
}

static void copy_text(char *out, size_t size, const char *text)
{
    size_t length = strnlen(text, size - 1);
    memcpy(out, text, length);
    out[length] = '\0';
}

static void write_log(const request *r, uint64_t now)
{
    srv_access access; /* not zeroed: most of it is room for a long path */
    access.time = srv_clock_utc();
    access.route = r->exchange == NULL ? "-" : api_answer_of(r->exchange)->route;
    access.status = r->status;
    access.bytes_in = r->bytes_in;
    access.bytes_out = r->bytes_out;
    access.duration_us = now - r->started;
    copy_text(access.request_id, sizeof access.request_id, r->request_id);
    copy_text(access.method, sizeof access.method, r->method);
    copy_text(access.path, sizeof access.path, r->path == NULL ? r->target : r->path);
    copy_text(access.peer, sizeof access.peer, r->socket == NULL ? "-" : r->socket->peer);
    srv_access_log_add(r->http->options.log, &access);
}

/* About to suspend the connection, as long as that is allowed. */
static bool go_aside(request *r)
{
    r->aside = srv_gate_wait(&r->http->gate);
    return r->aside;
}

/* The connection is not suspended any more. */
static void come_back(request *r)
{
    if (r->aside) {
        r->aside = false;
        srv_gate_resume(&r->http->gate);
    }
}

static void request_completed(void *context, struct MHD_Connection *connection, void **slot,
                              enum MHD_RequestTerminationCode how)
{
    (void)context;
    (void)connection;
    (void)how;
    request *r = *slot;
    *slot = NULL;
    if (r == NULL) {
        return;
    }
    srv_http *http = r->http;
    uint64_t now = srv_clock_micros();
    srv_connection_enter(r->socket, SRV_STAGE_IDLE, now);
    if (r->counted && http->options.log != NULL) {
        write_log(r, now);
    }
    bool counted = r->counted;
    come_back(r); /* a client who was lost while it was suspended comes here at once */
    srv_ahead_clear(&r->ahead);
    api_free(r->exchange);
    srv_lists_clear(&r->lists);
    api_text_clear(&r->text);
    he_mem_free(r);
    if (counted) {
        srv_gate_leave(&http->gate);
    }
}

/* --- answering --- */

static ssize_t pull(void *context, uint64_t position, char *buffer, size_t size)
{
    (void)position;
    request *r = context;
    const api_answer *answer = api_answer_of(r->exchange);
    int64_t got = answer->read(answer->context, buffer, size);
    if (got > 0) {
        r->bytes_out += (uint64_t)got;
        return (ssize_t)got;
    }
    bool complete = got == 0 && (answer->length < 0 || r->bytes_out == (uint64_t)answer->length);
    return complete ? MHD_CONTENT_READER_END_OF_STREAM : MHD_CONTENT_READER_END_WITH_ERROR;
}

static void resume_ahead(srv_ahead *ahead)
{
    request *r = (request *)((char *)ahead - offsetof(request, ahead));
    MHD_resume_connection(r->connection);
}

/* The same for an answer that is slow to make. */
static ssize_t pull_ahead(void *context, uint64_t position, char *buffer, size_t size)
{
    (void)position;
    request *r = context;
    const api_answer *answer = api_answer_of(r->exchange);
    come_back(r);
    r->ahead.read = answer->read;
    r->ahead.context = answer->context;
    r->ahead.resume = resume_ahead;
    int64_t got = srv_ahead_take(&r->ahead, buffer, size);
    if (got > 0) {
        r->bytes_out += (uint64_t)got;
        return (ssize_t)got;
    }
    if (got == SRV_AHEAD_WAIT && go_aside(r)) {
        MHD_suspend_connection(r->connection);
        srv_ahead_make(&r->ahead, r->http->options.makers);
        return 0;
    }
    return got == 0 ? MHD_CONTENT_READER_END_OF_STREAM : MHD_CONTENT_READER_END_WITH_ERROR;
}

static void resume_stream(srv_stream *stream)
{
    request *r = (request *)((char *)stream - offsetof(request, stream));
    MHD_resume_connection(r->connection);
}

/* The same for an answer that goes on. Once the stream is aside the request is another's. */
static ssize_t pull_live(void *context, uint64_t position, char *buffer, size_t size)
{
    (void)position;
    request *r = context;
    const api_answer *answer = api_answer_of(r->exchange);
    come_back(r);
    if (r->stream.live == NULL) {
        srv_live_begin(r->http->live, &r->stream, answer->live, answer->idle, resume_stream);
    }
    int64_t got = srv_live_read(&r->stream, buffer, size);
    if (got > 0) {
        r->bytes_out += (uint64_t)got;
        return (ssize_t)got;
    }
    if (got == API_READ_WAIT && go_aside(r)) {
        MHD_suspend_connection(r->connection);
        srv_live_aside(&r->stream);
        return 0;
    }
    return got == 0 ? MHD_CONTENT_READER_END_OF_STREAM : MHD_CONTENT_READER_END_WITH_ERROR;
}

/* The answer as it is to be sent: the exchange's, or what this file found itself. Valid until the
 * request ends. */
static void describe(request *r, srv_wire *wire)
{
    *wire = (srv_wire){.close = r->close};
    if (r->exchange != NULL) {
        const api_answer *answer = api_answer_of(r->exchange);
        srv_wire_answer(wire, answer);
        /* With all of the body read there is nothing left to be mistaken for a request. */
        wire->close = wire->close || (answer->close && !r->whole) || answer->live != NULL;
    } else {
        srv_wire_refusal(wire, r->preflight ? NULL : &r->refusal, r->request_id, &r->text);
    }
    if (r->cors != NULL) {
        srv_wire_cors(wire, r->cors, r->preflight);
    }
    wire->close = wire->close || atomic_load(&r->http->stopping);
}

static bool is_live(const request *r)
{
    return r->exchange != NULL && api_answer_of(r->exchange)->live != NULL;
}

static bool is_streamed(const request *r)
{
    return is_live(r) || (r->exchange != NULL && api_answer_of(r->exchange)->read != NULL);
}

static struct MHD_Response *response_of(request *r, const srv_wire *wire)
{
    struct MHD_Response *response;
    if (is_streamed(r)) {
        bool slow = api_answer_of(r->exchange)->slow;
        response = MHD_create_response_from_callback(wire->length < 0 ? MHD_SIZE_UNKNOWN
                                                                      : (uint64_t)wire->length,
                                                     is_live(r) ? LIVE_BLOCK : ANSWER_BLOCK,
                                                     is_live(r) ? pull_live
                                                     : slow     ? pull_ahead
                                                                : pull,
                                                     r, NULL);
    } else {
        /* The bytes are the exchange's and live until the request has completed. */
        response = MHD_create_response_from_buffer((size_t)wire->length, (void *)wire->bytes,
                                                   MHD_RESPMEM_PERSISTENT);
    }
    if (response == NULL) {
        return NULL;
    }
    bool ok = true;
    for (size_t i = 0; i < wire->header_count && ok; i++) {
        ok = MHD_add_response_header(response, wire->headers[i].name, wire->headers[i].value) ==
             MHD_YES;
    }
    if (ok && wire->close) {
        ok = MHD_add_response_header(response, "Connection", "close") == MHD_YES;
    }
    if (!ok) {
        MHD_destroy_response(response);
        return NULL;
    }
    return response;
}

/* Queue the answer. MHD_NO, which closes the connection, when memory is out. */
static enum MHD_Result send_answer(request *r)
{
    srv_wire wire;
    describe(r, &wire);
    struct MHD_Response *response = response_of(r, &wire);
    if (response == NULL) {
        return MHD_NO;
    }
    r->state = DONE;
    r->status = wire.status;
    srv_connection_enter(r->socket, is_live(r) ? SRV_STAGE_LIVE : SRV_STAGE_ANSWER,
                         srv_clock_micros());
    if (is_live(r)) {
        /* Its silence is no fault; the connection is closed after it. */
        MHD_set_connection_option(r->connection, MHD_CONNECTION_OPTION_TIMEOUT, 0U);
    }
    if (!is_streamed(r) && strcmp(r->method, "HEAD") != 0) {
        r->bytes_out = (uint64_t)wire.length;
    }
    enum MHD_Result queued = MHD_queue_response(r->connection, (unsigned)wire.status, response);
    MHD_destroy_response(response);
    return queued;
}

/* libmicrohttpd takes no response while a body is arriving. So that a client who sends without end
 * learns why it is cut off, the answer is written to the socket as it is; returning MHD_NO then
 * closes it, and the rest of the body is drained. */
static enum MHD_Result cut_off(request *r)
{
    srv_wire wire;
    r->close = true;
    describe(r, &wire);
    if (r->socket != NULL && !is_streamed(r)) {
        r->socket->drain = true;
        if (srv_wire_send(&wire, MHD_get_reason_phrase_for((unsigned)wire.status),
                          r->socket->socket)) {
            r->status = wire.status;
            r->bytes_out = (uint64_t)wire.length;
        }
    }
    r->state = CUT;
    return MHD_NO;
}

static void refuse(request *r, int code, const char *text)
{
    api_free(r->exchange);
    r->exchange = NULL;
    r->refusal = (api_problem){0};
    api_problem_set(&r->refusal, code, "%s", text);
    r->step = API_READY;
}

/* --- waiting --- */

static void resume_held(srv_hold *hold)
{
    request *r = (request *)((char *)hold - offsetof(request, hold));
    MHD_resume_connection(r->connection);
}

static bool begin_wait(request *r, state why)
{
    bool allowed = go_aside(r);
    if (allowed) {
        r->state = why;
        MHD_suspend_connection(r->connection);
    }
    return allowed;
}

/* The worker serves its other connections before it comes back to this one. */
static enum MHD_Result give_way(request *r)
{
    if (!begin_wait(r, r->state)) {
        return MHD_NO;
    }
    MHD_resume_connection(r->connection);
    return MHD_YES;
}

/* D1. Suspended before the hold is known to others: from then on it may be resumed. */
static enum MHD_Result answer_when_durable(request *r)
{
    const api_answer *answer = r->exchange == NULL ? NULL : api_answer_of(r->exchange);
    if (answer == NULL || answer->mesh == NULL ||
        srv_store_is_durable(r->http->options.store, answer->mesh, answer->record)) {
        return send_answer(r);
    }
    r->hold = (srv_hold){.mesh = answer->mesh, .record = answer->record, .resume = resume_held};
    if (!begin_wait(r, HELD)) {
        return MHD_NO;
    }
    if (!srv_held_add(srv_store_held(r->http->options.store), &r->hold)) {
        MHD_resume_connection(r->connection);
    }
    return MHD_YES;
}

static enum MHD_Result answer_held(request *r)
{
    if (r->hold.abandoned) {
        refuse(r, API_NOT_READY, "the server stopped before the change was durable");
        r->close = true;
    }
    return send_answer(r);
}

/* The exchange has become a job: the client is answered by another one. */
static void detach(request *r)
{
    api_exchange *answer = api_detach(r->exchange);
    if (answer == NULL) {
        refuse(r, HE_NO_MEMORY, "no memory for the request");
    } else {
        r->exchange = answer;
    }
}

/* Is anybody left to answer? */
static bool is_awaited(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    const request *r = context;
    return !srv_connection_is_reset(r->socket);
}

static void do_job(void *context)
{
    request *r = context;
    api_watch(r->exchange, is_awaited, r);
    if (api_work(r->exchange) == API_JOB) {
        detach(r);
    }
    MHD_resume_connection(r->connection);
}

static enum MHD_Result begin_work(request *r)
{
    if (!begin_wait(r, WORK)) {
        return MHD_NO;
    }
    if (!srv_jobs_submit(r->http->options.jobs, do_job, r)) {
        refuse(r, API_OVERLOADED, "too many long requests are waiting");
        MHD_resume_connection(r->connection);
    }
    return MHD_YES;
}

/* --- reading --- */

static enum MHD_Result gather_field(void *context, enum MHD_ValueKind kind, const char *name,
                                    size_t name_length, const char *value, size_t value_length)
{
    (void)kind;
    srv_head *head = context;
    if (head->field_count < SRV_MAX_FIELDS) {
        head->fields[head->field_count] =
            (srv_field){name, value == NULL ? "" : value, name_length, value_length};
    }
    head->field_count++;
    head->bytes += name_length + value_length;
    return MHD_YES;
}

static const char *header_value(void *context, const char *name)
{
    request *r = context;
    const char *list = srv_lists_find(&r->lists, name);
    return list != NULL ? list : MHD_lookup_connection_value(r->connection, MHD_HEADER_KIND, name);
}

/* Fills r->refusal, and r->close where the connection is in the way rather than the request. */
static bool admit(request *r, const srv_head *head, const srv_framing *framing)
{
    srv_http *http = r->http;
    uint64_t most = http->options.deadlines.max_connections;
    if (atomic_load(&http->stopping)) {
        r->close = true;
        return api_problem_set(&r->refusal, API_NOT_READY, "the server is stopping");
    }
    if (srv_deadlines_count(http->deadlines) > most) {
        r->close = true;
        return api_problem_set(&r->refusal, API_OVERLOADED,
                               "more than %" PRIu64 " connections are open", most);
    }
    if (!srv_lists_join(&r->lists, head)) {
        return api_problem_set(&r->refusal, HE_NO_MEMORY, "no memory for the request");
    }
    return srv_admit(http->options.policy, head, framing, &r->cors, &r->refusal);
}

static void begin_exchange(request *r, const srv_framing *framing)
{
    api_request asked = {
        .method = r->method,
        .path = r->path,
        .query = framing->query,
        .request_id = r->request_id,
        .header = header_value,
        .context = r,
        .has_length = framing->has_length,
        .length = framing->length,
        .has_body = framing->chunked || framing->length > 0,
    };
    r->exchange = api_begin(r->http->options.service, &asked, &r->step);
    if (r->exchange == NULL) {
        refuse(r, HE_NO_MEMORY, "no memory for the request");
    }
}

/* The answer is known while the body is not here. A small one is let in and forgotten, so that the
 * connection can be used again; a client that asks before it sends hears at once. */
static enum MHD_Result answer_early(request *r, bool expects)
{
    if (r->whole || (!expects && r->announced <= SWALLOW)) {
        return MHD_YES;
    }
    r->close = true;
    if (r->socket != NULL) {
        r->socket->drain = true;
    }
    return answer_when_durable(r);
}

static enum MHD_Result read_head(request *r, const char *method, const char *version)
{
    srv_head head;
    head.method = method;
    head.target = r->target;
    head.version = version;
    head.field_count = 0;
    head.bytes = 0;
    MHD_get_connection_values_n(r->connection, MHD_HEADER_KIND, gather_field, &head);
    memcpy(r->method, method, strnlen(method, SRV_METHOD));
    srv_admit_name(&head, &r->http->ids, r->request_id);
    srv_gate_enter(&r->http->gate);
    r->counted = true;
    r->state = BODY;

    srv_framing framing;
    if (!srv_framing_check(&head, &framing, &r->refusal)) {
        /* Where the body ends is not known, so it cannot be passed over. */
        r->step = API_READY;
        r->announced = UINT64_MAX;
        return answer_early(r, true);
    }
    r->announced = framing.chunked ? UINT64_MAX : framing.length;
    r->whole = r->announced == 0;
    r->path = framing.path;
    char *mark = strchr(r->target, '?');
    if (mark != NULL) {
        *mark = '\0'; /* now the path ends where the query begins */
    }
    bool ok = admit(r, &head, &framing);
    if (ok && r->cors != NULL && strcmp(method, "OPTIONS") == 0 &&
        srv_head_find(&head, "Access-Control-Request-Method") != NULL) {
        r->preflight = true;
        ok = false;
    }
    if (ok) {
        begin_exchange(r, &framing);
    } else {
        r->step = API_READY;
    }
    srv_connection_enter(r->socket, r->whole ? SRV_STAGE_WORK : SRV_STAGE_BODY, srv_clock_micros());
    return r->step == API_MORE ? MHD_YES : answer_early(r, srv_head_find(&head, "Expect") != NULL);
}

/* `size` goes down to what of the bytes is to come again. */
static enum MHD_Result read_body(request *r, const char *bytes, size_t *size)
{
    size_t used = *size;
    if (r->step == API_MORE) {
        r->step = api_body(r->exchange, bytes, *size, &used);
    } else {
        r->swallowed += used;
    }
    *size -= used;
    r->bytes_in += used;
    srv_connection_moved(r->socket, used);
    if (*size > 0) {
        return give_way(r);
    }
    if (r->step != API_READY) {
        return MHD_YES;
    }
    bool much =
        r->announced == UINT64_MAX ? r->swallowed > SWALLOW : r->announced - r->bytes_in > SWALLOW;
    return much ? cut_off(r) : MHD_YES;
}

static enum MHD_Result end_body(request *r)
{
    r->whole = true;
    if (r->step == API_MORE) {
        srv_connection_enter(r->socket, SRV_STAGE_WORK, srv_clock_micros());
        r->step = api_end(r->exchange);
    }
    if (r->step == API_JOB) {
        detach(r);
    }
    return r->step == API_WORK ? begin_work(r) : answer_when_durable(r);
}

static enum MHD_Result handle(void *context, struct MHD_Connection *connection, const char *url,
                              const char *method, const char *version, const char *upload,
                              size_t *upload_size, void **slot)
{
    (void)context;
    (void)connection;
    (void)url;
    request *r = *slot;
    if (r == NULL) {
        return MHD_NO;
    }
    come_back(r);
    switch (r->state) {
    case FRESH:
        return read_head(r, method, version);
    case BODY:
        return *upload_size > 0 ? read_body(r, upload, upload_size) : end_body(r);
    case WORK:
        return answer_when_durable(r);
    case HELD:
        return answer_held(r);
    case DONE:
    case CUT:
        break;
    }
    return r->state == DONE ? MHD_YES : MHD_NO;
}

/* --- the daemon --- */

/* What libmicrohttpd would decode, the router decodes a segment at a time. */
static size_t keep_escapes(void *context, struct MHD_Connection *connection, char *text)
{
    (void)context;
    (void)connection;
    return strlen(text);
}

static void connection_changed(void *context, struct MHD_Connection *connection, void **slot,
                               enum MHD_ConnectionNotificationCode what)
{
    srv_http *http = context;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        int fd = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
        const struct sockaddr *peer =
            MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS)->client_addr;
        *slot = srv_deadlines_add(http->deadlines, fd, peer);
    } else {
        srv_deadlines_remove(http->deadlines, *slot);
        *slot = NULL;
    }
}

/* Nobody beyond even those that are answered 503, and nobody once the server stops. */
static enum MHD_Result accept_policy(void *context, const struct sockaddr *peer, socklen_t length)
{
    (void)peer;
    (void)length;
    const srv_http *http = context;
    bool room = srv_deadlines_count(http->deadlines) < http->options.max_sockets;
    return room && !atomic_load(&http->stopping) ? MHD_YES : MHD_NO;
}

static struct MHD_Daemon *start_daemon(srv_http *http)
{
    const srv_http_options *o = &http->options;
    unsigned flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME;
    if (o->address.socket.any.sa_family == AF_INET6) {
        flags |= MHD_USE_IPv6;
    }
    struct MHD_OptionItem numbers[] = {
        /* Strict, it would refuse a missing Host and a blank in the target with pages of its own,
         * the former with its headers sent twice: srv_framing_check refuses both. */
        {MHD_OPTION_STRICT_FOR_CLIENT, 0, NULL},
        {MHD_OPTION_CONNECTION_MEMORY_LIMIT, POOL_BYTES, NULL},
        /* Divided among the workers, which connections are not: each may hold them all. */
        {MHD_OPTION_CONNECTION_LIMIT, (intptr_t)(o->max_sockets * o->workers), NULL},
        {MHD_OPTION_CONNECTION_TIMEOUT, (intptr_t)o->deadlines.idle + 1, NULL},
        {MHD_OPTION_LISTEN_BACKLOG_SIZE, BACKLOG, NULL},
        /* A pool of one is not a pool. */
        {o->workers > 1 ? MHD_OPTION_THREAD_POOL_SIZE : MHD_OPTION_END, (intptr_t)o->workers, NULL},
        {MHD_OPTION_END, 0, NULL},
    };
    return MHD_start_daemon(flags, 0, accept_policy, http, handle, http, MHD_OPTION_ARRAY, numbers,
                            MHD_OPTION_SOCK_ADDR, &o->address.socket.any,
                            MHD_OPTION_UNESCAPE_CALLBACK, keep_escapes, NULL,
                            MHD_OPTION_URI_LOG_CALLBACK, request_begin, http,
                            MHD_OPTION_NOTIFY_COMPLETED, request_completed, NULL,
                            MHD_OPTION_NOTIFY_CONNECTION, connection_changed, http, MHD_OPTION_END);
}

static void http_free(srv_http *http)
{
    srv_live_free(http->live);
    srv_deadlines_free(http->deadlines);
    srv_gate_clear(&http->gate);
    he_mem_free(http);
}

srv_http *srv_http_start(const srv_http_options *options, char *message, size_t size)
{
    srv_http *http = he_mem_zero(1, sizeof *http);
    if (http == NULL) {
        snprintf(message, size, "no memory to start");
        return NULL;
    }
    http->options = *options;
    srv_gate_init(&http->gate);
    srv_ids_init(&http->ids);
    http->deadlines = srv_deadlines_new(&options->deadlines);
    http->live = srv_live_new(options->heartbeat_micros);
    if (http->deadlines == NULL || http->live == NULL) {
        snprintf(message, size, "no memory or threads to start");
        http_free(http);
        return NULL;
    }
    errno = 0;
    http->daemon = start_daemon(http);
    if (http->daemon == NULL) {
        char text[SRV_ADDRESS_TEXT];
        srv_address_format(&options->address.socket.any, true, text);
        snprintf(message, size, "cannot listen on %s: %s", text,
                 errno == 0 ? "the server could not be started" : strerror(errno));
        http_free(http);
        return NULL;
    }
    http->port = MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_BIND_PORT)->port;
    return http;
}

unsigned srv_http_port(const srv_http *http)
{
    return http->port;
}

bool srv_http_stop(srv_http *http, unsigned millis)
{
    if (http == NULL) {
        return true;
    }
    /* From here on accept_policy lets nobody in. MHD_quiesce_daemon is not called for that: it
     * takes the listening socket out of the workers' epoll sets while they may do so themselves,
     * and the library aborts where both try. */
    atomic_store(&http->stopping, true);
    srv_held_abandon(srv_store_held(http->options.store));
    srv_live_stop(http->live);
    /* At the deadline only those that are suspended still count. */
    if (!srv_gate_close(&http->gate, millis)) {
        return false;
    }
    MHD_stop_daemon(http->daemon);
    http_free(http);
    return true;
}
