/* quota.h - meshes and bytes of tokens: what the store counts for each (store/holder/holders.h).
 *
 * A mesh is its maker's: the token that made it holds it, whoever changes it, and its quota is
 * asked when it grows. */
#ifndef HE_API_REQUEST_QUOTA_H
#define HE_API_REQUEST_QUOTA_H

#include "api/request/exchange.h"

/* Fill the problem where the store said ST_QUOTA: always false. */
bool api_quota_fail_new(api_exchange *x); /* of a mesh that the request would make */
/* Refuses the growth of x->mesh. What another token may have is not told. */
bool api_quota_fail(api_exchange *x);

#endif
