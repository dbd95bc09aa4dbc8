/* token_stream.h - an answer that goes on (live.h), for as long as its token is good.
 *
 * A stream of events outlives the check of its request. It looks at the token before each piece,
 * and is woken when a reload drops the token: then it ends after the event that is being sent, with
 * `bye` and the reason "token". One that expires meanwhile ends so at the next event or
 * heartbeat. */
#ifndef HE_API_REQUEST_TOKEN_STREAM_H
#define HE_API_REQUEST_TOKEN_STREAM_H

#include "api/live.h"
#include "api/token/token_set.h"

#include <stdbool.h>

/* Puts a source around `source`, which it then owns. False without memory: then it does not. */
bool api_token_stream_new(api_tokens *tokens, api_token *token, const api_source *source,
                          api_source *out);

#endif
