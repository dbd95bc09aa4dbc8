/* http_wire.h - describes an answer as plain data: status, headers and bytes. */
#ifndef HE_SERVER_HTTP_HTTP_WIRE_H
#define HE_SERVER_HTTP_HTTP_WIRE_H

#include "api/json/problem.h"
#include "api/request/api.h"
#include "server/http/http_deadline.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SRV_WIRE_HEADERS = API_ANSWER_HEADERS + 16 };

/* An answer that is to be sent; all pointers are borrowed. */
typedef struct srv_wire {
    int status;
    api_header headers[SRV_WIRE_HEADERS];
    size_t header_count;
    const char *bytes;
    int64_t length; /* number of bytes in the body of the answer; -1 if unknown */
    bool close;     /* whether the connection is closed after the answer */
    char retry[API_RETRY];
} srv_wire;

void srv_wire_add(srv_wire *wire, const char *name, const char *value);
/* Fills `wire` with the answer of an exchange (api/request/api.h). */
void srv_wire_answer(srv_wire *wire, const api_answer *answer);
/* Fills `wire` with a problem that was found outside of api. The problem is written as JSON into
 * `text`, which `wire` then borrows. If `problem` is NULL, the answer is 204 without a body. */
void srv_wire_refusal(srv_wire *wire, const api_problem *problem, const char *request_id,
                      api_text *text);
/* Adds CORS headers that let pages of `origin` read the answer (rule P4 of http_policy.h). If
 * `preflight` is true, the headers list what these pages may send. */
void srv_wire_cors(srv_wire *wire, const char *origin, bool preflight);

/* Sends the answer on a connection without libmicrohttpd (srv_recv_send), with the header
 * Connection: close. Returns false if the socket did not take all of the answer. */
bool srv_wire_send(const srv_wire *wire, const char *reason, srv_connection *connection);

#endif
