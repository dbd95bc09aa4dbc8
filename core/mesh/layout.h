/* layout.h - the fields behind mesh.h. Only core/ includes this: to read, use walk.h; to write,
 * write.h. */
#ifndef HE_MESH_LAYOUT_H
#define HE_MESH_LAYOUT_H

#include "mesh/column.h"
#include "mesh/material.h"
#include "mesh/mesh.h"

/* One table of rows. `issued` only grows, except in he_compact and where nothing was published. */
typedef struct he_rows {
    uint32_t issued, live, capacity;
} he_rows;

/* Parallel arrays beat records 1.5 to 2.8 times in traversal. A half-edge's links sit in four of
 * them, indexed by half-edge: 2 * edges.capacity entries each. */
typedef struct he_content {
    he_rows vertices, edges, faces;
    uint32_t boundary_halfedges;
    he_vec3 *position;
    uint32_t *vertex_halfedge;
    uint32_t *next, *prev, *origin, *face;
    uint32_t *face_halfedge;
    he_column **columns; /* slots; NULL where a column was dropped */
    size_t column_count, column_capacity;
    he_materials materials;
} he_content;

/* Rows issued in an attribute's domain. */
size_t he_content_issued(const he_content *content, he_kind domain);

struct he_mesh {
    he_content c;
    he_delta *delta;      /* where writes are recorded, or NULL */
    he_watch *watch;      /* who is told of long work, or NULL */
    bool expendable;      /* see he_mesh_expend */
    struct he_kept *kept; /* of a mesh that stays as it is: see long_faces.h. Else NULL */
};

#endif
