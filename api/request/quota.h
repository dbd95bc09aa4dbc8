/* quota.h - quotas of tokens: the meshes and bytes that the store counts for each
 * (store/holder/holders.h).
 *
 * A mesh counts for the token that made it, also when another token makes it grow. */
#ifndef HE_API_REQUEST_QUOTA_H
#define HE_API_REQUEST_QUOTA_H

#include "api/request/exchange.h"

/* Both fill the problem after the store returned ST_QUOTA, and always return false. */
bool api_quota_fail_new(api_exchange *x); /* for a mesh that the request would make */
/* Refuses the growth of x->mesh. The message does not say what another token's quota is. */
bool api_quota_fail(api_exchange *x);

#endif
