/* split.h - splits an edge together with the faces beside it. */
#ifndef HE_EDIT_LOCAL_SPLIT_H
#define HE_EDIT_LOCAL_SPLIT_H

#include "mesh/mesh.h"

typedef struct he_split {
    he_vertex vertex;
    /* The new half of the split edge, then the new diagonals of the faces beside it. */
    he_edge edges[3];
    he_face faces[2];
    /* Number of faces beside the edge: 2, or 1 on the boundary; `edges` has one entry more. */
    unsigned sides;
} he_split;

/* edge_split: V + 1, E + 3, F + 2; on the boundary V + 1, E + 2, F + 1. It puts a vertex on the
 * edge (edge_bisect), and adds in each face beside it a diagonal from the new vertex w to the
 * second corner after it, which in a triangle is the opposite one.
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
 * In a polygon a, b, c, ... left of a -> b the diagonal goes to c, so that b, c and w are a
 * triangle; in the face on the other side, b, a, d, ..., it goes to d.
 *
 * Edge e and both faces keep the part with a, the origin of half-edge 2e. The new half of the edge
 * descends from e, and the new faces from the old ones; the diagonals have no parents. In the
 * output the diagonal and face to the left of half-edge 2e come first.
 *
 * `out` may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BAD_VALUE unless 0 < t < 1.
 * Returns HE_DOUBLED_EDGE if c = d, since both diagonals would join it to w.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_split(he_mesh *m, he_edge e, double t, he_split *out, he_error *err);

#endif
