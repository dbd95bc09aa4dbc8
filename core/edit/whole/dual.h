/* dual.h - exchanges the roles of faces and vertices. */
#ifndef HE_EDIT_WHOLE_DUAL_H
#define HE_EDIT_WHOLE_DUAL_H

#include "mesh/mesh.h"

/* dual exchanges faces and vertices of a closed mesh: V becomes F, E stays E, F becomes V. Every
 * face becomes a vertex at the mean of its corners, and every vertex a face:
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
 * All ids are new: new elements are made in the order of the old elements that they replace, and
 * the old elements are deleted. The parent of a new edge is the old edge that it crosses. Half-edge
 * 2e of the new edge ends at the vertex that replaces the face left of half-edge 2e of the old
 * edge. The values of edges follow the rules of their attributes; all other attributes have their
 * defaults. The dual of the dual has the links of the original mesh.
 *
 * Returns HE_BOUNDARY_EDGE unless the mesh is closed.
 * Returns HE_ISOLATED_VERTEX if a vertex is isolated.
 * Returns HE_TOO_FEW_CORNERS if a vertex has degree 2.
 * Returns HE_DOUBLED_EDGE naming an edge, if two faces share a second edge.
 * Returns HE_LOCKED_ELEMENT if any element is locked.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_dual(he_mesh *m, he_error *err);

#endif
