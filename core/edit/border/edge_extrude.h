/* edge_extrude.h - extrudes boundary edges into walls. */
#ifndef HE_EDIT_BORDER_EDGE_EXTRUDE_H
#define HE_EDIT_BORDER_EDGE_EXTRUDE_H

#include "mesh/mesh.h"

/* The elements that edge_extrude made. */
typedef struct he_walls {
    he_ids vertices; /* the new vertices, in the order of the vertices they descend from */
    he_ids edges;    /* the far edges (shifted copies), in the order of the given edges */
    he_ids faces;    /* the quads, in the order of the given edges */
} he_walls;

/* edge_extrude extrudes boundary edges into walls: V + k + 1, E + 2k + 1, F + k for each chain of k
 * edges that follow each other along the boundary; V + k, E + 2k, F + k for a closed chain. Each
 * edge gets a quad on the side where it has no face, between the edge and a copy of the edge that
 * is shifted by the vector `by`. Neighbouring quads of a chain share a side.
 *
 *                                        v1----->v2----->v3     the far edges
 *                                        |       |       |
 *        o------>o------>o               |  new  |  new  |
 *        |       |       |      --->     o------>o------>o
 *        |   f   |   g   |               |       |       |
 *        o-------o-------o               |   f   |   g   |
 *                                        o-------o-------o
 *
 * A new vertex descends from the vertex that it copies and has the values of that vertex; a far
 * edge descends from the given edge that it copies. A quad descends from the face of the given
 * edge, and has the values of that face and of the corners at that edge. Half-edge 2e of a far edge
 * runs along its quad. Half-edge 2e of a new edge between an old vertex and its copy leaves the old
 * vertex. At a bow-tie the order of the fans changes if the new faces close a gap in which other
 * fans lie (ring.h).
 *
 * Deleting the new faces is the inverse.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_walls_clear frees it.
 * Takes time linear in the number of edges, plus the fans at bow-ties.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_NOT_BOUNDARY if an element is not on the boundary.
 * Returns HE_BRANCHING_CHAIN if more than one of the edges arrives at a bow-tie along the boundary,
 * or more than one leaves it.
 * Returns HE_CLOSED_FAN if a vertex that has other fans would get a closed fan.
 * Returns HE_NOT_FINITE if a position is not finite.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_extrude(he_mesh *m, const uint32_t *edges, size_t count, he_vec3 by,
                                       he_walls *out, he_error *err);
void he_walls_clear(he_walls *walls);

#endif
