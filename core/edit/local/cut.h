/* cut.h - splits a face by a diagonal (face_split), and joins two faces over an edge
 * (face_join). */
#ifndef HE_EDIT_LOCAL_CUT_H
#define HE_EDIT_LOCAL_CUT_H

#include "mesh/write.h"

/* face_split splits face f by a diagonal: V + 0, E + 1, F + 1. `from` and `to` are half-edges of f;
 * the diagonal joins the corners they leave.
 *
 *              <----- o to                         o to
 *            /        ^ \                        / ^\
 *           o     f   .  o                      o  | o
 *            \        .  ^                   f  \  | | f'      half-edge 2e of the diagonal runs
 *              \      . /  .                     \ | /         from -> to
 *                from o                       from o
 *
 * The part to the left of from -> to keeps the id and the values of f. The other part f' is new,
 * descends from f and contains half-edge `from`. At each end of the diagonal, the new corner copies
 * the values of the old corner.
 *
 * `edge` is the diagonal, and `face` is f'; each may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if the face or a half-edge is not live.
 * Returns HE_NOT_A_CORNER if a half-edge belongs to a face other than f.
 * Returns HE_SAME_CORNER if `from` and `to` are equal.
 * Returns HE_ADJACENT_CORNERS if the corners are neighbours.
 * Returns HE_DOUBLED_EDGE if an edge elsewhere joins the two vertices.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_split(he_mesh *m, he_face f, he_halfedge from, he_halfedge to,
                                     he_edge *edge, he_face *face, he_error *err);

/* Returns the half-edge that leaves vertex v inside face f, both live; HE_NONE if v is no corner of
 * f. */
he_halfedge he_face_corner(const he_mesh *m, he_face f, he_vertex v);

/* face_join is the inverse of face_split: V + 0, E - 1, F - 1. Edge e is deleted, and the face of
 * half-edge 2e + 1 is merged into f, the face of half-edge 2e. Interpolated attributes of f become
 * the mean of the two faces' values.
 *
 *           o-------o-------o             o-------o-------o
 *           |       ^       |             |               |
 *           |   f 2e| f'    |    --->     |       f       |
 *           |       |       |             |               |
 *           o-------o-------o             o-------o-------o
 *
 * The output `face` is f and may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BOUNDARY_EDGE if the edge is on the boundary.
 * Returns HE_SHARED_BOUNDARY if the faces have a vertex in common besides the ends of the edge,
 * which f would pass twice.
 * Returns HE_LOCKED_ELEMENT if the edge or one of the faces is locked.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_face_join(he_mesh *m, he_edge e, he_face *face, he_error *err);

/* Edits that consist of several steps use these functions after their own checks.
 * he_cut_reservation adds to `need` the memory for cutting off a face of `corners` corners.
 * he_cut_commit makes the diagonal and returns its half-edge 2e; the new face is on the side of the
 * twin. It cannot fail. */
void he_cut_reservation(uint32_t corners, he_reservation *need);
he_halfedge he_cut_commit(he_mesh *m, he_halfedge from, he_halfedge to);

#endif
