/* gate.h - what a request's token may do: all checks, one function for each.
 *
 *     api_gate_enter       the route: its row's role, before anything of the request is read but
 *                          its method and path. 401, 403 `forbidden`; and the client's rate
 *                          (rating.h), 429
 *     api_gate_sees        a mesh: a mesh outside the token's prefixes is answered with the same
 *                          bytes as one that does not exist. 404
 *     api_gate_may_create  an id for a new mesh. 403 `prefix`
 *     api_gate_may_change  a write by a token that may only do a dry run. 403 `forbidden`
 *
 * If the server has no tokens (`tokens` of api_options is NULL), all checks pass. If it has tokens,
 * x->token is set after the gate on every route that is not open. */
#ifndef HE_API_REQUEST_GATE_H
#define HE_API_REQUEST_GATE_H

#include "api/request/exchange.h"

/* Finds the token and sets x->token; sets x->rehearses_only if the token may do nothing but a dry
 * run of this write. Returns false with the problem filled; x->at_gate then says that nothing
 * stored was read. */
bool api_gate_enter(api_exchange *x);
/* Returns false if the token may not see a mesh with this id, whether or not it exists. */
bool api_gate_sees(const api_exchange *x, const char *mesh);
/* Checks that the token may make a mesh with this id. Returns false with the problem filled if
 * not. */
bool api_gate_may_create(api_exchange *x, const char *mesh);
/* Checks that the token may change the store. Returns false with the problem filled if it may only
 * make dry runs. A handler calls it when it knows that its request is no dry run; the commit calls
 * it once more. */
bool api_gate_may_change(api_exchange *x);

/* A ticket (api/token/tickets.h) is the last parameter of the query and replaces the Authorization
 * header. */
#define API_TICKET "ticket="
/* Returns where the ticket begins in a query, or NULL. */
const char *api_gate_ticket(const char *query);

/* Returns the value of WWW-Authenticate for the problem of the exchange, or NULL. */
const char *api_gate_challenge(const api_exchange *x);

#endif
