/* rating.h - requests and bytes a second of the client that a request comes from (limit/rate.h).
 *
 * The client is the token where the gate found one, else the address. A request that is not let in
 * costs nothing. */
#ifndef HE_API_REQUEST_RATING_H
#define HE_API_REQUEST_RATING_H

#include "api/request/exchange.h"

/* Takes one request from the client's bucket. False with the problem filled. Called once, when
 * x->token is known, before anything else of the request is looked at. */
bool api_rating_enter(api_exchange *x);
/* Takes bytes of a body or an answer. */
void api_rating_charge(api_exchange *x, uint64_t bytes);
/* Writes x->rate_policy and x->rate_field, "" where the client has no limit. */
void api_rating_fields(api_exchange *x);

#endif
