/* spatial.h - what questions about space share with GET .../check. */
#ifndef HE_API_ASK_SPATIAL_H
#define HE_API_ASK_SPATIAL_H

#include "api/ask/tree.h"

/* Look for faces that meet where they should not, for at most what the asker has left, and leave
 * the pairs in a->first: see query/bvh.h for their order and for `complete`. `in` is the question,
 * NULL for none in a body. False with the problem filled, or with a->spent. */
bool api_asker_intersections(api_asker *a, const api_in *in, bool *complete);

#endif
