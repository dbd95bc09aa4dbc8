/* at_revision.h - requests that are about an earlier revision.
 *
 * A row that lists the parameter `revision` can be asked about any revision the history still
 * holds; so can one whose `cursor` (cursor.h) pins a revision. Its handler does nothing for that:
 * mesh_access.c obtains the mesh as it was, with x->info at that revision. */
#ifndef HE_API_REQUEST_AT_REVISION_H
#define HE_API_REQUEST_AT_REVISION_H

#include "api/request/exchange.h"

/* Is another revision wanted than that of x->info? Then which, or 0 with the problem filled. */
bool api_at_revision_wanted(api_exchange *x, uint64_t *revision);
/* False with the problem filled: `revision` is 0, or after the present one (404). */
bool api_at_revision_may(api_exchange *x, uint64_t revision);
/* Take the mesh as it was, which may copy and replay: not on a worker. False with the problem
 * filled (410, 507). */
bool api_at_revision_take(api_exchange *x, uint64_t revision, st_snapshot **out);

#endif
