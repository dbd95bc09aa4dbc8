/* triangle_intersection.h - tests whether two triangles in space intersect. */
#ifndef HE_GEOMETRY_TRIANGLE_INTERSECTION_H
#define HE_GEOMETRY_TRIANGLE_INTERSECTION_H

#include "geometry/vec3.h"

/* Returns true if the triangle has area. The result is exact, without rounding (orient.h). */
bool he_triangle_has_area(const he_vec3 t[3]);

/* Returns true if the triangles share a point other than a common corner or a point of a common
 * side. Two corners are common if they are at one position; a side is common if its ends are common
 * corners. Triangles with three common corners intersect; a triangle without area intersects
 * nothing. The result is exact, without rounding (orient.h). */
bool he_triangles_intersect(const he_vec3 a[3], const he_vec3 b[3]);

#endif
