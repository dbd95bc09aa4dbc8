/* ring.h - walks once around a face, and sums up what the functions of geometry.h need for the
 * area, the normal and the centroid of the face. */
#ifndef HE_GEOMETRY_RING_H
#define HE_GEOMETRY_RING_H

#include "geometry/scale.h"

/* Sums that are collected by one walk around a face, from coordinates that are multiplied by a
 * scale. */
typedef struct he_ring {
    he_vec3 vector; /* twice the area vector */
    he_vec3 sum;    /* sum of the positions of the corners */
    /* The sum of |u|^2 |v|^2 over the triangles of a fan that fills the face, where u and v are two
     * sides of a triangle. It says how large the terms of `vector` were before they cancelled each
     * other out. */
    double reach;
    uint32_t degree; /* number of corners; 0 if the links are broken */
} he_ring;

/* An upper bound of the squared relative rounding error of the product of two differences. */
#define HE_RING_NOISE (64 * DBL_EPSILON * DBL_EPSILON)

/* Returns how many half-edges walks around all faces of the mesh may visit together. A walk that
 * visits more follows broken links. */
uint32_t he_ring_budget(const he_mesh *m);
/* Walks around the loop of half-edge `first`. `*budget` is the number of half-edges that may still
 * be visited; each visit decreases it. */
he_ring he_ring_walk(const he_mesh *m, uint32_t first, double scale, uint32_t *budget);
/* Walks like he_ring_walk, with coordinates scaled so that nothing overflows or underflows. A
 * length in the result must be multiplied by 2^exponent to get the true length. */
he_ring he_ring_measure(const he_mesh *m, uint32_t first, uint32_t *budget, int *exponent);
he_ring he_ring_of_face(const he_mesh *m, he_face f, int *exponent);

/* Finds the unit normal of a face from the sums of a walk around it. If the face is degenerate, the
 * normal is zero and the function returns false. */
bool he_ring_normal(const he_ring *r, he_vec3 *out);
double he_ring_area(const he_ring *r, int exponent);
/* Returns the centroid of a face. `found` has the sums of a walk that began at
 * half-edge `first`. */
he_vec3 he_ring_centroid(const he_mesh *m, uint32_t first, const he_ring *found, int exponent);

/* Returns HE_CORRUPT with a message that the half-edges of the face do not form a loop. */
HE_NODISCARD he_status he_ring_corrupt(uint32_t face, he_error *err);

#endif
