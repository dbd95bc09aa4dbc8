/* vertex_bevel.h - a corner of a solid cut off. */
#ifndef HE_EDIT_BEVEL_VERTEX_BEVEL_H
#define HE_EDIT_BEVEL_VERTEX_BEVEL_H

#include "mesh/mesh.h"

/* vertex_bevel: V + (d - 1), E + d, F + 1 for an interior vertex with d edges.
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
 * Every edge at v is cut at `width` from there, though never beyond 0.99 of its length, and
 * half-way where that is 0 (bevel.h): so the cuts do not pass the other ends. Edges and faces keep
 * their ids; each face has a corner more. Attributes of vertices and corners are taken along the
 * edges. The half-edge of the new face n leaves v, and half-edges 2e of the new edges run along it.
 *
 * New vertices and edges are appended to `vertices` and `edges`, counter-clockwise from v's stored
 * half-edge on; they and `face` may be NULL. Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT;
 * HE_BAD_VALUE unless width > 0; HE_BOUNDARY_VERTEX; HE_LOW_DEGREE for d < 3; HE_LOCKED_ELEMENT for
 * v, or an edge or face about it. HE_NO_MEMORY, HE_IDS_EXHAUSTED. */
HE_NODISCARD he_status he_vertex_bevel(he_mesh *m, he_vertex v, double width, he_ids *vertices,
                                       he_ids *edges, he_face *face, he_error *err);

#endif
