/* http_headers.h - collects the headers of a request in the form in which api takes them.
 *
 * libmicrohttpd keeps each header line separately. If the value of a header is a list, all its
 * lines together are one list (RFC 9110 5.3): if a second "Content-Encoding: gzip" were ignored,
 * the body would be misread. The value of any other header is that of its first line. */
#ifndef HE_SERVER_HTTP_HTTP_HEADERS_H
#define HE_SERVER_HTTP_HTTP_HEADERS_H

#include "api/header/request_header.h"
#include "server/http/syntax/http_framing.h"

/* Finds the value of each header that api knows, and sets its entry of `values`: to NULL if the
 * header is absent, else to a text in `head`, or in *joined if several lines were joined. *joined
 * is NULL if none were; the caller frees it after the last use of the values. Returns false when
 * memory is out. */
bool srv_headers_read(const srv_head *head, const char *values[API_REQUEST_HEADERS], char **joined);

#endif
