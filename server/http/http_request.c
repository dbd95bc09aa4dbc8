#include "server/http/http_request.h"

#include "api/limits.h"
#include "base/mem.h"
#include "server/http/http_buffer.h"
#include "system/clock.h"
#include "system/memory.h"

#include <string.h>

static srv_connection *socket_of(struct MHD_Connection *connection)
{
    const union MHD_ConnectionInfo *info =
        MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    return info == NULL ? NULL : info->socket_context;
}

srv_request *srv_request_begin(srv_http *http, const char *uri, struct MHD_Connection *connection)
{
    srv_connection *socket = socket_of(connection);
    /* Every request is counted here, because http_syntax.h also counts every request (rule S4). If
     * a request is counted here but not there, its bytes were not checked. */
    if (socket == NULL || !srv_syntax_has_begun(&socket->syntax, ++socket->requests)) {
        return NULL;
    }
    size_t length = strnlen(uri, API_MAX_URI + 1);
    const bool fits = sizeof(srv_request) + length + 1 <= SRV_REQUEST_BLOCK;
    srv_request *r = fits ? st_spares_take(&http->requests, SRV_REQUEST_BLOCK)
                          : he_mem_alloc(sizeof *r + length + 1);
    if (r == NULL) {
        return NULL;
    }
    memset(r, 0, sizeof *r);
    memcpy(r->target, uri, length);
    r->target[length] = '\0';
    r->is_spare = fits;
    r->http = http;
    r->connection = connection;
    r->socket = socket;
    r->number = socket->requests;
    r->started = st_clock_micros();
    if (http->options.log != NULL && srv_log_get(http->options.log).slow_us > 0) {
        srv_timing_begin(&r->timing, r->started);
    }
    srv_buffer_use(r->socket == NULL ? SRV_NO_BUFFER : r->socket->buffer);
    return r;
}

static void copy_text(char *out, size_t size, const char *text)
{
    size_t length = strnlen(text, size - 1);
    memcpy(out, text, length);
    out[length] = '\0';
}

/* Returns true if a request took long enough to be logged as slow. A stream of events is never
 * slow, because it lasts as long as its client listens. */
static bool is_slow(const srv_request *r, uint64_t took)
{
    const uint64_t slow_us = srv_log_get(r->http->options.log).slow_us;
    const bool live = r->exchange != NULL && api_answer_of(r->exchange)->live != NULL;
    return r->timing.on && slow_us > 0 && took > slow_us && !live;
}

static void tell_log(srv_request *r, uint64_t now)
{
    srv_log *log = r->http->options.log;
    const bool slow = is_slow(r, now - r->started);
    srv_access access; /* not zeroed, which would take time: all its members are set below */
    if (!slow && !srv_log_get(log).requests) {
        return;
    }
    srv_timing_end(&r->timing, now);
    access.time = st_clock_utc();
    access.route = r->exchange == NULL ? NULL : api_answer_of(r->exchange)->route;
    access.status = r->status;
    access.bytes_in = r->bytes_in;
    access.bytes_out = r->bytes_out;
    access.duration_us = now - r->started;
    memcpy(access.parts, r->timing.parts, sizeof access.parts);
    copy_text(access.request_id, sizeof access.request_id, r->request_id);
    copy_text(access.method, sizeof access.method, r->method);
    copy_text(access.path, sizeof access.path, r->path == NULL ? r->target : r->path);
    copy_text(access.peer, sizeof access.peer, srv_request_client(r));
    memcpy(access.trace_id, r->trace.trace_id, sizeof access.trace_id);
    memcpy(access.parent_id, r->trace.parent_id, sizeof access.parent_id);
    memcpy(access.span_id, r->trace.span_id, sizeof access.span_id);
    srv_log_request(log, &access, slow);
}

static void count(const srv_request *r, uint64_t now)
{
    const api_service *service = r->http->options.service;
    api_served served = {.method = r->method,
                         .status = r->status,
                         .code = r->refusal.code,
                         .bytes_in = r->bytes_in,
                         .bytes_out = r->bytes_out,
                         .micros = now - r->started};
    api_served_as(service, r->exchange, &served);
    api_count_request(api_metrics_of(service), &served);
}

bool srv_request_suspend(srv_request *r)
{
    r->aside = srv_inflight_wait(&r->http->inflight);
    if (r->aside) {
        MHD_suspend_connection(r->connection);
    }
    return r->aside;
}

void srv_request_resumed(srv_request *r)
{
    if (r->aside) {
        r->aside = false;
        srv_inflight_resume(&r->http->inflight);
    }
}

void srv_request_end(srv_request *r)
{
    srv_http *http = r->http;
    uint64_t now = st_clock_micros();
    /* The client may have begun the next request: its first bytes may be in libmicrohttpd's buffer
     * already. */
    bool begun = r->socket != NULL && r->socket->syntax.requests > r->socket->requests;
    srv_connection_enter(r->socket, begun ? SRV_STAGE_HEAD : SRV_STAGE_IDLE, now);
    srv_buffer_rest(r->socket == NULL ? SRV_NO_BUFFER : r->socket->buffer, now);
    if (r->counted) {
        count(r, now);
    }
    if (r->counted && http->options.log != NULL) {
        tell_log(r, now);
    }
    bool counted = r->counted;
    /* If a connection ended while it was suspended, it still counts as suspended here. */
    srv_request_resumed(r);
    if (r->block > 0) {
        atomic_fetch_sub(&http->downloads, 1);
        st_memory_count(-(int64_t)r->block);
    }
    srv_stream_end(&r->stream);
    srv_producer_clear(&r->producer);
    api_free(r->exchange);
    he_mem_free(r->joined);
    api_text_clear(&r->text);
    if (r->is_spare) {
        st_spares_put(&http->requests, r);
    } else {
        he_mem_free(r);
    }
    if (counted) {
        srv_inflight_leave(&http->inflight);
    }
}
