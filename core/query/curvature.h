/* curvature.h - how a mesh bends at its vertices, and the weights of its edges that tell.
 *
 * All of it is that of the surface of triangles by which drawing.h fills the faces: a polygon of
 * more corners than three counts by those of its triangles that meet at the vertex or edge. The
 * triangles of a face need not turn in the plane of the face, so angles at a corner add up to what
 * the surface has there, above pi where the corner is reflex.
 *
 * DEGENERATE triangles, whose sides are parallel up to rounding, add their angles (a side of no
 * length stands at right angles to the others) and nothing else.
 *
 * M. Meyer, M. Desbrun, P. Schroeder and A. H. Barr, "Discrete differential-geometry operators for
 * triangulated 2-manifolds", 2003: the cotangent formula, and the mixed area, of which every vertex
 * has its share of the surface and no triangle a negative one. U. Pinkall and K. Polthier,
 * "Computing discrete minimal surfaces and their conjugates", 1993: the weights.
 *
 * What has no value is NaN, here alone: nothing else gives it. Units: radians, 1 / length,
 * 1 / length^2, length^2. */
#ifndef HE_QUERY_CURVATURE_H
#define HE_QUERY_CURVATURE_H

#include "mesh/mesh.h"

typedef struct he_curvature {
    /* 2 pi less the angles about the vertex, and less pi for each open fan: over a mesh without
     * isolated vertices the sum is 2 pi times its Euler number (Gauss and Bonnet). NaN when
     * isolated. */
    double angle_defect;
    double area; /* the mixed one; over a mesh the sum is that of its triangles */
    /* Positive where the surface bends away from its normals, as on a sphere seen from outside
     * (1 / radius). NaN on the boundary, when isolated, and where there is no area. */
    double mean;
    double gaussian; /* the angle defect over the area; NaN likewise */
} he_curvature;

/* Of each of `count` live vertices, or with `of` NULL of all of them in the order of ids. `most`
 * limits the squared corners of the faces of more than four beside them, which cutting those may
 * cost: HE_LIMIT. `watch` may be NULL. HE_NO_MEMORY, HE_IDS_EXHAUSTED, HE_CANCELLED. On failure
 * `out` may be half written. */
HE_NODISCARD he_status he_curvatures(const he_mesh *m, const uint32_t *of, size_t count,
                                     uint64_t most, he_watch *watch, he_curvature *out,
                                     he_error *err);

/* Half the sum of the cotangents of the angles opposite to each edge, one on the boundary; NaN
 * beside a degenerate triangle. Otherwise as above. */
HE_NODISCARD he_status he_edge_cotangents(const he_mesh *m, const uint32_t *of, size_t count,
                                          uint64_t most, he_watch *watch, double *out,
                                          he_error *err);

#endif
