/* answer_headers.h - the one list of the response headers that the server sends.
 *
 * A page of another origin can read only the headers named in Access-Control-Expose-Headers, and a
 * few more that browsers always show. That header is made from this list. The server asserts that
 * it sends no header that is not listed. */
#ifndef HE_API_REQUEST_ANSWER_HEADERS_H
#define HE_API_REQUEST_ANSWER_HEADERS_H

#include <stdbool.h>

/* Each row: X(header, separator that follows it in Access-Control-Expose-Headers). The rows are the
 * headers that Access-Control-Expose-Headers must name so that a page can read them. */
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

/* Returns true if the server may send the header: it is in the list, or pages can always read it
 * (Cache-Control, Content-Type), or it belongs to CORS (Access-Control-...). */
bool api_header_is_listed(const char *name);

#endif
