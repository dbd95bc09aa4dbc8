/* splits.h - vertices as other programs have them, who know of no corners: one for each thing that
 * the corners about a vertex say.
 *
 *     --o--        v       the corners left of v say 3, those right of it 8: v is written with 3,
 *     3 | 8     3 | | 8    and a copy of it behind all vertices with 8. Faces name the one that
 *       |        v   v'    says what their corner says.
 *
 * Numbers 0 to V - 1 are those of the live vertices, in the order of ids; each says what its first
 * corner says, in the order of faces. */
#ifndef HE_FORMAT_IO_SPLITS_H
#define HE_FORMAT_IO_SPLITS_H

#include "format/io/export.h"

/* {0} is empty: no columns, no copies. */
typedef struct he_splits {
    uint32_t *number; /* of the vertex that stands for each half-edge with a face */
    uint32_t *own;    /* of each vertex the half-edge that it says the same as; HE_NONE */
    he_ids copies;    /* of each copy a half-edge whose origin is the vertex */
} he_splits;

/* `numbers` are those of he_export_numbers; `watch` may be NULL. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_splits_make(const he_mesh *mesh, const uint32_t *numbers,
                                      const he_column *const *columns, size_t count,
                                      he_watch *watch, he_splits *out, he_error *err);
void he_splits_clear(he_splits *splits);

#endif
