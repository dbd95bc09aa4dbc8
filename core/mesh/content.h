/* content.h - copies, grows and replays the content of a mesh, which is the struct of all its
 * arrays (he_content); only core/mesh and core/stored use it. */
#ifndef HE_MESH_CONTENT_H
#define HE_MESH_CONTENT_H

#include "mesh/layout.h"

void he_content_clear(he_content *content); /* frees everything in a content */
/* Makes a copy of a content. Fills *out on success only. `progress` may be NULL. */
HE_NODISCARD he_status he_content_copy(const he_content *content, he_progress *progress,
                                       he_content *out, he_error *err);
size_t he_content_bytes(const he_content *content);
/* Returns the size in bytes of all issued rows of a content's arrays, without spare capacity. */
size_t he_content_rows_bytes(const he_content *content);

/* Each function enlarges the arrays of links and positions of one kind of element until `rows`
 * elements fit in all. Attribute columns are not enlarged. */
HE_NODISCARD he_status he_content_reserve_vertices(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_edges(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_faces(he_content *c, size_t rows, he_error *err);

/* Returns the member `vertices`, `edges` or `faces` of the content, which counts the rows of a kind
 * of element; NULL for HE_MESH_KIND. HE_HALFEDGE gets `edges`: each row of edges is for two
 * half-edges. */
he_rows *he_content_rows(he_content *content, he_kind kind);

/* Applies the records of a delta between the positions `from` and `to` to a content: forwards, or
 * backwards, from the last one to the first, if `from` is after `to`. Columns, materials and
 * contents that the records name as a whole are exchanged with those in the array `objects`, which
 * has the order of delta->objects; it is NULL if the delta has no objects. */
void he_content_apply(he_content *c, const he_delta *delta, size_t from, size_t to, void **objects);
/* Applies a whole delta forwards to a content that may not have issued the delta's rows yet.
 * Afterwards the content has issued as many rows as `issued` says for each kind. On failure the
 * content is as it was.
 * Returns HE_CORRUPT if a record's `before` differs from the value in the content; *refused (which
 * may be NULL) is then the index of that record.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_content_forward(he_content *c, const he_delta *delta, void **objects,
                                          const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                          he_error *err);
/* Issues dead rows (rows of deleted elements) until the content has issued as many as `issued` says
 * for each kind.
 * Returns HE_NO_MEMORY if memory is out; some of the rows may then be issued. */
HE_NODISCARD he_status he_content_issue(he_content *c, const uint32_t issued[HE_KIND_COUNT],
                                        he_error *err);
/* Removes the last rows of each kind, so that only as many stay issued as `issued` says. These rows
 * must be dead, or belong to an edit that is rolled back. */
void he_content_withdraw(he_content *c, const uint32_t issued[HE_KIND_COUNT]);

#endif
