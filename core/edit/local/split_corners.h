/* split_corners.h - splits a vertex between two of its corners. */
#ifndef HE_EDIT_LOCAL_SPLIT_CORNERS_H
#define HE_EDIT_LOCAL_SPLIT_CORNERS_H

#include "mesh/mesh.h"

/* vertex_split_corners: V + 1, E + 1, F + 0. a and b are different half-edges that leave v.
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
 * The new edge lies between the two corners that separate them: that of the face of twin(a), which
 * is clockwise before a, and that of twin(b). One of them may be the corner of a hole. Each face of
 * the two gets one more corner. u lies where v does; half-edge 2e runs from u to v, so that
 * edge_collapse of it is the inverse. At a bow-tie whole fans may go to u too, in the order in
 * which turning about v visits them.
 *
 * u descends from v, the edge has no parent; u and the new corners have the values of v and of the
 * corner that each was part of. Outputs may be NULL.
 *
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_SAME_CORNER if a is b.
 * Returns HE_DIFFERENT_ORIGINS if a and b leave different vertices.
 * Returns HE_NO_FACE if both corners belong to holes.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_split_corners(he_mesh *m, he_halfedge a, he_halfedge b,
                                               he_vertex *vertex, he_edge *edge, he_error *err);

#endif
