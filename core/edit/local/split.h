/* split.h - splits an edge together with the faces beside it. */
#ifndef HE_EDIT_LOCAL_SPLIT_H
#define HE_EDIT_LOCAL_SPLIT_H

#include "mesh/mesh.h"

typedef struct he_split {
    he_vertex vertex;
    /* The new half of the split edge, then the new diagonals of the faces beside it. */
    he_edge edges[3];
    he_face faces[2];
    /* The number of faces beside the edge: 2, or 1 if the edge is on the boundary. `faces` has so
     * many entries, and `edges` has one more. */
    unsigned sides;
} he_split;

/* edge_split: V + 1, E + 3, F + 2; on the boundary V + 1, E + 2, F + 1. The edit puts a vertex w on
 * the edge (see edge_bisect). In each face beside the edge it adds a diagonal from w to the second
 * corner after w, which in a triangle is the opposite corner.
 *
 *              c                          c
 *             o                          o
 *           /   \                      / | \
 *         /   f   \                  / f | f1\
 *     a o-----------o b   --->   a o-----w-----o b
 *         \   g   /                  \ g | g1/
 *           \   /                      \ | /
 *             o                          o
 *              d                          d
 *
 * In the polygon a, b, c, ... to the left of a -> b, the diagonal ends at c, so that b, c and w are
 * a triangle. In the polygon b, a, d, ... to the right of a -> b, the diagonal ends at d.
 *
 * The part of edge e at a, the origin of half-edge 2e, keeps the id of e, and the parts of the
 * faces at a keep the ids of the faces. The new half of the edge descends from e, and each new face
 * descends from the face from which it was split; the diagonals have no parents. In the output, the
 * diagonal and face to the left of half-edge 2e come first.
 *
 * `out` may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BAD_VALUE unless 0 < t < 1.
 * Returns HE_DOUBLED_EDGE if c = d, because two diagonals would then join c and w.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_split(he_mesh *m, he_edge e, double t, he_split *out, he_error *err);

#endif
