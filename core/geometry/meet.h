/* meet.h - do two triangles meet where they should not? */
#ifndef HE_GEOMETRY_MEET_H
#define HE_GEOMETRY_MEET_H

#include "geometry/vec3.h"

/* Exact, like orient.h. */
bool he_triangle_has_area(const he_vec3 t[3]);

/* Do they share a point that is not a corner, or side between two corners, that both have? Corners
 * are the same when they are in the same place. Triangles with the same three corners meet; one
 * without area meets nothing. Exact, like orient.h. */
bool he_triangles_meet(const he_vec3 a[3], const he_vec3 b[3]);

#endif
