/* http_answer.h - sending what a request is answered: what its exchange says, or a refusal.
 *
 * Bytes that are there are sent as they are. Others are pulled: those of a reader as the socket
 * takes them; those that are slow to make, or all where there are more downloads than workers
 * (http_ahead.h), and those of an answer that goes on (http_live.h) with the connection suspended
 * in between. */
#ifndef HE_SERVER_HTTP_HTTP_ANSWER_H
#define HE_SERVER_HTTP_HTTP_ANSWER_H

#include <stdbool.h>

typedef struct srv_request srv_request;

/* From now on the answer is a problem with this he_status or code of api/json/problem.h; the
 * exchange, if there was one, is freed. */
void srv_answer_refuse(srv_request *r, int code, const char *text);

/* Queue the answer; the request is DONE. False, for which the connection is to be closed, when
 * memory is out. */
bool srv_answer_send(srv_request *r);
/* Write the answer while the body is still arriving, and be CUT: the connection is to be closed,
 * and what still comes is drained. */
void srv_answer_cut_off(srv_request *r);

#endif
