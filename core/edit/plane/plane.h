/* plane.h - decides on which side of a plane each vertex of a mesh lies.
 *
 * Every vertex is measured once, and all decisions of an edit use these numbers: two faces never
 * disagree about a vertex they share. A vertex within the tolerance counts as in the plane.
 * Distances are positive on the side the normal points to. */
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
    /* The number of vertices that were issued when the distances were measured. Newer vertices
     * count as in the plane, because only cuts along the plane make them. */
    uint32_t count;
    /* The factor that coordinates are multiplied with: a power of two that brings the point and all
     * vertices that have edges within [-1, 1], so that nothing overflows or underflows. */
    double scale;
} he_sides;

/* Measures the vertices against a plane. If plane->tolerance is NULL, the tolerance is 1e-9 of the
 * longest side of the box around the vertices that have edges, but no less than 2^-48 of their
 * coordinates along the normal, below which distances are rounding noise. An isolated vertex,
 * however far away, has no influence on the tolerance. A vertex that was put where an edge crosses
 * the plane is in the plane when it is measured again. he_sides_clear frees the result.
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
