#include "server/http/http_wire.h"

#include "api/request/answer_headers.h"
#include "server/http/http_recv.h"

#include <assert.h>
#include <string.h>

void srv_wire_add(srv_wire *wire, const char *name, const char *value)
{
    assert(api_header_is_listed(name));
    if (wire->header_count < SRV_WIRE_HEADERS) {
        wire->headers[wire->header_count++] = (api_header){name, value};
    }
}

void srv_wire_answer(srv_wire *wire, const api_answer *answer)
{
    wire->status = answer->status;
    for (size_t i = 0; i < answer->header_count; i++) {
        srv_wire_add(wire, answer->headers[i].name, answer->headers[i].value);
    }
    wire->bytes = answer->bytes;
    wire->length = answer->length;
}

void srv_wire_refusal(srv_wire *wire, const api_problem *problem, const char *request_id,
                      api_text *text)
{
    wire->bytes = "";
    wire->length = 0;
    wire->status = 204;
    if (problem != NULL) {
        api_text_empty(text);
        api_problem_write(problem, request_id, text);
        wire->status = text->failed ? 507 : api_problem_http(problem);
        wire->bytes = text->failed ? api_problem_unwritten() : text->bytes;
        wire->length = text->failed ? (int64_t)strlen(wire->bytes) : (int64_t)text->length;
        srv_wire_add(wire, "Content-Type", "application/problem+json");
        srv_wire_add(wire, "X-Content-Type-Options", "nosniff");
    }
    srv_wire_add(wire, "Cache-Control", "no-store");
    srv_wire_add(wire, "X-Request-Id", request_id);
    const char *retry = problem == NULL ? NULL : api_problem_retry(problem, wire->retry);
    if (retry != NULL) {
        srv_wire_add(wire, "Retry-After", retry);
    }
}

void srv_wire_cors(srv_wire *wire, const char *origin, bool preflight)
{
    srv_wire_add(wire, "Access-Control-Allow-Origin", origin);
    srv_wire_add(wire, "Vary", "Origin");
    if (preflight) {
        srv_wire_add(wire, "Access-Control-Allow-Methods", "GET, HEAD, POST, PUT, PATCH, DELETE");
        srv_wire_add(
            wire, "Access-Control-Allow-Headers",
            "Accept, Authorization, Content-Encoding, Content-Type, Idempotency-Key, If-Match, "
            "If-None-Match, Last-Event-ID, Prefer, traceparent, X-Request-Id");
        srv_wire_add(wire, "Access-Control-Max-Age", "600");
    } else {
        srv_wire_add(wire, "Access-Control-Expose-Headers", api_exposed_headers);
    }
}

bool srv_wire_send(const srv_wire *wire, const char *reason, srv_connection *connection)
{
    api_text text = {.maximum = (size_t)64 << 10};
    api_text_add_format(&text, "HTTP/1.1 %d %s\r\nConnection: close\r\nContent-Length: %lld\r\n",
                        wire->status, reason, (long long)wire->length);
    for (size_t i = 0; i < wire->header_count; i++) {
        api_text_add_format(&text, "%s: %s\r\n", wire->headers[i].name, wire->headers[i].value);
    }
    api_text_add_string(&text, "\r\n");
    api_text_add(&text, wire->bytes, (size_t)wire->length);
    bool sent = !text.failed && srv_recv_send(connection, text.bytes, text.length);
    api_text_clear(&text);
    return sent;
}
