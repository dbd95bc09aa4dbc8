/* admit.h - what is looked at before a request reaches its handler: the route and what its path and
 * query say, the mesh, the headers of the body, Accept. service.c drives the rest. */
#ifndef HE_API_REQUEST_ADMIT_H
#define HE_API_REQUEST_ADMIT_H

#include "api/request/exchange.h"

/* Fill the request's part of `x`. False: it is refused, or answered (OPTIONS). */
bool api_admit(api_exchange *x);

/* Where x->is_cold: looks on the disk for the mesh, as api_admit would have in memory. Waits.
 * False: it is refused. */
bool api_load_mesh(api_exchange *x);
/* Where x->is_cold: is the request answered or refused by the card of the mesh, which is not loaded
 * for it? Waits. */
bool api_answer_from_card(api_exchange *x);

/* Bytes the route's body may have. */
uint64_t api_body_cap(const api_exchange *x);
/* The body is longer, or there should be none. Always false. */
bool api_refuse_size(api_exchange *x);
/* The body that the route needs is missing or empty. Always false. */
bool api_refuse_empty(api_exchange *x);
/* An upload whose format nothing tells: `detail` says why, the formats there are follow. Always
 * false. */
bool api_refuse_format(api_exchange *x, const char *detail);

#endif
