/* gate.h - checks what the token of a request allows, with one function for each check.
 *
 *     api_gate_enter       may the token use the route? It looks only at method, path and token.
 *                          Refuses with 401 or 403 `forbidden`, or with 429 if the client exceeds
 *                          its rate (rating.h)
 *     api_gate_sees        may the token see a mesh? A mesh outside the token's prefixes is
 *                          answered with the same bytes as one that does not exist: 404
 *     api_gate_may_create  may the token make a mesh with this id? Refuses with 403 `prefix`
 *     api_gate_may_change  may the token write, and not only do a dry run? Refuses with 403
 *                          `forbidden`
 *
 * If the server has no tokens (`tokens` of api_options is NULL), all checks pass. If it has tokens,
 * x->token is set after the gate on every route that is not open. */
#ifndef HE_API_REQUEST_GATE_H
#define HE_API_REQUEST_GATE_H

#include "api/request/exchange.h"

/* Finds the token and sets x->token; sets x->rehearses_only if the token may do nothing but a dry
 * run of this write. If the request is refused, returns false with the problem filled and
 * x->at_gate set, because nothing in the store was read. */
bool api_gate_enter(api_exchange *x);
/* Returns false if the token may not see a mesh with this id, whether or not it exists. */
bool api_gate_sees(const api_exchange *x, const char *mesh);
/* Checks that the token may make a mesh with this id. Returns false with the problem filled if
 * not. */
bool api_gate_may_create(api_exchange *x, const char *mesh);
/* Checks that the token may change the store. Returns false with the problem filled if the token
 * allows only dry runs. A handler calls it when it knows that its request is no dry run, and
 * api_write_commit calls it again. */
bool api_gate_may_change(api_exchange *x);

/* The last parameter of a query may be a ticket (api/token/tickets.h), which replaces the header
 * Authorization. */
#define API_TICKET "ticket="
/* Returns the position of the ticket parameter in a query; NULL if there is none. */
const char *api_gate_ticket(const char *query);

/* Returns the value of the header WWW-Authenticate for the problem of the exchange; NULL if it
 * needs none. */
const char *api_gate_challenge(const api_exchange *x);

#endif
