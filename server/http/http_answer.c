#include "server/http/http_answer.h"

#include "server/http/http_buffer.h"
#include "server/http/http_recv.h"
#include "server/http/http_request.h"
#include "server/http/http_wire.h"
#include "server/http/limits.h"
#include "system/clock.h"
#include "system/memory.h"

#include <string.h>
#include <sys/socket.h>

enum {
    /* The size of the buffer that libmicrohttpd allocates for an answer sent piece by piece. */
    ANSWER_BLOCK = 64 * 1024,
    /* The size of that buffer for a stream of events to an HTTP/1.0 client; it is small, because
     * there may be thousands of streams. */
    LIVE_BLOCK = 1024
};

/* --- answers sent piece by piece --- */

/* Converts `got`, the result of reading an answer, to what libmicrohttpd expects: a number of
 * bytes, or its code for the end or for a failure. An end before the announced length is a
 * failure. */
static ssize_t pulled(srv_request *r, int64_t got)
{
    int64_t length = api_answer_of(r->exchange)->length;
    if (got == 0 && length >= 0 && r->bytes_out != (uint64_t)length) {
        return MHD_CONTENT_READER_END_WITH_ERROR;
    }
    if (got > 0) {
        r->bytes_out += (uint64_t)got;
        api_charge(r->exchange, (uint64_t)got);
        return (ssize_t)got;
    }
    return got == 0 ? MHD_CONTENT_READER_END_OF_STREAM : MHD_CONTENT_READER_END_WITH_ERROR;
}

static void widen(srv_request *r)
{
    const int most = SRV_SEND_BUFFER;
    if (r->socket != NULL && !r->socket->widened) {
        r->socket->widened =
            setsockopt(r->socket->socket, SOL_SOCKET, SO_SNDBUF, &most, sizeof most) == 0;
    }
}

/* Enlarges the send buffer of the socket as soon as it is known that the client reads, that is,
 * when more bytes of the answer were sent than the small buffers can hold. */
static void widen_after(srv_request *r, uint64_t position)
{
    if (position >= SRV_SEND_BUFFER) {
        widen(r);
    }
}

static ssize_t pull(void *context, uint64_t position, char *buffer, size_t size)
{
    srv_request *r = context;
    widen_after(r, position);
    const api_answer *answer = api_answer_of(r->exchange);
    srv_timing_enter(&r->timing, SRV_PART_WORK);
    const int64_t got = answer->read(answer->context, buffer, size);
    srv_timing_enter(&r->timing, SRV_PART_SEND);
    return pulled(r, got);
}

static void resume_producer(srv_producer *producer)
{
    srv_request *r = (srv_request *)((char *)producer - offsetof(srv_request, producer));
    MHD_resume_connection(r->connection);
}

/* Makes a piece of an answer. Called by a thread of http_producer.h while the request is
 * suspended. */
static int64_t read_ahead(void *context, char *buffer, size_t size)
{
    srv_request *r = context;
    const api_answer *answer = api_answer_of(r->exchange);
    srv_timing_enter(&r->timing, SRV_PART_WORK);
    const int64_t got = answer->read(answer->context, buffer, size);
    srv_timing_enter(&r->timing, SRV_PART_QUEUE);
    return got;
}

/* Passes the pieces of an answer that other threads make (http_producer.h) to libmicrohttpd. */
static ssize_t pull_producer(void *context, uint64_t position, char *buffer, size_t size)
{
    srv_request *r = context;
    widen_after(r, position);
    srv_request_resumed(r);
    r->producer.read = read_ahead;
    r->producer.context = r;
    r->producer.resume = resume_producer;
    int64_t got = srv_producer_take(&r->producer, buffer, size);
    if (got == SRV_PRODUCER_WAIT && srv_request_suspend(r)) {
        srv_timing_enter(&r->timing, SRV_PART_QUEUE);
        srv_producer_make(&r->producer, r->http->options.makers);
        return 0;
    }
    srv_timing_enter(&r->timing, SRV_PART_SEND);
    return pulled(r, got);
}

static void resume_stream(srv_stream *stream)
{
    srv_request *r = (srv_request *)((char *)stream - offsetof(srv_request, stream));
    MHD_resume_connection(r->connection);
}

/* Reads from a stream of events for libmicrohttpd. If there is nothing to send, suspends the
 * request, which the thread of http_stream.h owns from then on. */
static ssize_t pull_live(void *context, uint64_t position, char *buffer, size_t size)
{
    (void)position;
    srv_request *r = context;
    const api_answer *answer = api_answer_of(r->exchange);
    srv_request_resumed(r);
    if (r->stream.streams == NULL) {
        int socket =
            MHD_get_connection_info(r->connection, MHD_CONNECTION_INFO_CONNECTION_FD)->connect_fd;
        srv_stream_begin(r->http->streams, &r->stream, answer->live, socket, resume_stream);
    }
    int64_t got = srv_stream_read(&r->stream, buffer, size);
    if (got == API_READ_WAIT && srv_request_suspend(r)) {
        /* While the stream waits, the request needs only that part of its buffer in which the
         * headers are. */
        srv_buffer_rest(r->socket == NULL ? SRV_NO_BUFFER : r->socket->buffer, st_clock_micros());
        srv_stream_aside(&r->stream);
        return 0;
    }
    return pulled(r, got);
}

/* --- the answer --- */

void srv_answer_refuse(srv_request *r, int code, const char *text)
{
    if (r->exchange != NULL) {
        api_rate_fields_of(r->exchange, &r->rate_fields);
    }
    api_free(r->exchange);
    r->exchange = NULL;
    r->refusal = (api_problem){0};
    api_problem_set(&r->refusal, code, "%s", text);
    r->step = API_READY;
}

/* Fills `wire` with the answer of a request: that of its exchange, or the refusal if the request
 * has no exchange. `wire` is valid until the request ends. */
static void describe(srv_request *r, srv_wire *wire)
{
    *wire = (srv_wire){.close = r->close};
    if (r->exchange != NULL) {
        const api_answer *answer = api_answer_of(r->exchange);
        srv_wire_answer(wire, answer);
        /* The connection may stay open if the whole body of the request was read, because then no
         * rest of the body can be mistaken for the next request. */
        wire->close = wire->close || (answer->close && !r->whole) || answer->live != NULL;
    } else {
        srv_wire_refusal(wire, r->preflight ? NULL : &r->refusal, r->request_id, &r->text);
        if (r->rate_fields.policy[0] != '\0') {
            srv_wire_add(wire, "RateLimit-Policy", r->rate_fields.policy);
            srv_wire_add(wire, "RateLimit", r->rate_fields.left);
        }
    }
    if (r->client.told_name) {
        srv_wire_add(wire, "Strict-Transport-Security", "max-age=31536000");
    }
    if (r->trace.answered[0] != '\0') {
        srv_wire_add(wire, "traceparent", r->trace.answered);
    }
    if (r->client.cors != NULL) {
        srv_wire_cors(wire, r->client.cors, r->preflight);
    }
    wire->close = wire->close || atomic_load(&r->http->stopping) || srv_recv_has_ended(r->socket);
}

static bool is_live(const srv_request *r)
{
    return r->exchange != NULL && api_answer_of(r->exchange)->live != NULL;
}

static bool is_streamed(const srv_request *r)
{
    return is_live(r) || (r->exchange != NULL && api_answer_of(r->exchange)->read != NULL);
}

/* Decides whether other threads make the pieces of an answer. Making a piece takes up to a
 * millisecond. If there are only a few downloads, the worker thread makes the pieces itself, which
 * is faster than passing them through the pool; a thousand downloads would keep it from other work
 * for a second. */
static bool is_made_ahead(srv_request *r)
{
    size_t others = atomic_fetch_add(&r->http->downloads, 1);
    r->block = ANSWER_BLOCK;
    st_memory_count(ANSWER_BLOCK);
    return api_answer_of(r->exchange)->slow || others >= r->http->options.workers;
}

static struct MHD_Response *response_of(srv_request *r, const srv_wire *wire)
{
    struct MHD_Response *response;
    if (is_streamed(r)) {
        response = MHD_create_response_from_callback(wire->length < 0 ? MHD_SIZE_UNKNOWN
                                                                      : (uint64_t)wire->length,
                                                     is_live(r) ? LIVE_BLOCK : ANSWER_BLOCK,
                                                     is_live(r)         ? pull_live
                                                     : is_made_ahead(r) ? pull_producer
                                                                        : pull,
                                                     r, NULL);
    } else {
        /* The exchange owns the bytes, and frees them after the request has completed. */
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

bool srv_answer_send(srv_request *r)
{
    srv_wire wire;
    describe(r, &wire);
    struct MHD_Response *response = response_of(r, &wire);
    if (response == NULL) {
        return false;
    }
    r->state = SRV_DONE;
    r->status = wire.status;
    srv_connection_enter(r->socket, is_live(r) ? SRV_STAGE_LIVE : SRV_STAGE_ANSWER,
                         st_clock_micros());
    if (is_live(r)) {
        /* A stream may send nothing for any time, so libmicrohttpd's timeout is switched off for
         * this connection, which is closed after the stream. */
        MHD_set_connection_option(r->connection, MHD_CONNECTION_OPTION_TIMEOUT, 0U);
    }
    if (is_live(r) || (!is_streamed(r) && wire.length > SRV_FIRST_SEND_BUFFER)) {
        /* A small send buffer would save no memory, because the whole answer is in memory. */
        widen(r);
    }
    if (!is_streamed(r) && strcmp(r->method, "HEAD") != 0) {
        r->bytes_out = (uint64_t)wire.length;
        if (r->exchange != NULL) {
            api_charge(r->exchange, r->bytes_out);
        }
    }
    srv_timing_enter(&r->timing, SRV_PART_SEND);
    enum MHD_Result queued = MHD_queue_response(r->connection, (unsigned)wire.status, response);
    MHD_destroy_response(response);
    return queued == MHD_YES;
}

/* Answers while the body is still arriving. libmicrohttpd accepts no response then, so the answer
 * is written directly to the socket; a client that sends without end learns in this way why it is
 * cut off. When the connection is closed, the rest of the body is drained. */
void srv_answer_cut_off(srv_request *r)
{
    srv_wire wire;
    r->close = true;
    describe(r, &wire);
    if (r->socket != NULL && !is_streamed(r)) {
        r->socket->drain = true;
        if (srv_wire_send(&wire, MHD_get_reason_phrase_for((unsigned)wire.status), r->socket)) {
            r->status = wire.status;
            r->bytes_out = (uint64_t)wire.length;
        }
    }
    r->state = SRV_CUT;
}
