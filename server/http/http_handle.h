/* http_handle.h - the transitions of a request between the states in http_request.h.
 *
 * What the client sends is passed to api piece by piece. Long work runs on the job pool, and an
 * answer that is not durable yet is held back (D1); in both cases the connection is suspended. */
#ifndef HE_SERVER_HTTP_HTTP_HANDLE_H
#define HE_SERVER_HTTP_HTTP_HANDLE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_request srv_request;

/* Handles one call of libmicrohttpd's handler: once with the headers, once for each piece of the
 * body, once at its end, and once after each resume. Reduces `size` to the bytes of `upload` that
 * must be passed again. Returns false if the connection shall be closed. When it returns, another
 * thread may own the request. */
bool srv_request_handle(srv_request *r, const char *method, const char *version, const char *upload,
                        size_t *size);

#endif
