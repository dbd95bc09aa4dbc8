/* trace.h - the trace context of a request (W3C Trace Context, the recommendation of 2021).
 *
 *     traceparent: 00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01
 *                  |  trace id                         parent id        flags
 *                  version
 *
 *   T1  If a request has a header traceparent, the answer has one, too: with the client's trace id,
 *       a span id of this request, and the flag that says whether the client records the trace.
 *   T2  If the header is malformed or occurs twice, a new trace begins, as section 4.3 of the
 *       recommendation says: the answer has a new trace id and no flags.
 *   T3  If a request has no traceparent, the answer has none. The request still has a request id.
 *   T4  A version above 00 is read as 00, whatever follows after another hyphen; ff is malformed.
 *   T5  The header tracestate is neither read nor answered: it is for servers to which a request is
 *       passed on, and hedged passes none on. */
#ifndef HE_SERVER_LOG_TRACE_H
#define HE_SERVER_LOG_TRACE_H

#include "server/log/access.h"

#include <stdatomic.h>
#include <stddef.h>

enum { SRV_TRACEPARENT = 55 };

/* The trace context of a request. All digits are hexadecimal, in lower case. */
typedef struct srv_trace {
    /* The trace to which the request belongs; "" if it belongs to none. */
    char trace_id[SRV_TRACE_ID + 1];
    /* The client's span id; "" if the trace begins with this request. */
    char parent_id[SRV_SPAN_ID + 1];
    char span_id[SRV_SPAN_ID + 1];      /* the id of this request */
    char answered[SRV_TRACEPARENT + 1]; /* the value of traceparent in the answer */
} srv_trace;

/* A generator of span ids: it starts from a random number, and never repeats an id. */
typedef struct srv_spans {
    uint64_t seed;
    _Atomic uint64_t next;
} srv_spans;

void srv_spans_init(srv_spans *spans);

/* Fills `out` by rules T1 to T4. `count` is the number of traceparent headers of the request, and
 * `value` the value of the first one. If there are any, makes a span id for the request. */
void srv_trace_read(srv_spans *spans, const char *value, size_t count, srv_trace *out);

#endif
