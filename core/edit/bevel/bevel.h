/* bevel.h - where a bevel cuts the edges that it shortens. */
#ifndef HE_EDIT_BEVEL_BEVEL_H
#define HE_EDIT_BEVEL_BEVEL_H

#include "mesh/walk.h"

#include <math.h>

/* Of the length of an edge, what a cut may take: so no two cuts, and no cut and an end, meet. */
#define HE_BEVEL_MOST 0.99

/* Where the edge of h is cut at `width` above 0 from the origin of h, as a part of the way to its
 * target: at most HE_BEVEL_MOST, and half-way on an edge without length, where every cut lies at
 * its ends. */
static inline double he_bevel_part(const he_mesh *m, he_halfedge h, double width)
{
    he_vec3 a = he_position(m, he_origin(m, h)), b = he_position(m, he_target(m, h));
    double length = hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
    return length > 0 ? fmin(width / length, HE_BEVEL_MOST) : 0.5;
}

#endif
