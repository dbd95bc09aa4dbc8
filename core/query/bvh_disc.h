/* bvh_disc.h - thick discs about the triangles of each node of a tree of boxes.
 *
 *            n                      A box about a patch that lies askew is as thick as the patch is
 *         ___|___                   wide; a disc along the patch is as thick as the patch is rough.
 *        |___c___| 2 thick          Where many faces are about as near as the nearest, that decides
 *        |-------|                  how many of them are looked at.
 *          2 radius
 */
#ifndef HE_QUERY_BVH_DISC_H
#define HE_QUERY_BVH_DISC_H

#include "query/bvh.h"

/* Give tree->discs, which has room, a disc for each node. The rest of the tree is there.
 * HE_CANCELLED and HE_LIMIT by the budget. */
HE_NODISCARD he_status he_bvh_find_discs(he_bvh *tree, const he_mesh *m, he_budget *budget,
                                         he_error *err);

/* The squared distance to the disc at most, in the tree's coordinates. */
double he_bvh_to_disc(const he_bvh_disc *disc, he_vec3 p);

#endif
