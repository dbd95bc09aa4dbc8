/* bevel.h - decides where a bevel cuts the edges that it shortens. */
#ifndef HE_EDIT_BEVEL_BEVEL_H
#define HE_EDIT_BEVEL_BEVEL_H

#include "mesh/walk.h"

#include <math.h>

/* The largest part of an edge's length that a bevel cuts off, so that no cut reaches the other end
 * of the edge. */
#define HE_BEVEL_MOST 0.99

/* Returns where the edge of half-edge h is cut, as a fraction of its length from the origin of h:
 * that of the length `width` (above 0), but at most HE_BEVEL_MOST. An edge whose ends are at one
 * position is cut half-way. */
static inline double he_bevel_part(const he_mesh *m, he_halfedge h, double width)
{
    he_vec3 a = he_position(m, he_origin(m, h)), b = he_position(m, he_target(m, h));
    double length = hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
    return length > 0 ? fmin(width / length, HE_BEVEL_MOST) : 0.5;
}

#endif
