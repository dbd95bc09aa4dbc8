/* spatial.h - the search for intersecting faces, which POST .../query and GET .../check share. */
#ifndef HE_API_ASK_SPATIAL_H
#define HE_API_ASK_SPATIAL_H

#include "api/ask/bvh_cache.h"

/* Finds pairs of faces that intersect other than at shared vertices and edges, using at most the
 * steps that are left plus API_MEET_STEPS, and puts them into the list a->first (query/bvh.h says
 * what counts as an intersection). Sets `complete` to false if there may be more pairs, because
 * API_MAX_PAIRS were found. `in` is the question; NULL for a request without a body. Returns false
 * with the problem filled (limit_exceeded if there are too few steps), or with a->spent set. */
bool api_asker_intersections(api_asker *a, const api_in *in, bool *complete);

#endif
