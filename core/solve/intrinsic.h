/* intrinsic.h - triangulations of a surface that are given by the lengths of their edges alone.
 *
 * An intrinsic edge is a straight line on the surface between two vertices. Flips of such edges
 * change no length and no angle on the surface, and lead to the one intrinsic Delaunay
 * triangulation, in which the angles opposite to every inner edge add up to at most 180 degrees
 * (Bobenko and Springborn, A discrete Laplace-Beltrami operator for simplicial surfaces, 2007;
 * Fisher, Springborn, Bobenko and Schroeder, An algorithm for the construction of intrinsic
 * Delaunay triangulations, 2007). Its cotangent weights are not negative inside of the surface,
 * however thin the triangles of the mesh are.
 *
 * Side 3 t + k of triangle t runs from its corner k to its corner k + 1 (of 3). */
#ifndef HE_SOLVE_INTRINSIC_H
#define HE_SOLVE_INTRINSIC_H

#include "base/mem.h"
#include "base/progress.h"
#include "mesh/mesh.h"

typedef struct he_intrinsic {
    uint32_t triangles;
    uint32_t *corners;  /* a vertex for each side: the one where it begins */
    uint32_t *twins;    /* the side of the other triangle at the same edge; UINT32_MAX: none */
    double *lengths;    /* of each side, in units of `unit` */
    double *cotangents; /* of the angle opposite to each side */
    double unit;        /* the mean length of the sides of the surface; 1 if that is 0 */
    uint64_t flips;
} he_intrinsic;

/* The triangles of a surface. Two triangles are neighbours if an edge of theirs has the same
 * vertices in opposite order. */
typedef struct he_surface {
    uint32_t vertices, triangles;
    const uint32_t *corners; /* three vertices of each triangle, counterclockwise */
    const he_vec3 *points;   /* one of each vertex */
} he_surface;

/* Makes the triangulation of a surface by its edges. Lengths are raised by one small number if a
 * triangle has no area, so that each triangle has some (Sharp and Crane, A Laplacian for
 * nonmanifold triangle meshes, 2020). The caller frees the arrays with he_intrinsic_clear. Returns
 * HE_BAD_INDEX if a corner is not a vertex, HE_NOT_FINITE if an edge is longer than the largest
 * double, HE_LIMIT if there are more than 2^30 sides, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_intrinsic_make(const he_surface *surface, he_intrinsic *out,
                                         he_error *err);
void he_intrinsic_clear(he_intrinsic *t);

/* Flips edges until the triangulation is Delaunay, up to rounding.
 * Returns HE_CANCELLED if the work was cancelled, and HE_NO_MEMORY; the triangulation is then
 * valid, but not Delaunay. */
HE_NODISCARD he_status he_intrinsic_flip(he_intrinsic *t, he_progress *progress, he_error *err);

/* Returns the area of a triangle, in the square of `unit`. */
double he_intrinsic_area(const he_intrinsic *t, uint32_t triangle);

#endif
