/* request_header.h - the table of the request headers that the API reads.
 *
 * The server fills in an array of their values (api_request in request/api.h). A header that is not
 * in the table is not read by any handler. */
#ifndef HE_API_HEADER_REQUEST_HEADER_H
#define HE_API_HEADER_REQUEST_HEADER_H

#include <stdbool.h>
#include <stddef.h>

/* Each row: X(constant, name, true if the header is a list). If a request has several lines of such
 * a header, they are joined to one value (RFC 9110 5.3). */
#define API_REQUEST_HEADER_MAP(X)                 \
    X(ACCEPT, "Accept", true)                     \
    X(ACCEPT_ENCODING, "Accept-Encoding", true)   \
    X(AUTHORIZATION, "Authorization", false)      \
    X(CONTENT_ENCODING, "Content-Encoding", true) \
    X(CONTENT_TYPE, "Content-Type", false)        \
    X(IDEMPOTENCY_KEY, "Idempotency-Key", false)  \
    X(IF_MATCH, "If-Match", true)                 \
    X(IF_NONE_MATCH, "If-None-Match", true)       \
    X(LAST_EVENT_ID, "Last-Event-ID", false)      \
    X(PREFER, "Prefer", true)                     \
    X(SEC_FETCH_SITE, "Sec-Fetch-Site", false)

#define API_REQUEST_HEADER_CONSTANT(constant, name, is_list) API_HEADER_##constant,
typedef enum api_request_header {
    API_REQUEST_HEADER_MAP(API_REQUEST_HEADER_CONSTANT) API_REQUEST_HEADERS
} api_request_header;
#undef API_REQUEST_HEADER_CONSTANT

/* Returns the constant of the header with this name, whatever its letter case; API_REQUEST_HEADERS
 * for a header that no handler reads. */
api_request_header api_request_header_find(const char *name, size_t length);

bool api_request_header_is_list(api_request_header header);

#endif
