/* collapse.h - collapses an edge to one vertex. */
#ifndef HE_EDIT_LOCAL_COLLAPSE_H
#define HE_EDIT_LOCAL_COLLAPSE_H

#include "mesh/mesh.h"

/* edge_collapse collapses the edge of half-edge h, u -> v: u is deleted, v stays; V - 1 and,
 * depending on the faces beside the edge,
 *
 *     two triangles              E - 3, F - 2     triangle and boundary   E - 2, F - 1
 *     triangle and polygon       E - 2, F - 1     otherwise               E - 1, F + 0
 *
 *              c                             c
 *              o                             o
 *            / | \                           |
 *       ...o   |   o...                ...o  |  o...
 *            \ | /                         \ | /
 *         u o--h-->o v      --->             o v
 *            / | \                         / | \
 *       ...o   |   o...                ...o  |  o...
 *            \ | /                           |
 *              o                             o
 *              d                             d
 *
 * A triangle u, v, c beside the edge is deleted, and its sides u-c and v-c become one edge: the
 * side at v stays, and the side at u is merged into it. A face beside the edge with more than three
 * corners loses the corner u. All other edges and faces at u move to v.
 *
 * Vertex v moves to `to`. If `to` is NULL, v moves to the point at the fraction t of the way from u
 * to v. Interpolated attributes of v are taken at t, or half-way between u and v if `to` is not
 * NULL. An edge into which another is merged gets the mean of the values of the two edges.
 *
 * The link condition (Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving edge contraction",
 * 1999), for polygons and boundaries:
 *
 * L1 The only common neighbours of u and v are the opposite corners of the triangles beside the
 * edge, and these corners differ.
 *     L2  If both ends are on the boundary, so is the edge.
 *     L3  The two other sides of a triangle beside the edge are not both on the boundary.
 *     L4  No face except those beside the edge has both u and v as corners.
 *     L5  The edge is not one of a tetrahedron.
 *
 * If L1 to L5 hold, no two edges join one pair of vertices afterwards (L1, L3), and no vertex gets
 * a closed fan beside another fan. The reason: an interior edge has an interior end (L2). The only
 * fan of this end is opened at the edge and inserted into a fan of the opposite end. At a boundary
 * edge, two open fans are joined end to end, and their outer ends stay apart (L3).
 *
 * The output `vertex` is v and may be NULL. Takes at most time linear in the half-edges of the
 * mesh, and constant time if degrees are bounded.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_LINK_CONDITION if one of L1 to L5 does not hold; the message names which.
 * Returns HE_BAD_VALUE unless 0 <= t <= 1.
 * Returns HE_NOT_FINITE if `to` is not finite.
 * Returns HE_LOCKED_ELEMENT or HE_FEATURE_EDGE if the rules of marks.h forbid the collapse.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_collapse(he_mesh *m, he_halfedge h, double t, const he_vec3 *to,
                                        he_vertex *vertex, he_error *err);

/* Collapses like he_edge_collapse, but takes both a position and a parameter: the target of h moves
 * to `to`, and its attributes are interpolated at t from the origin of h (0) to the target (1). */
HE_NODISCARD he_status he_edge_collapse_at(he_mesh *m, he_halfedge h, double t, he_vec3 to,
                                           he_error *err);

#endif
