/* curvature.h - discrete curvature at vertices, and cotangent weights of edges.
 *
 * All values are those of the surface of triangles with which draw_arrays.h fills the faces: of a
 * polygon of more than three corners, only the triangles that touch the vertex or edge count. The
 * triangles of a face need not turn in the plane of the face, so the angles at a corner add up to
 * what the surface has there, above pi if the corner is reflex.
 *
 * DEGENERATE triangles, whose sides are parallel up to rounding, contribute only their angles to
 * the results; a side of length 0 counts as perpendicular to the others.
 *
 * M. Meyer, M. Desbrun, P. Schroeder and A. H. Barr, "Discrete differential-geometry operators for
 * triangulated 2-manifolds", 2003: the cotangent formula, and the mixed area, which gives every
 * vertex a share of the surface, never a negative part of a triangle. U. Pinkall and K. Polthier,
 * "Computing discrete minimal surfaces and their conjugates", 1993: the weights.
 *
 * Undefined values are NaN; no other function of the kernel returns NaN. Units: radians, 1 /
 * length, 1 / length^2, length^2. */
#ifndef HE_QUERY_CURVATURE_H
#define HE_QUERY_CURVATURE_H

#include "mesh/mesh.h"

typedef struct he_curvature {
    /* 2 pi minus the angles around the vertex, and minus pi for each open fan: over a mesh without
     * isolated vertices the sum is 2 pi times its Euler number (Gauss and Bonnet). NaN if the
     * vertex is isolated. */
    double angle_defect;
    /* The mixed area, the vertex's share of the surface; over a mesh the sum is the whole area. */
    double area;
    /* The mean curvature. It is positive where the surface bends away from its normals; on a sphere
     * seen from outside it is 1 / radius. NaN if the vertex is on the boundary or isolated, or if
     * there is no area around it. */
    double mean;
    double gaussian; /* the angle defect divided by the area; NaN if `mean` is NaN */
} he_curvature;

/* Computes the curvature of each of `count` live vertices, or, if `of` is NULL, of all of them in
 * the order of ids. `progress` may be NULL. On failure `out` may be half written.
 * Returns HE_LIMIT if the sum of the squared degrees of the neighbouring faces of more than four
 * corners is above `most`: cutting such faces into triangles may take that many steps.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if the id of a face is too large for the arrays of a drawing
 * (draw_arrays.h).
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_curvatures(const he_mesh *m, const uint32_t *of, size_t count,
                                     uint64_t most, he_progress *progress, he_curvature *out,
                                     he_error *err);

/* Computes half the sum of the cotangents of the angles opposite to each edge; on the boundary
 * there is only one such angle. The result is NaN for an edge beside a degenerate triangle.
 * Parameters and errors are those of he_curvatures. */
HE_NODISCARD he_status he_edge_cotangents(const he_mesh *m, const uint32_t *of, size_t count,
                                          uint64_t most, he_progress *progress, double *out,
                                          he_error *err);

#endif
