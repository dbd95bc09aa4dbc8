/* bevel.h - decides where a bevel cuts the edges that it shortens. */
#ifndef HE_EDIT_BEVEL_BEVEL_H
#define HE_EDIT_BEVEL_BEVEL_H

#include "mesh/walk.h"

#include <math.h>

/* The largest fraction of an edge's length that a bevel cuts off. It is below 1 so that no cut
 * reaches the far end of the edge. */
#define HE_BEVEL_MOST 0.99

/* Returns where a bevel cuts the edge of half-edge h, as a fraction of its length from the origin
 * of h. The cut is at the distance `width` (above 0) from the origin, but the fraction is at most
 * HE_BEVEL_MOST. An edge of length 0 is cut half-way. */
static inline double he_bevel_part(const he_mesh *m, he_halfedge h, double width)
{
    he_vec3 a = he_position(m, he_origin(m, h)), b = he_position(m, he_target(m, h));
    double length = hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
    return length > 0 ? fmin(width / length, HE_BEVEL_MOST) : 0.5;
}

#endif
