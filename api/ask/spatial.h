/* spatial.h - the search for intersecting faces, which POST .../query and GET .../check share. */
#ifndef HE_API_ASK_SPATIAL_H
#define HE_API_ASK_SPATIAL_H

#include "api/ask/bvh_cache.h"

/* Finds faces that intersect where they should not, spending at most the asker's steps, and leaves
 * the pairs in a->first (query/bvh.h defines their order). Sets `complete` to false if
 * API_MAX_PAIRS were found, so that there may be more. `in` is the question, or NULL without a
 * body. Returns false with the problem filled (limit_exceeded if there are too few steps), or with
 * a->spent. */
bool api_asker_intersections(api_asker *a, const api_in *in, bool *complete);

#endif
