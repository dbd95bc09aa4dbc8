/* mesh.h - the half-edge mesh, and the manual of its structure.
 *
 * A mesh is a set of vertices, edges and polygonal faces with one orientation. Each edge is two
 * half-edges that run in opposite directions:
 *
 *                     target(h) = origin(twin(h))
 *              next(h)   o
 *                  \    ^|
 *                   \  h||            face(h) lies to the LEFT of h; a face's half-edges run
 *        face(h)     \  ||twin(h)     counter-clockwise about it. A half-edge without a face is
 *                     \ |v            a boundary half-edge: its next and prev run around the hole.
 *                        o
 *                     origin(h)
 *
 *     twin(h)  = h ^ 1          edge(h) = h >> 1          halfedges of edge e = 2e and 2e + 1
 *
 * Turning about a vertex counter-clockwise is h -> twin(prev(h)), clockwise is h -> next(twin(h)).
 * A fan is a maximal sequence of faces around a vertex in which each face shares an edge with the
 * next one. A vertex has one closed fan (interior), or any number of open fans (boundary; a bow-tie
 * when there are two or more), or none (isolated). At a bow-tie the links of the boundary
 * half-edges chain the open fans, so turning about the vertex visits every fan.
 *
 * INVARIANTS. he_check names them by these numbers.
 *   I1   next, prev, origin of a live half-edge name live elements; its face is live or HE_NONE.
 *   I2   prev(next(h)) = h and next(prev(h)) = h.
 *   I3   origin(next(h)) = target(h).
 *   I4   face(next(h)) = face(h).
 *   I5   an edge has at least one face.
 *   I6   face(halfedge(f)) = f, and the loop of halfedge(f) is every half-edge with face f.
 *   I7   a face has at least three corners, all at different vertices.
 *   I8   halfedge(v) leaves v, and is a boundary half-edge if any that leaves v is. It is
 *        HE_NONE exactly when no half-edge leaves v.
 *   I9   turning about v from halfedge(v) visits every half-edge that leaves v.
 *   I10  an edge joins two different vertices, and no other edge joins the same two.
 *   I11  positions are finite.
 *   I12  a deleted element has HE_DEAD in every link, the origin of coordinates as its position and
 *        default values as its attributes; the numbers of live elements are right.
 *   I13  materials have different names, which are not empty, and numbers in their ranges.
 *
 * IDS. The id of an element is its index in the arrays of the mesh, in which it has a row (one
 * entry in each array). A new element gets a row after the last one: this issues the next id. A row
 * never moves, and an id is never issued twice; a deleted element leaves a dead row. Only
 * he_compact renumbers elements. An id below `issued` is that of a live or deleted element; an id
 * of `issued` or more was never issued.
 *
 * ATTRIBUTES. Attributes are columns with one value for each element (column.h). Positions are
 * built in: three doubles for each vertex.
 *
 * MATERIALS. A mesh has a table of materials, which say how surfaces look; faces name them
 * (material.h).
 *
 * EDITS first check everything, then reserve all memory, then write, which cannot fail. Every write
 * goes through write.h, which records it in a delta (delta.h).
 *
 * A mesh has no lock: at any time one thread may write to it, or any number of threads may read
 * it. */
#ifndef HE_MESH_MESH_H
#define HE_MESH_MESH_H

#include "base/mem.h"
#include "base/progress.h"
#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Each kind of element has its own type of id, so that the compiler reports an error if an id of
 * one kind is used where another kind is expected. */
typedef struct he_vertex {
    uint32_t i;
} he_vertex;
typedef struct he_halfedge {
    uint32_t i;
} he_halfedge;
typedef struct he_edge {
    uint32_t i;
} he_edge;
typedef struct he_face {
    uint32_t i;
} he_face;

/* No element, such as the face of a boundary half-edge. */
#define HE_NONE UINT32_MAX
/* The value that all links of a deleted element have. */
#define HE_DEAD (UINT32_MAX - 1u)
/* The most elements of one kind: half-edge 2e + 1 of the last edge must have an id
 * below HE_DEAD. */
#define HE_MAX_ROWS (UINT32_MAX / 2u - 1u)

typedef struct he_vec3 {
    double x, y, z;
} he_vec3;

typedef struct he_mesh he_mesh;
typedef struct he_column he_column;
typedef struct he_materials he_materials;
typedef struct he_delta he_delta;

/* Returns an empty mesh, or NULL if memory is out. */
he_mesh *he_mesh_new(void);
void he_mesh_free(he_mesh *mesh);
/* Makes an independent copy of a mesh, with equal ids, deleted elements and attributes. Writes to
 * the copy are not recorded in a delta. */
HE_NODISCARD he_status he_mesh_copy(const he_mesh *mesh, he_mesh **out, he_error *err);
/* Copies a mesh like he_mesh_copy. Progress is reported to `progress`, which may be NULL and which
 * becomes the watch of the copy (he_mesh_set_progress). */
HE_NODISCARD he_status he_mesh_copy_with_progress(const he_mesh *mesh, he_progress *progress,
                                                  he_mesh **out, he_error *err);
/* Returns true if two meshes are equal in every element and attribute value, deleted elements
 * included, and have issued equally many ids of each kind. */
bool he_mesh_equal(const he_mesh *a, const he_mesh *b);
/* Compares two meshes like he_mesh_equal, but ignores deleted elements whose ids only one of the
 * meshes has issued. */
bool he_mesh_equal_live(const he_mesh *a, const he_mesh *b);

/* Makes all long work with this mesh report its progress to the watch `progress` (progress.h). The
 * watch may cancel the work, which then fails with HE_CANCELLED. NULL removes the watch. No other
 * thread may use the mesh during this call, and the watch must exist until it is removed. */
void he_mesh_set_progress(he_mesh *mesh, he_progress *progress);
/* Declares that the mesh is a private copy which its owner frees as soon as an edit is cancelled.
 * After this call a cancelled edit leaves the mesh half edited, because a rollback would take about
 * as long as the edit did. Any other failure leaves the mesh as it was. */
void he_mesh_expend(he_mesh *mesh);

/* Returns the bytes of memory that a mesh takes, spare capacity included. */
size_t he_mesh_bytes(const he_mesh *mesh);

/* These functions return the numbers of live elements. There are twice as many half-edges as
 * edges. */
uint32_t he_mesh_vertices(const he_mesh *mesh);
uint32_t he_mesh_edges(const he_mesh *mesh);
uint32_t he_mesh_faces(const he_mesh *mesh);
uint32_t he_mesh_boundary_halfedges(const he_mesh *mesh);
uint32_t he_mesh_count(const he_mesh *mesh, he_kind kind);
/* Returns how many ids of elements of a kind were ever issued, deleted elements included. */
uint32_t he_mesh_issued(const he_mesh *mesh, he_kind kind);
bool he_mesh_is_live(const he_mesh *mesh, he_kind kind, uint32_t id);
/* Returns the id of the first live element of a kind at or after the id `from`; HE_NONE if there is
 * none. */
uint32_t he_mesh_next_live(const he_mesh *mesh, he_kind kind, uint64_t from);
/* Returns HE_OK if the element is live; otherwise the message in `err` names the element.
 * Returns HE_NO_SUCH_ELEMENT if the id was never issued.
 * Returns HE_DELETED_ELEMENT if the element was deleted. */
HE_NODISCARD he_status he_mesh_require(const he_mesh *mesh, he_kind kind, uint32_t id,
                                       he_error *err);

/* These functions give access to the attribute columns, in the order in which they were added.
 * he_mesh_find_column returns NULL if no column has that domain and name. */
size_t he_mesh_columns(const he_mesh *mesh);
/* Returns the attribute column in slot (array entry) i; NULL if the column was dropped. */
const he_column *he_mesh_column(const he_mesh *mesh, size_t i);
const he_column *he_mesh_find_column(const he_mesh *mesh, he_kind domain, const char *name);
/* Describes the positions of the vertices as a column named "position", of three doubles for each
 * issued id. The rows are the mesh's own memory; nothing may be written or freed through *out. */
void he_mesh_position_column(const he_mesh *mesh, he_column *out);
/* Returns the index of the slot in which the mesh holds an attribute column. */
size_t he_mesh_column_slot(const he_mesh *mesh, const he_column *column);
/* Returns the mesh's table of materials, which is valid until a material is added or removed. */
const he_materials *he_mesh_materials(const he_mesh *mesh);

#endif
