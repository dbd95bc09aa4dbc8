/* layout.h - the members of he_mesh, which mesh.h does not show. Only core/ includes this header.
 * Code that reads a mesh uses walk.h; code that writes to a mesh uses write.h. */
#ifndef HE_MESH_LAYOUT_H
#define HE_MESH_LAYOUT_H

#include "mesh/column.h"
#include "mesh/material.h"
#include "mesh/mesh.h"

/* How many elements of one kind there are: `issued` is the number of ids ever issued, `live` the
 * number of elements that are not deleted, and `capacity` the number of elements for which the
 * arrays have room. `issued` only grows, except in he_compact and when an edit that was never
 * published is rolled back. */
typedef struct he_rows {
    uint32_t issued, live, capacity;
} he_rows;

/* The content of a mesh: all its data. The data are in parallel arrays, because traversal is then
 * 1.5 to 2.8 times as fast as with an array of structs. The links of half-edges are in the four
 * arrays `next`, `prev`, `origin` and `face` of 2 * edges.capacity entries each. */
typedef struct he_content {
    he_rows vertices, edges, faces;
    uint32_t boundary_halfedges;
    he_vec3 *position;
    uint32_t *vertex_halfedge;
    uint32_t *next, *prev, *origin, *face;
    uint32_t *face_halfedge;
    he_column **columns; /* the attribute columns; the entry of a column that was dropped is NULL */
    size_t column_count, column_capacity;
    he_materials materials;
} he_content;

/* Returns how many ids are issued in the domain of an attribute (for the mesh itself, 1). */
size_t he_content_issued(const he_content *content, he_kind domain);

struct he_mesh {
    he_content c;
    /* the delta in which all writes are recorded; NULL if writes are not recorded */
    he_delta *delta;
    he_progress *progress; /* receives the progress of long work and may cancel it; may be NULL */
    bool expendable;       /* see he_mesh_expend */
    /* The cache of long faces of a mesh that is never edited (long_faces.h); NULL if the mesh has
     * none. */
    struct he_kept *kept;
};

#endif
