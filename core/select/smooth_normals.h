/* smooth_normals.h - normals of faces for comparing neighbours, and the comparison of normals.
 *
 * A degenerate face (geometry.h) has no normal. Here it gets that of a neighbour across an edge, or
 * of a neighbour's neighbour and so on, so that slivers neither separate flat faces nor join the
 * two sides of a sharp edge. Only a component of degenerate faces alone stays without normals. */
#ifndef HE_SELECT_SMOOTH_NORMALS_H
#define HE_SELECT_SMOOTH_NORMALS_H

#include "mesh/mesh.h"

/* Finds the normals of all faces, into an array that has one entry for each id ever issued. The
 * caller frees the array. Entries are zero for deleted faces, and for faces of a component without
 * normals.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_smooth_normals(const he_mesh *m, he_vec3 **out, he_error *err);

/* Gives normals to the faces that have none in an array from he_face_normals.
 * Returns the errors of he_smooth_normals. */
HE_NODISCARD he_status he_normals_spread(const he_mesh *m, he_vec3 *normals, he_error *err);

static inline bool he_is_no_normal(he_vec3 a)
{
    return a.x == 0 && a.y == 0 && a.z == 0;
}

/* Unit vectors that make at most an angle between 0 and pi have at most the distance
 * 2 sin(angle / 2). The functions compare squares of such distances, which is as accurate for small
 * angles as for large ones. An angle counts as not above the limit if it exceeds it by less than
 * HE_ANGLE_NOISE, because the normals of faces in one plane differ by rounding. */
#define HE_ANGLE_NOISE 1e-9
double he_square_chord(double angle);
static inline bool he_is_within_chord(he_vec3 a, he_vec3 b, double square)
{
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return x * x + y * y + z * z <= square;
}

#endif
