/* gate.h - what the token of a request lets it do: every check of it, one function each.
 *
 *     api_gate_enter       the route: its row's role, before anything of the request is looked at
 *                          but its method and path. 401, 403 `forbidden`; and the client's rate
 *                          (rating.h), 429
 *     api_gate_sees        a mesh: one outside the token's prefixes does not exist for it, and is
 *                          answered with the bytes of one that does not. 404
 *     api_gate_may_create  an id for a mesh. 403 `prefix`
 *     api_gate_may_change  a write by a token that may only rehearse it. 403 `forbidden`
 *
 * A server without tokens (api_options' `tokens` is NULL) asks for none, and each check passes. One
 * with tokens has a token in x->token beyond the gate of every route that is not open. */
#ifndef HE_API_REQUEST_GATE_H
#define HE_API_REQUEST_GATE_H

#include "api/request/exchange.h"

/* Finds the token and sets x->token, and x->rehearses_only where a write is let in for what it may
 * be: a dry run. False with the problem filled; x->at_gate then says that nothing stored was looked
 * at. */
bool api_gate_enter(api_exchange *x);
/* False where the mesh does not exist for the token, whether or not there is one. */
bool api_gate_sees(const api_exchange *x, const char *mesh);
/* False with the problem filled. */
bool api_gate_may_create(api_exchange *x, const char *mesh);
/* False with the problem filled. Called where a handler knows that its request is no dry run, and
 * once more where it commits. */
bool api_gate_may_change(api_exchange *x);

/* A ticket (api/token/tickets.h) in place of the header is the last parameter of the query. */
#define API_TICKET "ticket="
/* Where the ticket begins in a query, NULL where it has none. */
const char *api_gate_ticket(const char *query);

/* The value of WWW-Authenticate for the problem of the exchange, NULL where it has none. */
const char *api_gate_challenge(const api_exchange *x);

#endif
