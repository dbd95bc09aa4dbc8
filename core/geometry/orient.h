/* orient.h - exact orientation tests: decide on which side of a line or plane a point is.
 *
 * The determinant is first computed in doubles. If it is smaller than its possible error, it is
 * computed exactly as an expansion: a sum of doubles of which none overlaps another (J. R.
 * Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
 * 1997). The result is exact as long as no product of three coordinates overflows or falls below
 * 1e-280. */
#ifndef HE_GEOMETRY_ORIENT_H
#define HE_GEOMETRY_ORIENT_H

#include "mesh/mesh.h"

/* Returns the sign (-1, 0 or 1) of the volume of the tetrahedron a, b, c, d: 1 if a, b, c turn
 * clockwise as seen from d, -1 if they turn counter-clockwise, 0 if all four points lie in
 * a plane. */
int he_orient3(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d);

typedef struct he_vec2 {
    double x, y;
} he_vec2;

/* Returns the sign (-1, 0 or 1) of the area of the triangle a, b, c: 1 if the triangle turns
 * counter-clockwise, -1 if clockwise, 0 if its corners lie on a line. */
int he_orient2(he_vec2 a, he_vec2 b, he_vec2 c);

#endif
