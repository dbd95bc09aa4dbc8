/* vertex_bevel.h - bevels a vertex: cuts a corner of a solid off. */
#ifndef HE_EDIT_BEVEL_VERTEX_BEVEL_H
#define HE_EDIT_BEVEL_VERTEX_BEVEL_H

#include "mesh/mesh.h"

/* vertex_bevel cuts off the corner at an interior vertex v with d edges: V + (d - 1), E + d, F + 1.
 *
 *              o                              o
 *              |                              |
 *              |                              w
 *              |                            /   \
 *              v            --->           /  n  \            v is where its stored half-edge was
 *            /   \                        w-------v           cut; the others are new and descend
 *          /       \                    /           \         from it.
 *        o           o                o               o
 *
 * Every edge at v is cut at the distance `width` from v, but at most at 0.99 of its length, so no
 * cut reaches the far end. An edge of length 0 is cut half-way (bevel.h). Edges and faces keep
 * their ids; each face gets one more corner. Attributes of vertices and corners are interpolated
 * along the edges. The half-edge that the new face n stores leaves v, and half-edges 2e of the new
 * edges run along n.
 *
 * The ids of new vertices and edges are appended to `vertices` and `edges`, counter-clockwise from
 * v's stored half-edge on. Each output may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BAD_VALUE unless width > 0.
 * Returns HE_BOUNDARY_VERTEX if the vertex is on the boundary.
 * Returns HE_LOW_DEGREE if d < 3.
 * Returns HE_LOCKED_ELEMENT if v, or an edge or face at it, is locked.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_bevel(he_mesh *m, he_vertex v, double width, he_ids *vertices,
                                       he_ids *edges, he_face *face, he_error *err);

#endif
