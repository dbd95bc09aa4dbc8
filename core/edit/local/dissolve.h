/* dissolve.h - removes a vertex and merges the faces around it. */
#ifndef HE_EDIT_LOCAL_DISSOLVE_H
#define HE_EDIT_LOCAL_DISSOLVE_H

#include "mesh/mesh.h"

/* vertex_dissolve deletes an interior vertex with d edges and merges the faces around it: V - 1,
 * E - d, F - (d - 1).
 *
 *        o-----------o               o-----------o
 *        | \       / |               |           |
 *        |   \   /   |               |           |
 *        |     v     |      --->     |     f     |        f is the face of the half-edge that v
 *        |   /   \   |               |           |        stores; the others are merged into it.
 *        | /   f   \ |               |           |
 *        o-----------o               o-----------o
 *
 * This is the inverse of face_poke (poke.h). Corners keep their values; interpolated attributes of
 * f become the mean of the merged faces. The output `face` is f and may be NULL.
 *
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BOUNDARY_VERTEX if the vertex is on the boundary.
 * Returns HE_REPEATED_CORNER if the loop around the faces at v passes a vertex twice.
 * Returns HE_TOO_FEW_CORNERS if that loop has only two corners.
 * Returns HE_LOCKED_ELEMENT if v, or an edge or face at it, is locked.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_vertex_dissolve(he_mesh *m, he_vertex v, he_face *face, he_error *err);

#endif
