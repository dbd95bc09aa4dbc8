/* answer_headers.h - THE list of response headers.
 *
 * A page of another origin can read only the headers named in Access-Control-Expose-Headers, and
 * those few that browsers always show. That header is made from this list. The server asserts that
 * it sends no header that is not listed. */
#ifndef HE_API_REQUEST_ANSWER_HEADERS_H
#define HE_API_REQUEST_ANSWER_HEADERS_H

#include <stdbool.h>

/* Each row: X(name, separator), for the headers that must be named so that a page can read them, in
 * order. */
#define API_EXPOSED_HEADERS(X)           \
    X("Accept-Encoding", ", ")           \
    X("Accept-Ranges", ", ")             \
    X("Allow", ", ")                     \
    X("Content-Disposition", ", ")       \
    X("Content-Encoding", ", ")          \
    X("Content-Security-Policy", ", ")   \
    X("ETag", ", ")                      \
    X("Export-Warnings", ", ")           \
    X("Idempotency-Replayed", ", ")      \
    X("Link", ", ")                      \
    X("Location", ", ")                  \
    X("Preference-Applied", ", ")        \
    X("RateLimit", ", ")                 \
    X("RateLimit-Policy", ", ")          \
    X("Referrer-Policy", ", ")           \
    X("Retry-After", ", ")               \
    X("Strict-Transport-Security", ", ") \
    X("Vary", ", ")                      \
    X("WWW-Authenticate", ", ")          \
    X("X-Accel-Buffering", ", ")         \
    X("X-Content-Type-Options", ", ")    \
    X("X-Request-Id", ", ")              \
    X("traceparent", "")

/* The value of Access-Control-Expose-Headers: "Accept-Encoding, Allow, ..." */
extern const char api_exposed_headers[];

/* Returns true if a header may be sent: it is in the list, or one that browsers always show
 * (Cache-Control, Content-Type), or one of CORS (Access-Control-...). */
bool api_header_is_listed(const char *name);

#endif
