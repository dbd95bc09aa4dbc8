/* http_answer.h - sending the answer of a request: that of its exchange, or a refusal.
 *
 * Bytes in memory are sent as they are. Other answers are pulled. A reader is called as the socket
 * takes its bytes. Answers that are slow to make (or all, if there are more downloads than workers)
 * are made ahead (http_ahead.h), and streams wait for events (http_live.h); both suspend the
 * connection meanwhile. */
#ifndef HE_SERVER_HTTP_HTTP_ANSWER_H
#define HE_SERVER_HTTP_HTTP_ANSWER_H

#include <stdbool.h>

typedef struct srv_request srv_request;

/* Replaces the answer by a problem with this he_status or code of api/json/problem.h, and frees the
 * exchange, if there is one. */
void srv_answer_refuse(srv_request *r, int code, const char *text);

/* Queues the answer; the request is then DONE. Returns false when memory is out: the caller closes
 * the connection. */
bool srv_answer_send(srv_request *r);
/* Writes the answer while the body is still arriving; the request is then CUT: the caller closes
 * the connection, and the rest of the body is drained. */
void srv_answer_cut_off(srv_request *r);

#endif
