/* admit.h - the checks before a request reaches its handler: of the route, the parameters in path
 * and query, the mesh, the headers of the body, and Accept. service.c handles the request from then
 * on. */
#ifndef HE_API_REQUEST_ADMIT_H
#define HE_API_REQUEST_ADMIT_H

#include "api/request/exchange.h"

/* Makes all checks of this file, and fills the members of the exchange `x` that describe the
 * request. Returns false if the request was refused, or answered (OPTIONS). */
bool api_admit(api_exchange *x);

/* Looks for the mesh on disk if x->is_cold, which means that the mesh is not in memory. The call
 * may block. Returns false if the request is refused. */
bool api_load_mesh(api_exchange *x);
/* Tries to answer or refuse a request to a mesh that is not in memory (x->is_cold) from its card,
 * the stored description with name, revision and counts, without loading the mesh. Returns true if
 * the request was answered or refused. The call may block. */
bool api_answer_from_card(api_exchange *x);

/* Returns how many bytes the body of the request may have. */
uint64_t api_body_cap(const api_exchange *x);
/* Refuses a body that is too long, or any body where the route allows none. Always returns
 * false. */
bool api_refuse_size(api_exchange *x);
/* Refuses a missing or empty body where the route needs one. Always returns false. */
bool api_refuse_empty(api_exchange *x);
/* Refuses an upload whose format is not known; the message consists of `detail` and the list of
 * known formats. Always returns false. */
bool api_refuse_format(api_exchange *x, const char *detail);

#endif
