#include "server/http/http_handle.h"

#include "api/limits.h"
#include "server/http/http_answer.h"
#include "server/http/http_headers.h"
#include "server/http/http_request.h"
#include "system/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum {
    /* Most bytes of a refused body that are skipped; if more are to come, the connection is
     * closed. */
    SWALLOW = 256 * 1024,
    /* Microseconds that a worker thread, which serves many connections, spends on a request that
     * only reads. The request then moves to the thread pool. */
    WORKER_MICROS = 20000
};

/* All functions of this file that return bool return false to close the connection, unless their
 * comment says otherwise. */

/* --- waiting --- */

static void resume_held(st_wait *hold)
{
    srv_request *r = (srv_request *)((char *)hold - offsetof(srv_request, hold));
    MHD_resume_connection(r->connection);
}

static bool begin_wait(srv_request *r, srv_state why)
{
    bool allowed = srv_request_suspend(r);
    if (allowed) {
        r->state = why;
    }
    return allowed;
}

/* Suspends and resumes the connection, so that the worker thread serves its other connections
 * before it returns to this one. */
static bool give_way(srv_request *r)
{
    srv_timing_enter(&r->timing, SRV_PART_QUEUE);
    if (!begin_wait(r, r->state)) {
        return false;
    }
    MHD_resume_connection(r->connection);
    return true;
}

/* Sends the answer, or waits first until the changes that it shows are durable (rule D1). The
 * connection is suspended before the wait is registered, because after that another thread may
 * resume the request at once. */
static bool answer_when_durable(srv_request *r)
{
    const api_answer *answer = r->exchange == NULL ? NULL : api_answer_of(r->exchange);
    st_waits *waits = st_store_waits(r->http->options.store);
    if (answer == NULL || st_waits_is_durable(waits, &answer->shown)) {
        return srv_answer_send(r);
    }
    srv_timing_enter(&r->timing, SRV_PART_STORE);
    r->hold = (st_wait){.shown = answer->shown, .resume = resume_held};
    if (!begin_wait(r, SRV_HELD)) {
        return false;
    }
    if (!st_waits_add(waits, &r->hold)) {
        MHD_resume_connection(r->connection);
    }
    return true;
}

static bool answer_held(srv_request *r)
{
    srv_timing_enter(&r->timing, SRV_PART_WORK);
    if (r->hold.end != ST_WAIT_DURABLE) {
        api_problem problem = {0};
        api_problem_set_lost(&problem, &r->hold, api_answer_of(r->exchange)->changed);
        srv_answer_refuse(r, problem.code, problem.detail);
        r->close = r->close || r->hold.end == ST_WAIT_STOPPED;
    }
    return srv_answer_send(r);
}

/* Turns the exchange into a job (a long request that runs on without the client), and answers the
 * client by another exchange. */
static void detach(srv_request *r)
{
    api_exchange *answer = api_detach(r->exchange);
    if (answer == NULL) {
        srv_answer_refuse(r, HE_NO_MEMORY, "no memory for the request");
    } else {
        r->exchange = answer;
    }
}

/* Returns true if the worker thread may continue a request that only reads, and false if it has
 * spent WORKER_MICROS on it, because the worker's other connections are waiting. */
static bool is_short(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    const srv_request *r = context;
    return st_clock_micros() < r->work_until;
}

/* Returns true if the work on a request must continue, because the client still waits for the
 * answer, and the request has not used up its time. */
static bool is_awaited(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    const srv_request *r = context;
    uint64_t now = st_clock_micros();
    if (now >= r->work_until) {
        char text[128];
        snprintf(text, sizeof text, "the answer was not ready within %" PRIu64 " seconds%s",
                 r->http->options.read_seconds,
                 api_can_be_job(r->exchange)
                     ? "; a job has more time: send the header Prefer: respond-async"
                     : "");
        api_give_up(r->exchange, API_READ_TIMEOUT, text);
        return false;
    }
    return !srv_connection_is_left(r->socket, now);
}

static void do_work(void *context)
{
    srv_request *r = context;
    srv_timing_enter(&r->timing, SRV_PART_WORK);
    if (r->work_until != UINT64_MAX) {
        r->work_until = st_clock_micros() + r->http->options.read_seconds * 1000000;
    }
    api_set_progress(r->exchange, is_awaited, r);
    if (api_work(r->exchange) == API_JOB) {
        detach(r);
    }
    /* The request now waits until a worker thread continues with it. */
    srv_timing_enter(&r->timing, SRV_PART_QUEUE);
    MHD_resume_connection(r->connection);
}

static bool begin_work(srv_request *r)
{
    srv_timing_enter(&r->timing, SRV_PART_QUEUE);
    if (!begin_wait(r, SRV_WORK)) {
        return false;
    }
    const api_load load = api_load_of(r->exchange);
    const bool is_long = load.reads || load.seconds > API_PATIENCE;
    const st_task task = {.work = do_work,
                          .context = r,
                          .share = is_long ? ST_SHARE_LONG : ST_SHARE_BRIEF,
                          .cost = load.seconds,
                          .flow = st_pool_flow(srv_request_client(r), load.mesh)};
    r->work_until = load.reads ? 0 : UINT64_MAX;
    if (!st_pool_submit(r->http->options.pool, &task)) {
        srv_answer_refuse(r, API_OVERLOADED, "too many long requests are waiting");
        MHD_resume_connection(r->connection);
    }
    return true;
}

/* --- reading --- */

/* Returns true if the request is malformed (http_syntax.h), and fills `problem`, which may be NULL.
 * In that case libmicrohttpd has parsed an end of the request that the client did not send (rule S3
 * of http_syntax.h). */
static bool is_faulty(const srv_request *r, api_problem *problem)
{
    return r->socket != NULL && srv_syntax_fault(&r->socket->syntax, r->number, problem);
}

static enum MHD_Result gather_field(void *context, enum MHD_ValueKind kind, const char *name,
                                    size_t name_length, const char *value, size_t value_length)
{
    (void)kind;
    srv_head *head = context;
    if (head->field_count == SRV_MAX_FIELDS) {
        return MHD_NO;
    }
    head->fields[head->field_count++] =
        (srv_field){name, value == NULL ? "" : value, name_length, value_length};
    return MHD_YES;
}

/* Finds the address of the client, in the headers if the connection comes from a trusted proxy.
 * Returns false with r->refusal filled if those headers are invalid. */
static bool find_client(srv_request *r, const srv_head *head)
{
    snprintf(r->client.address, sizeof r->client.address, "%s",
             r->socket == NULL ? "-" : r->socket->peer);
    if (r->socket != NULL && r->socket->session != NULL) {
        r->client.scheme = SRV_SCHEME_HTTPS;
    }
    return r->socket == NULL || !r->socket->is_proxy ||
           srv_admit_proxied(r->http->options.policy, head, &r->client, &r->refusal);
}

static api_metrics *metrics_of(const srv_request *r)
{
    return api_metrics_of(r->http->options.service);
}

/* Checks whether the request may run. Returns false with r->refusal filled if it may not, and with
 * r->close set if the connection shall be closed after the answer. */
static bool admit(srv_request *r, const srv_head *head, const srv_framing *framing)
{
    srv_http *http = r->http;
    uint64_t most = http->options.deadlines.max_connections;
    if (atomic_load(&http->stopping)) {
        r->close = true;
        api_count(metrics_of(r), API_COUNT_REFUSED_STOPPING);
        return api_problem_set(&r->refusal, API_NOT_READY, "the server is stopping");
    }
    if (srv_deadlines_count(http->deadlines) > most) {
        r->close = true;
        api_count(metrics_of(r), API_COUNT_REFUSED_LIMIT);
        return api_problem_set(&r->refusal, API_OVERLOADED,
                               "more than %" PRIu64 " connections are open", most);
    }
    return srv_admit(http->options.policy, head, framing, &r->client, &r->refusal);
}

/* Begins the exchange of a request. The exchange borrows the values of the headers: from
 * libmicrohttpd, which keeps them until the request has completed, or from r->joined, which has the
 * headers that were joined from several lines. By then the exchange has been freed, or has become a
 * job with copies of the values. */
static void begin_exchange(srv_request *r, const srv_head *head, const srv_framing *framing)
{
    api_request asked = {
        .method = r->method,
        .path = r->path,
        .query = framing->query,
        .request_id = r->request_id,
        .has_length = framing->has_length,
        .length = framing->length,
        .has_body = framing->chunked || framing->length > 0,
        .has_consent = r->client.cors != NULL,
    };
    if (r->socket != NULL) {
        asked.client =
            r->socket->is_proxy ? srv_address_key(srv_request_client(r)) : r->socket->client;
        asked.is_beyond = atomic_load_explicit(&r->socket->beyond, memory_order_relaxed);
        r->close = r->close || asked.is_beyond;
    }
    if (srv_headers_read(head, asked.headers, &r->joined)) {
        r->exchange = api_begin(r->http->options.service, &asked, &r->step);
    }
    if (r->exchange == NULL) {
        srv_answer_refuse(r, HE_NO_MEMORY, "no memory for the request");
    }
}

/* Called when the answer of a request is known before its body has arrived. If the body is small,
 * it is read and discarded first, so that the connection can be used again. Otherwise, or if the
 * client waits for 100 Continue (`expects`), the answer is sent at once and the connection is
 * closed. */
static bool answer_early(srv_request *r, bool expects)
{
    if (r->whole || (!expects && r->announced <= SWALLOW)) {
        return true;
    }
    r->close = true;
    if (r->socket != NULL) {
        r->socket->drain = true;
    }
    return answer_when_durable(r);
}

static void read_trace(srv_request *r, const srv_head *head)
{
    static const char name[] = "traceparent";
    const srv_field *first = srv_head_find(head, name);
    size_t count = first == NULL ? 0 : 1;
    for (size_t i = first == NULL ? head->field_count : (size_t)(first - head->fields) + 1;
         i < head->field_count; i++) {
        const srv_field *field = &head->fields[i];
        count += field->name_length == sizeof name - 1 &&
                 strncasecmp(field->name, name, sizeof name - 1) == 0;
    }
    srv_trace_read(&r->http->spans, first == NULL ? NULL : first->value, count, &r->trace);
}

static bool read_head(srv_request *r, const char *method, const char *version)
{
    srv_head head;
    head.method = method;
    head.target = r->target;
    head.version = version;
    head.field_count = 0;
    MHD_get_connection_values_n(r->connection, MHD_HEADER_KIND, gather_field, &head);
    memcpy(r->method, method, strnlen(method, SRV_METHOD));
    srv_admit_name(&head, &r->http->ids, r->request_id);
    read_trace(r, &head);
    srv_inflight_enter(&r->http->inflight);
    api_count(metrics_of(r), API_COUNT_BEGUN);
    r->counted = true;
    r->state = SRV_BODY;

    srv_framing framing;
    bool known = find_client(r, &head);
    if (is_faulty(r, &r->refusal) ||
        !srv_framing_read(&head, r->client.scheme == SRV_SCHEME_HTTPS, &framing, &r->refusal)) {
        /* The end of the body is unknown, so the body cannot be skipped. */
        r->step = API_READY;
        r->announced = UINT64_MAX;
        return answer_early(r, true);
    }
    r->announced = framing.chunked ? UINT64_MAX : framing.length;
    r->whole = r->announced == 0;
    r->path = framing.path;
    char *mark = strchr(r->target, '?');
    if (mark != NULL) {
        *mark = '\0'; /* the NUL ends the path where the query begins */
    }
    bool ok = known && admit(r, &head, &framing);
    if (ok && r->client.cors != NULL && strcmp(method, "OPTIONS") == 0 &&
        srv_head_find(&head, "Access-Control-Request-Method") != NULL) {
        r->preflight = true;
        ok = false;
    }
    if (ok) {
        begin_exchange(r, &head, &framing);
    } else {
        r->step = API_READY;
    }
    srv_connection_enter(r->socket, r->whole ? SRV_STAGE_WORK : SRV_STAGE_BODY, st_clock_micros());
    return r->step == API_MORE || answer_early(r, srv_head_find(&head, "Expect") != NULL);
}

/* Counts bytes of the body for the client's limit of bytes a second, also if they are skipped. */
static void charge(const srv_request *r, uint64_t bytes)
{
    if (r->exchange != NULL) {
        api_charge(r->exchange, bytes);
    }
}

static void refuse_fault(srv_request *r)
{
    api_problem problem = {0};
    (void)is_faulty(r, &problem);
    srv_answer_refuse(r, problem.code, problem.detail);
    r->close = true;
    r->socket->drain = true;
}

/* Passes a piece of the body to the exchange, or skips it if the answer is known already. Sets
 * *size to the number of bytes at the end of the piece that libmicrohttpd must pass again. */
static bool read_body(srv_request *r, const char *bytes, size_t *size)
{
    if (is_faulty(r, NULL)) {
        refuse_fault(r);
        srv_answer_cut_off(r);
        return false;
    }
    size_t used = *size;
    if (r->step == API_MORE) {
        r->step = api_body(r->exchange, bytes, *size, &used);
    } else {
        r->swallowed += used;
        charge(r, used);
    }
    *size -= used;
    r->bytes_in += used;
    srv_connection_moved(r->socket, used);
    if (*size > 0) {
        return give_way(r);
    }
    if (r->step != API_READY) {
        return true;
    }
    bool much =
        r->announced == UINT64_MAX ? r->swallowed > SWALLOW : r->announced - r->bytes_in > SWALLOW;
    if (much) {
        srv_answer_cut_off(r);
    }
    return !much;
}

static bool end_body(srv_request *r)
{
    r->whole = true;
    if (is_faulty(r, NULL)) {
        refuse_fault(r);
    }
    if (r->step == API_MORE) {
        uint64_t now = st_clock_micros();
        srv_connection_enter(r->socket, SRV_STAGE_WORK, now);
        r->work_until = now + WORKER_MICROS;
        api_set_worker_progress(r->exchange, is_short, r);
        r->step = api_end(r->exchange);
    }
    if (r->step == API_JOB) {
        detach(r);
    }
    return r->step == API_WORK ? begin_work(r) : answer_when_durable(r);
}

bool srv_request_handle(srv_request *r, const char *method, const char *version, const char *upload,
                        size_t *size)
{
    bool goes_on = false;
    srv_request_resumed(r);
    switch (r->state) {
    case SRV_FRESH:
        srv_timing_enter(&r->timing, SRV_PART_WORK);
        goes_on = read_head(r, method, version);
        break;
    case SRV_BODY:
        srv_timing_enter(&r->timing, SRV_PART_WORK);
        goes_on = *size > 0 ? read_body(r, upload, size) : end_body(r);
        break;
    case SRV_WORK:
        srv_timing_enter(&r->timing, SRV_PART_WORK);
        return answer_when_durable(r);
    case SRV_HELD:
        return answer_held(r);
    case SRV_DONE:
        return true;
    case SRV_CUT:
        return false;
    }
    if (r->state == SRV_BODY && !r->aside) {
        srv_timing_enter(&r->timing, SRV_PART_RECEIVE);
    }
    return goes_on;
}
