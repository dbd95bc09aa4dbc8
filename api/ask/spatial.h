/* spatial.h - what questions about space share with GET .../check. */
#ifndef HE_API_ASK_SPATIAL_H
#define HE_API_ASK_SPATIAL_H

#include "api/ask/tree.h"

/* Look for faces that meet where they should not, for at most what the asker has left, and leave
 * the pairs in a->first: see query/bvh.h for their order. `complete` is false when API_MAX_PAIRS
 * were met, so that there may be more. `in` is the question, NULL for none in a body. False with
 * the problem filled, limit_exceeded where it takes more than is left, or with a->spent. */
bool api_asker_intersections(api_asker *a, const api_in *in, bool *complete);

#endif
