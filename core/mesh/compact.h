/* compact.h - the operation `compact`, which renumbers the elements of a mesh. No other operation
 * changes ids. */
#ifndef HE_MESH_COMPACT_H
#define HE_MESH_COMPACT_H

#include "mesh/mesh.h"

/* Maps the id of every element before he_compact to its new id, or to HE_NONE if the element was
 * deleted. Half-edge 2e + s becomes 2 * edge[e] + s. {0} is empty. */
typedef struct he_maps {
    uint32_t *vertex, *edge, *face;
    /* numbers of entries of the arrays `vertex`, `edge` and `face` */
    uint32_t vertices, edges, faces;
} he_maps;

void he_maps_clear(he_maps *maps);

/* Removes the array entries of deleted elements: live elements keep their order and get the ids 0,
 * 1, 2... Except for the ids, the mesh is unchanged; its memory shrinks to fit. The delta (the log
 * of the edit) says only that all data of the mesh were replaced. `maps` may be NULL; otherwise the
 * caller must clear it.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_compact(he_mesh *mesh, he_maps *maps, he_error *err);

#endif
