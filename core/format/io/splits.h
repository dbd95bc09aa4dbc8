/* splits.h - splits vertices for formats without corners: one vertex for each combination of values
 * of the corners at a vertex.
 *
 *     --o--        v       the corners left of v have 3, those right of it 8: v is written with 3,
 *     3 | 8     3 | | 8    and a copy of it, after all vertices, with 8. Faces name the one that
 *       |        v   v'    has the value of their corner.
 *
 * Numbers 0 to V - 1 are those of the live vertices, in the order of ids; each has the values of
 * its first corner, in the order of faces. */
#ifndef HE_FORMAT_IO_SPLITS_H
#define HE_FORMAT_IO_SPLITS_H

#include "format/io/export.h"

/* The vertices of a file after splitting. {0} means that no vertex is split. */
typedef struct he_splits {
    uint32_t *number; /* number in the file of the vertex that is written for each half-edge with a
                         face */
    uint32_t *own;    /* for each vertex, the half-edge whose corner has the values with which the
                       * vertex is written; HE_NONE if the vertex has no face */
    /* A half-edge for each copy: its corner has the copy's values, and its origin is the vertex
     * that was copied. */
    he_ids copies;
} he_splits;

/* Splits the vertices. `numbers` are the vertex numbers that he_export_numbers computes; `progress`
 * may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_splits_make(const he_mesh *mesh, const uint32_t *numbers,
                                      const he_column *const *columns, size_t count,
                                      he_progress *progress, he_splits *out, he_error *err);
void he_splits_clear(he_splits *splits);

#endif
