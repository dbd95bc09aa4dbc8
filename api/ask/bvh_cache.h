/* bvh_cache.h - the tree of boxes (query/bvh.h) that answers rays and nearest points of a revision.
 *
 * The first question that needs it makes it, on the job pool unless the mesh is small. It is kept
 * with the mesh until a question is about a later revision or memory is short. A request that needs
 * it while another one is making it waits on the job pool. A request that holds a tree may use it
 * after it is no longer kept. */
#ifndef HE_API_ASK_BVH_CACHE_H
#define HE_API_ASK_BVH_CACHE_H

#include "api/ask/question.h"
#include "query/bvh.h"

/* Returns the tree of the asker's mesh; the asker holds it to its end. `in` is the question, or
 * NULL without a body. Returns NULL with the problem filled, or with a->spent. */
const he_bvh *api_asker_bvh(api_asker *a, const api_in *in);
void api_bvh_release(struct api_bvh *tree);

#endif
