/* http_handle.h - the moves of a request between the states that http_request.h draws.
 *
 * What the client sends is handed to api piece by piece; what api calls long work runs on the job
 * pool, and an answer that is not durable yet is held (D1), both with the connection suspended. */
#ifndef HE_SERVER_HTTP_HTTP_HANDLE_H
#define HE_SERVER_HTTP_HTTP_HANDLE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct srv_request srv_request;

/* For each call of libmicrohttpd's handler: once with the headers, once for each piece of the body,
 * once at its end, and once more after each resume. `size` goes down to what of `upload` is to come
 * again. False when the connection is to be closed. The request may be another thread's when it
 * returns. */
bool srv_request_handle(srv_request *r, const char *method, const char *version, const char *upload,
                        size_t *size);

#endif
