/* sizing.h - wanted lengths of edges that depend on the curvature. */
#ifndef HE_REMESH_SIZING_H
#define HE_REMESH_SIZING_H

#include "remesh/net.h"

/* How a part of a surface is bent: a symmetric tensor whose eigenvectors are the directions of
 * curvature, times the area for which it stands. */
typedef struct he_bending {
    double xx, xy, xz, yy, yz, zz, area;
} he_bending;

/* All are lengths in coordinates of the net. */
typedef struct he_sizing {
    double error;       /* how far the triangles may be from a smooth surface */
    double least, most; /* limits of the wanted length */
} he_sizing;

/* Adds half of an edge to a tensor. `way` goes from one of its ends to the other; `left` and
 * `right` are the unit normals of the faces beside it, as seen in that direction. */
void he_sizing_bend(he_vec3 way, he_vec3 left, he_vec3 right, he_bending *to);
/* Returns the wanted length where a surface is bent so. */
double he_sizing_length(const he_bending *of, const he_sizing *s);

/* Finds the wanted length at each vertex of a net that has not been changed yet (M. Dunyach, D.
 * Vanderhaeghe, L. Barthe and M. Botsch, "Adaptive remeshing for real-time mesh deformation",
 * 2013): an edge of the length sqrt(6 error / k - 3 error^2) on a surface of curvature k is about
 * as far from the surface as `error`. The curvature is that of the greatest magnitude at the
 * vertex: from the angles at the edges around it (D. Cohen-Steiner and J.-M. Morvan, "Restricted
 * Delaunay triangulations and normal cycle", 2003), without the edges that are held, so that
 * creases do not count; or that of the line on which the vertex is.
 *
 * Lengths change by at most HE_SIZING_SLOPE times the distance between vertices.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
#define HE_SIZING_SLOPE 0.4
HE_NODISCARD he_status he_sizing_find(he_net *n, const he_sizing *sizing, he_progress *progress,
                                      he_error *err);

#endif
