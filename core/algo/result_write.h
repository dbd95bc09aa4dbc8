/* result_write.h - writes the result of an operation on a whole mesh, which was computed in a copy
 * of the mesh, into the mesh. */
#ifndef HE_ALGO_RESULT_WRITE_H
#define HE_ALGO_RESULT_WRITE_H

#include "mesh/mesh.h"

/* Makes mesh `m` equal to `made`, a copy of it that was changed: elements may be changed, deleted
 * or new, and new ones have the next ids and are live. Each word that differs is written once and
 * recorded for undo. There is also room for `lineage` calls of he_note_parent and he_note_merged
 * afterwards.
 * Returns HE_NO_MEMORY if memory is out; the mesh is as it was.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_result_write(he_mesh *m, const he_mesh *made, size_t lineage,
                                       he_error *err);

#endif
