/* bvh_cache.h - the tree of boxes (query/bvh.h) of a mesh, with which spatial questions are
 * answered.
 *
 * The first request that needs the tree makes it, on the job pool unless the mesh is small. The
 * tree is then kept with the mesh, until a question is asked about a later revision of the mesh or
 * memory is short. A request that needs the tree while another request is making it waits on the
 * job pool. A request that has got a tree can use it until the request ends, even if the tree is no
 * longer kept with the mesh. */
#ifndef HE_API_ASK_BVH_CACHE_H
#define HE_API_ASK_BVH_CACHE_H

#include "api/ask/question.h"
#include "query/bvh.h"

/* Returns the tree of a->mesh, which stays valid as long as the asker `a`. `in` is the question;
 * NULL for a request without a body. Returns NULL with the problem (the body of the error answer)
 * filled, or with a->spent set (question.h). */
const he_bvh *api_asker_bvh(api_asker *a, const api_in *in);
void api_bvh_release(struct api_bvh *tree);

#endif
