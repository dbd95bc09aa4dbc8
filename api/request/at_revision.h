/* at_revision.h - requests about an earlier revision.
 *
 * If a route has the query parameter `revision`, clients can ask for any revision that the history
 * still holds. A `cursor` (cursor.h) that pins a revision also asks for it. Handlers need no code
 * for this: mesh_access.c obtains the mesh as it was at that revision, and x->info describes it. */
#ifndef HE_API_REQUEST_AT_REVISION_H
#define HE_API_REQUEST_AT_REVISION_H

#include "api/request/exchange.h"

/* Returns true if the request asks for another revision than that of x->info. `revision` gets the
 * number of that revision, or 0, with the problem filled, if the parameters of the query contradict
 * each other. */
bool api_at_revision_wanted(api_exchange *x, uint64_t *revision);
/* Checks a result of api_at_revision_wanted. Returns false with the problem filled if `revision` is
 * 0 or higher than the present one (404). */
bool api_at_revision_may(api_exchange *x, uint64_t revision);
/* Makes a snapshot of the mesh as it was at `revision`. It may copy the mesh and replay changes, so
 * do not call it on a worker thread. Returns false with the problem filled (410, 507). */
bool api_at_revision_take(api_exchange *x, uint64_t revision, st_snapshot **out);

#endif
