/* http_headers.h - the headers of a request as they are handed down to api.
 *
 * libmicrohttpd keeps every line of the head apart. A header that is a list and was sent in several
 * lines is one list (RFC 9110 5.3): a second "Content-Encoding: gzip" that nobody looks at would
 * have a body taken for something it is not. The first line of any other header is its value. */
#ifndef HE_SERVER_HTTP_HTTP_HEADERS_H
#define HE_SERVER_HTTP_HTTP_HEADERS_H

#include "api/header/request_header.h"
#include "server/http/syntax/http_framing.h"

/* Points each of `values` into the head, or into `*joined` where lines were joined, or sets it to
 * NULL where the header is absent. `*joined` is the caller's, is as long needed as the values are,
 * and is NULL where no lines were joined. Returns false when memory is out. */
bool srv_headers_read(const srv_head *head, const char *values[API_REQUEST_HEADERS], char **joined);

#endif
