/* rating.h - the limit of requests and bytes a second for a request's client (limit/rate.h).
 *
 * The client is the token if the gate found one, else the address. A refused request takes nothing
 * from the client's bucket. */
#ifndef HE_API_REQUEST_RATING_H
#define HE_API_REQUEST_RATING_H

#include "api/request/exchange.h"

/* Takes one request from the client's bucket. It is called once, when x->token is known, before
 * anything else in the request is read. Returns false with the problem filled if the client exceeds
 * its rate. */
bool api_rating_enter(api_exchange *x);
/* Takes bytes of a body or of an answer from the client's bucket. */
void api_rating_charge(api_exchange *x, uint64_t bytes);

#endif
