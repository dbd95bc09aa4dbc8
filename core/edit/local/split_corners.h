/* split_corners.h - splits a vertex between two of its corners. */
#ifndef HE_EDIT_LOCAL_SPLIT_CORNERS_H
#define HE_EDIT_LOCAL_SPLIT_CORNERS_H

#include "mesh/mesh.h"

/* vertex_split_corners splits a vertex v into an edge between two of its corners: V + 1, E + 1,
 * F + 0. a and b are different half-edges that leave v.
 *
 *          g                             g
 *      o       o b                   o       o b
 *        \   /                         \   /
 *          v--------o      --->          v--------o        b, and what follows it up to a, stays
 *        / | \                           |                 with v; a, and what follows it up to
 *      o   |   o                         u                 b, counter-clockwise, goes to u.
 *        a o                           / | \
 *          f                         o   |   o
 *                                      a o
 *
 * The new edge lies in the two corners that separate the half-edges of u from those of v: the
 * corner clockwise before a, in the face of twin(a), and the corner clockwise before b, in the face
 * of twin(b). One of these corners may belong to a hole. Each of the two faces gets one more
 * corner. The new vertex u lies at the position of v. Half-edge 2e of the new edge e runs from u to
 * v, so edge_collapse of this half-edge is the inverse. If v is a bow-tie, whole fans may move to
 * u.
 *
 * Vertex u descends from v and has the values of v; the new edge has no parent. Each new corner has
 * the values of the corner in which the new edge lies. The outputs are u and the new edge; each may
 * be NULL.
 *
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_SAME_CORNER if a and b are equal.
 * Returns HE_DIFFERENT_ORIGINS if a and b leave different vertices.
 * Returns HE_NO_FACE if both corners belong to holes.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_split_corners(he_mesh *m, he_halfedge a, he_halfedge b,
                                               he_vertex *vertex, he_edge *edge, he_error *err);

#endif
