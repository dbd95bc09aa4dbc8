/* http_answer.h - sends the answer of a request: that of its exchange, or a refusal.
 *
 * An answer whose bytes are in memory is sent as it is. Another answer is made piece by piece: its
 * `read` function is called whenever the socket can take more bytes. If the answer is slow to make,
 * or if there are more downloads than worker threads, other threads make the pieces
 * (http_producer.h); a stream waits for events (http_stream.h). In both cases the connection is
 * suspended meanwhile. */
#ifndef HE_SERVER_HTTP_HTTP_ANSWER_H
#define HE_SERVER_HTTP_HTTP_ANSWER_H

#include <stdbool.h>

typedef struct srv_request srv_request;

/* Replaces the answer by a problem with this he_status or code of api/json/problem.h, and frees the
 * exchange, if there is one. */
void srv_answer_refuse(srv_request *r, int code, const char *text);

/* Passes the answer to libmicrohttpd, which sends it; the request is then in the state SRV_DONE.
 * Returns false when memory is out: then the caller closes the connection. */
bool srv_answer_send(srv_request *r);
/* Sends the answer while the body is still arriving. The request is then in the state SRV_CUT: the
 * caller closes the connection, and the rest of the body is drained. */
void srv_answer_cut_off(srv_request *r);

#endif
