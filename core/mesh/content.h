/* content.h - the life of he_content, for core/mesh and core/stored only. */
#ifndef HE_MESH_CONTENT_H
#define HE_MESH_CONTENT_H

#include "mesh/layout.h"

void he_content_clear(he_content *content); /* frees what it holds */
/* Fills *out on success only. `watch` may be NULL. */
HE_NODISCARD he_status he_content_copy(const he_content *content, he_watch *watch, he_content *out,
                                       he_error *err);
size_t he_content_bytes(const he_content *content);
/* Bytes of the issued rows alone, without spare capacity. */
size_t he_content_rows_bytes(const he_content *content);

/* Make room in the link and position columns (not in the attributes) for this many rows in all. */
HE_NODISCARD he_status he_content_reserve_vertices(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_edges(he_content *c, size_t rows, he_error *err);
HE_NODISCARD he_status he_content_reserve_faces(he_content *c, size_t rows, he_error *err);

/* The table of a domain's rows, NULL for the mesh. Half-edge rows are twice the edges'. */
he_rows *he_content_rows(he_content *content, he_kind kind);

/* Apply the records `from`..`to` of a delta, forwards or (`undo`) backwards. Columns and contents
 * are exchanged with `objects`, indexed like the delta's own; NULL when it has none. */
void he_content_apply(he_content *c, const he_delta *delta, size_t from, size_t to, bool undo,
                      void **objects);
/* Apply a whole delta forwards to a content that need not have issued the delta's rows; afterwards
 * its high-water marks are `issued`, indexed by kind. Each record must find what it was made on:
 * HE_CORRUPT names one that does not, and sets *refused (may be NULL) to its index. After that and
 * after HE_NO_MEMORY the content is as it was. */
HE_NODISCARD he_status he_content_forward(he_content *c, const he_delta *delta, void **objects,
                                          const uint32_t issued[HE_KIND_COUNT], size_t *refused,
                                          he_error *err);
/* Issue dead rows up to the high-water marks, indexed by kind. After HE_NO_MEMORY some may be. */
HE_NODISCARD he_status he_content_issue(he_content *c, const uint32_t issued[HE_KIND_COUNT],
                                        he_error *err);
/* Take rows above the marks back. They are dead, or about to be forgotten. */
void he_content_withdraw(he_content *c, const uint32_t issued[HE_KIND_COUNT]);

#endif
