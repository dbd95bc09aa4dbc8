/* cut.h - a face cut in two by a diagonal, and two faces joined over an edge. */
#ifndef HE_EDIT_LOCAL_CUT_H
#define HE_EDIT_LOCAL_CUT_H

#include "mesh/write.h"

/* face_split: V + 0, E + 1, F + 1. `from` and `to` are half-edges of f; the diagonal joins the
 * corners they leave.
 *
 *              <----- o to                         o to
 *            /        ^ \                        / ^\
 *           o     f   .  o                      o  | o
 *            \        .  ^                   f  \  | | f'      half-edge 2e of the diagonal runs
 *              \      . /  .                     \ | /         from -> to
 *                from o                       from o
 *
 * The part to the left of from -> to keeps the id of f and its values; the other is new, descends
 * from f and has the half-edge `from`. The new corners copy those they were cut from.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT for face or half-edge; HE_NOT_A_CORNER for a
 * half-edge of another face; HE_SAME_CORNER; HE_ADJACENT_CORNERS; HE_DOUBLED_EDGE when an edge
 * elsewhere joins the two vertices. HE_NO_MEMORY, HE_IDS_EXHAUSTED. Outputs may be NULL. */
HE_NODISCARD he_status he_face_split(he_mesh *m, he_face f, he_halfedge from, he_halfedge to,
                                     he_edge *edge, he_face *face, he_error *err);

/* The half-edge that leaves vertex v inside face f, both live: HE_NONE when v is no corner of f. */
he_halfedge he_face_corner(const he_mesh *m, he_face f, he_vertex v);

/* face_join: V + 0, E - 1, F - 1. The inverse: the edge goes, and the face of its half-edge 2e
 * grows over the other one, which becomes part of it. Interpolated attributes of f become the mean
 * of both.
 *
 *           o-------o-------o             o-------o-------o
 *           |       ^       |             |               |
 *           |   f 2e| f'    |    --->     |       f       |
 *           |       |       |             |               |
 *           o-------o-------o             o-------o-------o
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_BOUNDARY_EDGE; HE_SHARED_BOUNDARY when the
 * faces have another corner in common, at which f would pass twice; HE_LOCKED_ELEMENT for the edge
 * or one of the faces. HE_NO_MEMORY. `face` is f and may be NULL. */
HE_NODISCARD he_status he_face_join(he_mesh *m, he_edge e, he_face *face, he_error *err);

/* COMMIT of face_split, for edits that check and reserve themselves. `need` grows by what cutting
 * off a face of `corners` corners writes. Returns half-edge 2e of the diagonal; the new face is
 * that of its twin. */
void he_cut_need(uint32_t corners, he_need *need);
he_halfedge he_cut_commit(he_mesh *m, he_halfedge from, he_halfedge to);

#endif
