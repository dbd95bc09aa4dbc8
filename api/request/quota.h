/* quota.h - refusals for exceeded quotas. A quota limits the meshes that a token has made, by
 * number and by bytes, which the store counts (store/holder/holders.h).
 *
 * A mesh counts for the token that made it, also when another token makes it grow. */
#ifndef HE_API_REQUEST_QUOTA_H
#define HE_API_REQUEST_QUOTA_H

#include "api/request/exchange.h"

/* api_quota_fail_new refuses a new mesh. It and api_quota_fail fill the problem after the store
 * returned ST_QUOTA, and always return false. */
bool api_quota_fail_new(api_exchange *x);
/* Refuses the growth of x->mesh. The message does not say what another token's quota is. */
bool api_quota_fail(api_exchange *x);

#endif
