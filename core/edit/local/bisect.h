/* bisect.h - a vertex put on an edge, and taken off again. */
#ifndef HE_EDIT_LOCAL_BISECT_H
#define HE_EDIT_LOCAL_BISECT_H

#include "mesh/write.h"

/* edge_bisect: V + 1, E + 1, F + 0. The new vertex w has degree 2; a face beside the edge gets one
 * corner more.
 *
 *           a           b                  a     w     b
 *           o-----------o       --->       o-----o-----o
 *               e  2e ->                      e    e'
 *
 * Edge e keeps the end with the origin a of half-edge 2e; the new edge e' runs w to b with its
 * half-edge 2e' in the direction of 2e, and has e as its parent. w lies at t from a (0) to b (1).
 * Corner values at w are between those of the same face at a and b.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_BAD_VALUE unless 0 < t < 1. HE_NO_MEMORY,
 * HE_IDS_EXHAUSTED. Outputs may be NULL. */
HE_NODISCARD he_status he_edge_bisect(he_mesh *m, he_edge e, double t, he_vertex *vertex,
                                      he_edge *edge, he_error *err);

/* edge_join: V - 1, E - 1, F + 0. The inverse: the vertex v of degree 2 goes, and so does the edge
 * of the higher id at v; the other keeps its id and direction.
 *
 *           a     v     b                  a           b
 *           o-----o-----o       --->       o-----------o
 *              e    e'                           e
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_WRONG_DEGREE for another degree;
 * HE_TRIANGLE_SIDE when a face at v is a triangle; HE_DOUBLED_EDGE when an edge joins a and b
 * already; HE_LOCKED_ELEMENT for v, an edge or a face at it. HE_NO_MEMORY. `edge` is the one that
 * stays, and may be NULL. */
HE_NODISCARD he_status he_edge_join(he_mesh *m, he_vertex v, he_edge *edge, he_error *err);

/* COMMIT of edge_bisect, for edits that check and reserve themselves. `need` grows by what it
 * writes. Returns the new half-edge 2e'. */
void he_bisect_need(he_need *need);
he_halfedge he_bisect_commit(he_mesh *m, he_edge e, double t);

#endif
