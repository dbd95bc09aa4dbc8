/* trace.h - the trace context of a request (W3C Trace Context, the recommendation of 2021).
 *
 *     traceparent: 00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01
 *                  |  trace id                         parent id        flags
 *                  version
 *
 *   T1  A client that sends traceparent gets one back: its trace id, a span id of this request, and
 *       the flag that says whether the client records the trace.
 *   T2  A malformed one, or two of them, count as none (section 4.3). Then the
 *       recommendation begins a new trace: the answer has a new trace id and no flags.
 *   T3  If the client sends none, the answer has none. The request still has a request id.
 *   T4  A version above 00 is read as 00, whatever follows after another hyphen; ff is malformed.
 *   T5  tracestate is neither read nor answered: it is for servers that a request is passed
 *       on to, and hedged passes none on. */
#ifndef HE_SERVER_LOG_TRACE_H
#define HE_SERVER_LOG_TRACE_H

#include "server/log/access.h"

#include <stdatomic.h>
#include <stddef.h>

enum { SRV_TRACEPARENT = 55 };

/* The trace context of a request. All digits are hexadecimal, in lower case. */
typedef struct srv_trace {
    char trace_id[SRV_TRACE_ID + 1];    /* "": the request is in no trace */
    char parent_id[SRV_SPAN_ID + 1];    /* "": this request begins the trace */
    char span_id[SRV_SPAN_ID + 1];      /* of this request */
    char answered[SRV_TRACEPARENT + 1]; /* traceparent in the answer */
} srv_trace;

/* A source of span ids: random at the start, and never repeated by one server. */
typedef struct srv_spans {
    uint64_t seed;
    _Atomic uint64_t next;
} srv_spans;

void srv_spans_init(srv_spans *spans);

/* Reads the `count` values of a request's traceparent headers, of which `value` is the first. If
 * there are any, makes a span id for the request. */
void srv_trace_read(srv_spans *spans, const char *value, size_t count, srv_trace *out);

#endif
