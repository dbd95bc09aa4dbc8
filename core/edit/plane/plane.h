/* plane.h - decides on which side of a plane each vertex of a mesh lies.
 *
 * The distance of every vertex from the plane is computed once, and an edit bases all its decisions
 * on these numbers. So the decisions about two faces never contradict each other at a common
 * vertex. A vertex within the tolerance counts as in the plane. Distances are positive on the side
 * the normal points to. */
#ifndef HE_EDIT_PLANE_PLANE_H
#define HE_EDIT_PLANE_PLANE_H

#include "mesh/walk.h"

/* A plane, and the tolerance within which a vertex counts as lying in the plane. */
typedef struct he_plane {
    he_vec3 point;  /* any point of the plane */
    he_vec3 normal; /* the normal, of any length; it points to the side above */
    /* The distance from the plane up to which a vertex counts as in the plane; NULL: the default
     * that he_sides_find describes. */
    const double *tolerance;
} he_plane;

typedef struct he_sides {
    /* Distance of each vertex from the plane, times `scale`; exactly 0 for vertices in the plane
     * and for deleted ones. */
    double *distance;
    /* The number of vertices that were issued when the distances were computed. Vertices with
     * higher ids count as lying in the plane, because only cuts along the plane make them. */
    uint32_t count;
    /* The factor by which coordinates are multiplied: a power of two that brings the coordinates of
     * the plane's point, and of all vertices that have edges, into [-1, 1], so that nothing
     * overflows or underflows. */
    double scale;
} he_sides;

/* Computes the distances of all vertices from a plane. If plane->tolerance is NULL, the tolerance
 * is 1e-9 of the longest side of the bounding box of the vertices that have edges. It is larger if
 * the coordinates are so large that distances have a larger rounding error (about 2^-48 of the
 * coordinates along the normal). Isolated vertices do not influence the tolerance. A vertex that
 * was put where an edge crosses the plane counts as in the plane in a later call. he_sides_clear
 * frees the result.
 * Returns HE_NOT_FINITE if the point, normal or tolerance is not finite.
 * Returns HE_BAD_VALUE if the normal is zero or the tolerance is negative.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_sides_find(const he_mesh *m, const he_plane *plane, he_sides *out,
                                     he_error *err);
void he_sides_clear(he_sides *sides);

/* Returns 1 if vertex v is above the plane, -1 if it is below, and 0 if it is in the plane. */
static inline int he_side_of(const he_sides *sides, he_vertex v)
{
    double d = v.i < sides->count ? sides->distance[v.i] : 0;
    return (d > 0) - (d < 0);
}

#endif
