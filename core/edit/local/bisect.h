/* bisect.h - puts a vertex on an edge (edge_bisect), and removes it again (edge_join). */
#ifndef HE_EDIT_LOCAL_BISECT_H
#define HE_EDIT_LOCAL_BISECT_H

#include "mesh/write.h"

/* edge_bisect puts a vertex on an edge: V + 1, E + 1, F + 0. The new vertex w has degree 2; each
 * face beside the edge gets one more corner.
 *
 *           a           b                  a     w     b
 *           o-----------o       --->       o-----o-----o
 *               e  2e ->                      e    e'
 *
 * Edge e keeps the end with the origin a of half-edge 2e; the new edge e' runs w to b with its
 * half-edge 2e' in the direction of 2e, and has e as its parent. w lies at t from a (0) to b (1).
 * Corner values at w are between those of the same face at a and b.
 *
 * `vertex` is w, and `edge` is e'; each may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BAD_VALUE unless 0 < t < 1.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_bisect(he_mesh *m, he_edge e, double t, he_vertex *vertex,
                                      he_edge *edge, he_error *err);

/* edge_join is the inverse of edge_bisect: V - 1, E - 1, F + 0. A vertex v of degree 2 is deleted,
 * and so is the edge with the higher id at v; the other edge keeps its id and direction.
 *
 *           a     v     b                  a           b
 *           o-----o-----o       --->       o-----------o
 *              e    e'                           e
 *
 * The output `edge` is the edge that stays; it may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_WRONG_DEGREE if v has another degree.
 * Returns HE_TRIANGLE_SIDE if a face at v is a triangle.
 * Returns HE_DOUBLED_EDGE if an edge joins a and b already.
 * Returns HE_LOCKED_ELEMENT if v, an edge or a face at it is locked.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_join(he_mesh *m, he_vertex v, he_edge *edge, he_error *err);

/* These functions are the COMMIT part of edge_bisect, which writes and cannot fail, for edits that
 * do their own checks and reserve their own memory. he_bisect_reservation adds what
 * he_bisect_commit will write to `need`; he_bisect_commit puts a vertex on edge e and returns
 * half-edge 2e' of the new edge e'. */
void he_bisect_reservation(he_reservation *need);
he_halfedge he_bisect_commit(he_mesh *m, he_edge e, double t);

#endif
