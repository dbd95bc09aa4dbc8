/* edge_extrude.h - boundary edges drawn out into walls. */
#ifndef HE_EDIT_BORDER_EDGE_EXTRUDE_H
#define HE_EDIT_BORDER_EDGE_EXTRUDE_H

#include "mesh/mesh.h"

/* What edge_extrude made. */
typedef struct he_walls {
    he_ids vertices; /* by rising vertex they come from */
    he_ids edges;    /* the far ones, as the edges were given */
    he_ids faces;    /* beside them */
} he_walls;

/* edge_extrude: for each chain of k edges V + k + 1, E + 2k + 1, F + k; a closed one V + k, E + 2k,
 * F + k. Each edge gets a quad on its open side, between it and a copy that lies at `by` from it.
 * Edges that follow each other along the boundary share corners.
 *
 *                                        v1----->v2----->v3     the far edges
 *                                        |       |       |
 *        o------>o------>o               |  new  |  new  |
 *        |       |       |      --->     o------>o------>o
 *        |   f   |   g   |               |       |       |
 *        o-------o-------o               |   f   |   g   |
 *                                        o-------o-------o
 *
 * New vertices descend from those beneath them and have their values, far edges from the edges.
 * A quad descends from the face beside its edge, with that face's values and the corners it has
 * there. Half-edge 2e of a far edge runs along its quad, that of a side leaves the old vertex. At
 * a bow-tie the chain of fans is rearranged where others lie in a gap that is closed (ring.h).
 *
 * Deleting the new faces is the inverse.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT;
 * HE_NOT_BOUNDARY; HE_BRANCHING_CHAIN at a bow-tie where more than one edge would come in, or go
 * out, along the boundary; HE_CLOSED_FAN where a fan would close beside another; HE_NOT_FINITE for
 * a position. HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL, else he_walls_clear frees it.
 * Costs the edges, and the fans at bow-ties. */
HE_NODISCARD he_status he_edge_extrude(he_mesh *m, const uint32_t *edges, size_t count, he_vec3 by,
                                       he_walls *out, he_error *err);
void he_walls_clear(he_walls *walls);

#endif
