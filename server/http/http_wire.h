/* http_wire.h - an answer as plain data: status, headers, bytes. */
#ifndef HE_SERVER_HTTP_HTTP_WIRE_H
#define HE_SERVER_HTTP_HTTP_WIRE_H

#include "api/json/problem.h"
#include "api/request/api.h"
#include "server/http/http_deadline.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_WIRE_HEADERS = API_ANSWER_HEADERS + 16 };

/* Everything is borrowed. */
typedef struct srv_wire {
    int status;
    api_header headers[SRV_WIRE_HEADERS];
    size_t header_count;
    const char *bytes;
    int64_t length; /* -1: unknown */
    bool close;
    char retry[API_RETRY];
} srv_wire;

void srv_wire_add(srv_wire *wire, const char *name, const char *value);
/* Describes an answer of api. */
void srv_wire_answer(srv_wire *wire, const api_answer *answer);
/* Describes a problem found outside of api; it is written into `text`, which `wire` then borrows. A
 * NULL problem describes 204 without a body. */
void srv_wire_refusal(srv_wire *wire, const api_problem *problem, const char *request_id,
                      api_text *text);
/* Lets pages of `origin` read the answer (rule P4 of http_policy.h). With `preflight` it also lists
 * what they may send. */
void srv_wire_cors(srv_wire *wire, const char *origin, bool preflight);

/* Writes the answer to a connection directly (srv_recv_send), with Connection: close. Returns false
 * if the socket did not take all of it. */
bool srv_wire_send(const srv_wire *wire, const char *reason, srv_connection *connection);

#endif
