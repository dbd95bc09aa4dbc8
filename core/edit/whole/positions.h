/* positions.h - writes the positions of many vertices in one edit. */
#ifndef HE_EDIT_WHOLE_POSITIONS_H
#define HE_EDIT_WHOLE_POSITIONS_H

#include "mesh/column.h"

/* Moves vertices to given points. `ids` lists `count` vertices. If it is NULL, `count` must be the
 * number of ids that were ever issued for vertices, and point i is that of vertex i; the points of
 * deleted vertices are ignored. `points` has one point for each id, or, with `same`, one point for
 * all.
 *
 * A vertex that is at its point already is not written, so it may be locked. If the edit is
 * refused, nothing changes. Costs time and memory for each vertex that moves. If most of many
 * vertices move, the delta gets one record with all positions (HE_COL_POSITIONS).
 * Returns HE_BAD_VALUE if `ids` is NULL and `count` is not the number of issued ids.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if a listed vertex is not live.
 * Returns HE_REPEATED_ELEMENT if a vertex is listed twice.
 * Returns HE_NOT_FINITE if a live vertex would have a position that is not finite.
 * Returns HE_LOCKED_ELEMENT if a vertex that would move is locked.
 * Returns HE_CANCELLED if the mesh's progress is cancelled, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_positions_write(he_mesh *m, const uint32_t *ids, size_t count,
                                          const he_vec3 *points, bool same, he_error *err);
/* Does what he_positions_write does with `ids` NULL and the rows of `takes` as points: a column of
 * he_position_schema with a row for each issued id. If most vertices move, the column becomes the
 * record of the edit, so that no second copy of the positions is made. On success `takes` belongs
 * to the mesh. Returns the errors of he_positions_write. */
HE_NODISCARD he_status he_positions_put(he_mesh *m, he_column *takes, he_error *err);

#endif
