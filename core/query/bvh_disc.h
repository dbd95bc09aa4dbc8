/* bvh_disc.h - thick discs around the triangles of each node of a tree of boxes.
 *
 *            n                    A box around a patch that is not parallel to the axes is as
 *         ___|___                 thick as the patch is wide; a disc along the patch is only as
 *        |___c___| 2 thick        thick as the patch is rough. If many faces are about as near
 *        |-------|                as the nearest one, the thickness decides how many are visited.
 *          2 radius */
#ifndef HE_QUERY_BVH_DISC_H
#define HE_QUERY_BVH_DISC_H

#include "geometry/vec3.h"
#include "query/bvh.h"

/* Computes a disc for each node into tree->discs, which must have room. The rest of the tree must
 * be complete.
 * Returns HE_CANCELLED or HE_LIMIT if the budget ends the work. */
HE_NODISCARD he_status he_bvh_find_discs(he_bvh *tree, const he_mesh *m, he_budget *budget,
                                         he_error *err);

/* Twice the rounding error of a disc's normal, which is stored in floats. */
#define HE_BVH_ROUNDING 4e-7

static inline he_vec3 he_bvh_of_floats(const float v[3])
{
    return (he_vec3){v[0], v[1], v[2]};
}

/* Finds the distance of a point from the centre of a disc: `high` is its part along the disc's
 * normal, `wide` its part perpendicular to the normal. `from` is the vector from the centre to the
 * point. */
static inline void he_bvh_reach(he_vec3 from, he_vec3 normal, double *high, double *wide)
{
    const double along = he_vec3_dot(from, normal);
    *high = fabs(along);
    *wide = he_vec3_length(he_vec3_sub(from, he_vec3_scale(normal, along)));
}

/* Returns a lower bound of the squared distance from point p to the triangles in the disc, in the
 * coordinates of the tree. */
static inline double he_bvh_to_disc(const he_bvh_disc *disc, he_vec3 p)
{
    double high, wide;
    const he_vec3 from = he_vec3_sub(p, he_bvh_of_floats(disc->center));
    he_bvh_reach(from, he_bvh_of_floats(disc->normal), &high, &wide);
    const double rounding = HE_BVH_ROUNDING * (fabs(from.x) + fabs(from.y) + fabs(from.z));
    high = high - disc->thick - rounding;
    wide = wide - disc->radius - rounding;
    return (high > 0 ? high * high : 0) + (wide > 0 ? wide * wide : 0);
}

#endif
