/* past.h - requests that are about an earlier revision.
 *
 * A row that lists the parameter `revision` can be asked about any revision the history still
 * holds; so can one whose `cursor` (cursor.h) pins a revision. Its handler does nothing for that:
 * api_read_begin and api_snapshot_of give the mesh as it was, with x->info at that revision. They
 * may copy and replay, so that on a worker they give NULL without a problem and have the handler
 * run again in api_work: it returns, as it does for a problem, and has kept nothing in x->state. */
#ifndef HE_API_REQUEST_PAST_H
#define HE_API_REQUEST_PAST_H

#include "api/request/exchange.h"

/* Is another revision wanted than that of x->info? Then which, or 0 with the problem filled. */
bool api_past_wanted(api_exchange *x, uint64_t *revision);
/* Get hold of it as x->past, with x->info of it: until the exchange ends, or somebody takes it.
 * False when there is a problem (404 or 410), or the handler runs again. */
bool api_past_begin(api_exchange *x, uint64_t revision);

#endif
