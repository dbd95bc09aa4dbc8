/* vertex.h - adds single vertices, and moves vertices.
 *
 * Each function checks the ids that it gets, because they may come from clients: it returns
 * HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live. Each function may return
 * HE_NO_MEMORY. */
#ifndef HE_EDIT_LOCAL_VERTEX_H
#define HE_EDIT_LOCAL_VERTEX_H

#include "mesh/mesh.h"

/* vertex_add adds an isolated vertex at `position` (V + 1), even if another vertex is there.
 * Returns HE_NOT_FINITE if the position is not finite.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_add(he_mesh *m, he_vec3 position, he_vertex *out, he_error *err);

typedef enum he_move { HE_MOVE_TO, HE_MOVE_BY } he_move;

/* vertex_move moves vertices; no element is made or deleted. Each of `count` vertices moves to a
 * point, or by an offset, as `how` says; `points` has one point or offset for each vertex, or a
 * single point or offset for all of them.
 *
 * If the edit is refused, nothing changes.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_BAD_VALUE if the number of points is neither `count` nor one.
 * Returns HE_NOT_FINITE if a point or offset, or a new position, is not finite.
 * Returns HE_LOCKED_ELEMENT if a vertex is locked (marks.h), even if its position would not
 * change. */
HE_NODISCARD he_status he_vertex_move(he_mesh *m, const uint32_t *vertices, size_t count,
                                      he_move how, const he_vec3 *points, size_t point_count,
                                      he_error *err);

#endif
