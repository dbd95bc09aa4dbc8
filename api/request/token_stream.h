/* token_stream.h - an answer without a known end (live.h), sent as long as its token is valid.
 *
 * A stream of events outlives the check at the start of its request. It checks the token before
 * each piece, and is woken when a reload revokes the token. It then ends after the current event,
 * with `bye` and the reason "token". If a token expires, its streams end in this way at the next
 * event or heartbeat. */
#ifndef HE_API_REQUEST_TOKEN_STREAM_H
#define HE_API_REQUEST_TOKEN_STREAM_H

#include "api/live.h"
#include "api/token/token_set.h"

#include <stdbool.h>

/* Wraps `source` and takes it. Returns false, and takes nothing, when memory is out. */
bool api_token_stream_new(api_tokens *tokens, api_token *token, const api_source *source,
                          api_source *out);

#endif
