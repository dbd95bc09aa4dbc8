/* bisect.h - inserts a vertex into an edge (edge_bisect), and removes such a vertex (edge_join). */
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
 * Edge e keeps the end a, which is the origin of half-edge 2e. The new edge e' joins w and b; its
 * half-edge 2e' has the direction of half-edge 2e, and its parent is e. Vertex w lies at the
 * fraction t of the way from a to b. In each face, corner values at w are interpolated between the
 * corners at a and b.
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

/* Edits that consist of several steps use these functions after their own checks.
 * he_bisect_reservation adds to `need` the memory for one bisection. he_bisect_commit inserts a
 * vertex into edge e and returns half-edge 2e' of the new edge e'; it cannot fail. */
void he_bisect_reservation(he_reservation *need);
he_halfedge he_bisect_commit(he_mesh *m, he_edge e, double t);

#endif
