/* dissolve.h - a vertex taken out of the middle of its faces. */
#ifndef HE_EDIT_LOCAL_DISSOLVE_H
#define HE_EDIT_LOCAL_DISSOLVE_H

#include "mesh/mesh.h"

/* vertex_dissolve: V - 1, E - d, F - (d - 1) for an interior vertex with d edges.
 *
 *        o-----------o               o-----------o
 *        | \       / |               |           |
 *        |   \   /   |               |           |
 *        |     v     |      --->     |     f     |        f is the face of the half-edge that v
 *        |   /   \   |               |           |        stores; the others become part of it.
 *        | /   f   \ |               |           |
 *        o-----------o               o-----------o
 *
 * The inverse of face_poke. Corners keep their values; what is interpolated becomes the mean of the
 * faces. `face` is f and may be NULL.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_BOUNDARY_VERTEX; HE_REPEATED_CORNER when the
 * ring of the faces about v passes a vertex twice, HE_TOO_FEW_CORNERS when it has only two;
 * HE_LOCKED_ELEMENT for v, or an edge or face about it. HE_NO_MEMORY. */
HE_NODISCARD he_status he_vertex_dissolve(he_mesh *m, he_vertex v, he_face *face, he_error *err);

#endif
