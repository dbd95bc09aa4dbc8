/* dual.h - faces and vertices change roles. */
#ifndef HE_EDIT_WHOLE_DUAL_H
#define HE_EDIT_WHOLE_DUAL_H

#include "mesh/mesh.h"

/* dual of a closed mesh: V becomes F, E stays E, F becomes V, as counts. Every face becomes a
 * vertex at the mean of its corners, every vertex a face about it, and every edge the edge that
 * crosses it.
 *
 *         o-------o-------o                o-------o-------o
 *         |       |       |                | .-----|-----. |
 *         |   f   |   g   |                | |f*   |   g*| |
 *         |       ^       |                | |     |     | |
 *         o-------o-------o      --->      o-|-----o-----|-o
 *         |       v       |                | |     v*    | |
 *         |   i   |   h   |                | |i*   |   h*| |
 *         |       |       |                | '-----|-----' |
 *         o-------o-------o                o-------o-------o
 *
 * All ids are fresh, in the order of those they stand for, and the old elements are deleted. Half-
 * edge 2e of a new edge runs to the face that was left of half-edge 2e of the old one, which is its
 * parent; edges take their values by rule, everything else has the defaults. The dual of the dual
 * has the links of the mesh.
 *
 * Refused: HE_BOUNDARY_EDGE unless closed; HE_ISOLATED_VERTEX; HE_TOO_FEW_CORNERS for a vertex
 * under degree 3; HE_DOUBLED_EDGE naming a second edge between two faces; HE_LOCKED_ELEMENT for
 * anything locked. HE_NO_MEMORY, HE_IDS_EXHAUSTED,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_dual(he_mesh *m, he_error *err);

#endif
