/* compact.h - the one operation that renumbers. */
#ifndef HE_MESH_COMPACT_H
#define HE_MESH_COMPACT_H

#include "mesh/mesh.h"

/* old id -> new id for every id issued before, HE_NONE for those that were dead. Half-edge
 * 2e + s becomes 2 * edge[e] + s. {0} is empty. */
typedef struct he_maps {
    uint32_t *vertex, *edge, *face;
    uint32_t vertices, edges, faces; /* entries in each */
} he_maps;

void he_maps_clear(he_maps *maps);

/* Drop the dead rows: live elements keep their order and take the ids 0, 1, 2... Counts, links and
 * attributes are otherwise unchanged; memory shrinks to fit. Recorded as one replace. `maps` may be
 * NULL, else it is the caller's to clear. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_compact(he_mesh *mesh, he_maps *maps, he_error *err);

#endif
