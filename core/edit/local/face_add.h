/* face_add.h - a face over vertices that are there. */
#ifndef HE_EDIT_LOCAL_FACE_ADD_H
#define HE_EDIT_LOCAL_FACE_ADD_H

#include "mesh/mesh.h"

/* face_add: V + 0, E + the edges that were missing, F + 1.
 *
 *        c       d                    c - - - d           The face runs counter-clockwise through
 *        |       |                    |       |           the vertices in the order given. Edges
 *        |       |      a,b,d,c       |  new  |           it needs that are there must be on the
 *        a-------b      --->          a-------b           boundary on its side and are adopted.
 *
 * Where two of its sides meet at a vertex v and both are there, the face fills the gap between two
 * fans. When other fans lie in that gap their links are moved to another gap first:
 *
 *        ring at v:  Y, Z.., X, W..   --->   Y + new + X, Z.., W..
 *
 * which always works unless X and Y are one fan: then it would close, and that is allowed only
 * when the vertex has no other.
 *
 * The old elements keep their ids. `out` is the face, whose half-edge leaves the first vertex; the
 * ids of new edges are appended to `edges`, in the face's order. Both may be NULL. Half-edge 2e of
 * a new edge runs along the face.
 *
 * Refused: HE_TOO_FEW_CORNERS; HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_CORNER for a
 * vertex; HE_INTERIOR_VERTEX for one with a closed fan; HE_NONMANIFOLD_EDGE for an edge with two
 * faces, HE_ORIENTATION for one with a face on this side; HE_CLOSED_FAN at a vertex as above.
 * A doubled edge cannot come about: an edge that joins two neighbours is adopted or refused.
 * HE_NO_MEMORY, HE_IDS_EXHAUSTED. */
HE_NODISCARD he_status he_face_add(he_mesh *m, const uint32_t *vertices, size_t count, he_face *out,
                                   he_ids *edges, he_error *err);

#endif
