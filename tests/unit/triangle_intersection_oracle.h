/* triangle_intersection_oracle.h - decides whether two triangles intersect, without any
 * optimization, as a second opinion: each predicate is evaluated where it is needed, and special
 * cases are distinguished only where they must be. */
#ifndef TESTS_UNIT_TRIANGLE_INTERSECTION_ORACLE_H
#define TESTS_UNIT_TRIANGLE_INTERSECTION_ORACLE_H

#include "geometry/orient.h"

#include <stdbool.h>

/* Returns whether two triangles intersect. Triangles without area meet nothing; triangles that
 * share a corner or an edge meet only if they also intersect in other points. */
bool oracle_triangles_meet(const he_vec3 a[3], const he_vec3 b[3]);

#endif
