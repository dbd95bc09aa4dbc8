/* face_add.h - adds a face over existing vertices. */
#ifndef HE_EDIT_LOCAL_FACE_ADD_H
#define HE_EDIT_LOCAL_FACE_ADD_H

#include "mesh/mesh.h"

/* face_add adds a face over existing vertices: V + 0, E + the number of missing edges, F + 1.
 *
 *        c       d                    c - - - d           The face runs counter-clockwise through
 *        |       |                    |       |           the vertices in the order given. A side
 *        |       |      a,b,d,c       |  new  |           that exists as an edge must be on the
 *        a-------b      --->          a-------b           boundary there, and becomes the side.
 *
 * If two sides of the face meet at a vertex v and both exist already, the face fills the gap
 * between two fans of v. If other fans lie in that gap, their links are moved to another gap first:
 *
 *        ring at v:  Y, Z.., X, W..   --->   Y + new + X, Z.., W..
 *
 * This works unless X and Y are one fan: the face would close it, which is allowed only if the
 * vertex has no other fan.
 *
 * The old elements keep their ids. `out` is the new face, whose stored half-edge leaves the first
 * vertex. The ids of new edges are appended to `edges`, in the order of the face. Both may be NULL.
 * Half-edge 2e of a new edge runs along the face.
 *
 * No pair of vertices can get a second edge: an existing edge between two neighbours of the list
 * becomes a side, or the edit is refused.
 * Returns HE_TOO_FEW_CORNERS if there are fewer than three vertices.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT or HE_REPEATED_CORNER if a vertex is not live or
 * is listed twice.
 * Returns HE_INTERIOR_VERTEX if a vertex has a closed fan.
 * Returns HE_NONMANIFOLD_EDGE if a side is an edge with two faces.
 * Returns HE_ORIENTATION if a side is an edge that already has a face on this side.
 * Returns HE_CLOSED_FAN if a fan would become closed at a vertex that has other fans.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_add(he_mesh *m, const uint32_t *vertices, size_t count, he_face *out,
                                   he_ids *edges, he_error *err);

#endif
