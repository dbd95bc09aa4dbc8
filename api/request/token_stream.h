/* token_stream.h - an answer without a known end (live.h), sent as long as its token is valid.
 *
 * The token of a request is checked when the request begins, but a stream of events may last much
 * longer. So the stream checks the token again before each piece, and is woken when a reload of the
 * token file revokes the token. The stream then ends after the current event, with the event `bye`
 * and the reason "token". If a token expires, its streams end in this way at the next event or
 * heartbeat. */
#ifndef HE_API_REQUEST_TOKEN_STREAM_H
#define HE_API_REQUEST_TOKEN_STREAM_H

#include "api/live.h"
#include "api/token/token_set.h"

#include <stdbool.h>

/* Wraps `source` in a stream that checks `token`; the stream then owns `source`. Returns false when
 * memory is out; the caller then still owns `source`. */
bool api_token_stream_new(api_tokens *tokens, api_token *token, const api_source *source,
                          api_source *out);

#endif
