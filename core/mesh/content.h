/* content.h - copies, grows and replays a content, which is the struct of all arrays of a mesh
 * (he_content). Only core/mesh and core/stored use this header. */
#ifndef HE_MESH_CONTENT_H
#define HE_MESH_CONTENT_H

#include "mesh/layout.h"

/* frees all arrays of a mesh, but not `content` itself */
void he_content_clear(he_content *content);
/* Copies all arrays of a mesh. Fills *out on success only. `progress` may be NULL. */
HE_NODISCARD he_status he_content_copy(const he_content *content, he_progress *progress,
                                       he_content *out, he_error *err);
size_t he_content_bytes(const he_content *content);
/* Returns the size in bytes of the array entries of all ids ever issued, without spare memory. */
size_t he_content_rows_bytes(const he_content *content);

/* Each function enlarges the arrays of links and positions of one kind of element until they have
 * room for `rows` elements in all. Attribute columns are not enlarged. */
HE_NODISCARD he_status he_content_reserve_vertices(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_edges(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_faces(he_content *c, size_t rows, he_error *err);

/* Returns the member `vertices`, `edges` or `faces` of the content, which counts the elements of a
 * kind; NULL for HE_MESH_KIND. HE_HALFEDGE gets `edges`, because half-edges are stored in pairs,
 * one pair for each edge. */
he_rows *he_content_rows(he_content *content, he_kind kind);

/* Exchanges the positions of the first vertices with the rows of `other`, a column of
 * he_position_schema with at most as many rows as ids of vertices are issued. */
void he_content_exchange_positions(he_content *c, he_column *other);
/* Applies some records of a delta (the log of an edit) to the arrays of a mesh. If `from` <= `to`,
 * the records `from` to `to` - 1 are applied forwards. If `from` > `to`, the records `from` - 1
 * down to `to` are applied backwards. Records that name a column, a material or a whole content
 * exchange it with an entry of the array `objects`, which has the order of delta->objects;
 * `objects` is NULL if the delta has no objects. */
void he_content_apply(he_content *c, const he_delta *delta, size_t from, size_t to, void **objects);
/* Applies a whole delta (the log of an edit) forwards to the arrays of a mesh in which the ids of
 * the edit's new elements may not be issued yet. Afterwards as many ids of each kind are issued as
 * `issued` says. On failure the arrays are as they were.
 * Returns HE_CORRUPT if a record's `before` differs from the value in the mesh; *refused, if
 * `refused` is not NULL, is then the index of that record.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_content_forward(he_content *c, const he_delta *delta, void **objects,
                                          const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                          he_error *err);
/* Issues ids of deleted elements until as many ids of each kind are issued as `issued` says.
 * Returns HE_NO_MEMORY if memory is out; some of the ids may then be issued. */
HE_NODISCARD he_status he_content_issue(he_content *c, const uint32_t issued[HE_KIND_COUNT],
                                        he_error *err);
/* Withdraws the last ids of each kind, so that only as many stay issued as `issued` says. The
 * elements with these ids must be deleted, or made by an edit that is rolled back. */
void he_content_withdraw(he_content *c, const uint32_t issued[HE_KIND_COUNT]);

#endif
