/* split.h - an edge split together with the faces beside it. */
#ifndef HE_EDIT_LOCAL_SPLIT_H
#define HE_EDIT_LOCAL_SPLIT_H

#include "mesh/mesh.h"

typedef struct he_split {
    he_vertex vertex;
    he_edge edges[3]; /* the new part of the edge, then the diagonals */
    he_face faces[2];
    unsigned sides; /* faces beside the edge: 2, or 1 on the boundary; edges are one more */
} he_split;

/* edge_split: V + 1, E + 3, F + 2; on the boundary V + 1, E + 2, F + 1. edge_bisect, and in each
 * face beside the edge a diagonal from the new vertex w to the second corner after it: in a
 * triangle the opposite one.
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
 * Edge e and both faces keep the part with a, the origin of half-edge 2e. New edge and faces have
 * the old ones as parents; the diagonals have none. Left of 2e comes first.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_BAD_VALUE unless 0 < t < 1; HE_DOUBLED_EDGE
 * when c = d, since both diagonals would join it to w. HE_NO_MEMORY, HE_IDS_EXHAUSTED.
 * `out` may be NULL. */
HE_NODISCARD he_status he_edge_split(he_mesh *m, he_edge e, double t, he_split *out, he_error *err);

#endif
