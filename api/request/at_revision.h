/* at_revision.h - requests about an earlier revision.
 *
 * If a row lists the parameter `revision`, clients can ask for any revision that the history still
 * holds; the same is true if its `cursor` (cursor.h) pins a revision. The handler does nothing
 * special: mesh_access.c obtains the mesh as it was then, with x->info at that revision. */
#ifndef HE_API_REQUEST_AT_REVISION_H
#define HE_API_REQUEST_AT_REVISION_H

#include "api/request/exchange.h"

/* Returns true if the request wants another revision than that of x->info. Sets `revision` to it,
 * or to 0 with the problem filled. */
bool api_at_revision_wanted(api_exchange *x, uint64_t *revision);
/* Checks that the mesh can have this revision. Returns false with the problem filled if `revision`
 * is 0 or after the present one (404). */
bool api_at_revision_may(api_exchange *x, uint64_t revision);
/* Takes the mesh as it was at that revision. It may copy and replay, so do not call it on a worker.
 * Returns false with the problem filled (410, 507). */
bool api_at_revision_take(api_exchange *x, uint64_t revision, st_snapshot **out);

#endif
