/* bvh_disc.h - thick discs around the triangles of each node of a tree of boxes.
 *
 *            n                    A box around a patch that is not parallel to the axes is as
 *         ___|___                 thick as the patch is wide; a disc along the patch is only as
 *        |___c___| 2 thick        thick as the patch is rough. If many faces are about as near
 *        |-------|                as the nearest one, the thickness decides how many are visited.
 *          2 radius */
#ifndef HE_QUERY_BVH_DISC_H
#define HE_QUERY_BVH_DISC_H

#include "query/bvh.h"

/* Computes a disc for each node into tree->discs, which must have room. The rest of the tree must
 * be complete.
 * Returns HE_CANCELLED or HE_LIMIT if the budget ends the work. */
HE_NODISCARD he_status he_bvh_find_discs(he_bvh *tree, const he_mesh *m, he_budget *budget,
                                         he_error *err);

/* Returns a lower bound of the squared distance from point p to the triangles in the disc, in the
 * coordinates of the tree. */
double he_bvh_to_disc(const he_bvh_disc *disc, he_vec3 p);

#endif
