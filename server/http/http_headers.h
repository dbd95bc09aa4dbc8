/* http_headers.h - the headers of a request as they are passed to api.
 *
 * libmicrohttpd keeps each header line separately. A list header that was sent in several lines is
 * one list (RFC 9110 5.3): if a second "Content-Encoding: gzip" were ignored, the body would be
 * misread. Of any other header the first line is its value. */
#ifndef HE_SERVER_HTTP_HTTP_HEADERS_H
#define HE_SERVER_HTTP_HTTP_HEADERS_H

#include "api/header/request_header.h"
#include "server/http/syntax/http_framing.h"

/* Points each of `values` into the head, or into `*joined` if lines were joined, or sets it to NULL
 * if the header is absent. The caller frees `*joined` after the last use of the values; it is NULL
 * if no lines were joined. Returns false when memory is out. */
bool srv_headers_read(const srv_head *head, const char *values[API_REQUEST_HEADERS], char **joined);

#endif
