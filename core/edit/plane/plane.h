/* plane.h - the side of a plane that each vertex of a mesh is on.
 *
 * Every vertex is measured once, and all that an edit asks afterwards follows from these numbers:
 * two faces never disagree about a vertex they share. A vertex within the tolerance counts as in
 * the plane. Distances are positive on the side the normal points to. */
#ifndef HE_EDIT_PLANE_PLANE_H
#define HE_EDIT_PLANE_PLANE_H

#include "mesh/walk.h"

typedef struct he_sides {
    double *distance; /* of each vertex, times `scale`; exactly 0 in the plane and in dead rows */
    uint32_t count;   /* vertices issued when they were measured; those made since are in the plane,
                         since only cuts along it make any */
    double scale;     /* a power of two that brings the coordinates of the point and of all vertices
                         with edges within [-1, 1]: no size of mesh overflows or vanishes */
} he_sides;

/* Measure against the plane through `point` with a normal of any length. `tolerance` is a distance;
 * NULL stands for 1e-9 of the longest side of the box about the vertices that have edges, but no
 * less than 2^-48 of their coordinates along the normal, below which distances are rounding noise:
 * an isolated vertex, however far away, has no part in what is cut. A vertex put
 * where an edge meets the plane is then in it when measured again.
 *
 * Refused: HE_NOT_FINITE for point, normal or tolerance; HE_BAD_VALUE for a normal of zero or a
 * tolerance below zero. HE_NO_MEMORY. he_sides_clear frees. */
HE_NODISCARD he_status he_sides_find(const he_mesh *m, he_vec3 point, he_vec3 normal,
                                     const double *tolerance, he_sides *out, he_error *err);
void he_sides_clear(he_sides *sides);

/* 1 above the plane, -1 below, 0 in it. */
static inline int he_side_of(const he_sides *sides, he_vertex v)
{
    double d = v.i < sides->count ? sides->distance[v.i] : 0;
    return (d > 0) - (d < 0);
}

#endif
