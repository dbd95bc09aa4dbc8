/* http_handle.h - moves a request from state to state (see http_request.h).
 *
 * The body of the request is passed to api piece by piece. Long work runs on a pool of threads, and
 * an answer is held back until the changes that it shows are durable (D1); in both cases the
 * connection is suspended. */
#ifndef HE_SERVER_HTTP_HTTP_HANDLE_H
#define HE_SERVER_HTTP_HTTP_HANDLE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_request srv_request;

/* Handles one call of libmicrohttpd's handler, which is called once with the headers, once for each
 * piece of the body, once at its end, and once after each resume. Sets *size to how many bytes at
 * the end of `upload` were not handled and must be passed again. Returns false if the connection
 * shall be closed. When the function returns, another thread may own the request. */
bool srv_request_handle(srv_request *r, const char *method, const char *version, const char *upload,
                        size_t *size);

#endif
