/* vertex.h - vertices on their own: adding one, moving some.
 *
 * Elements are named by ids here because lists come from outside; every function checks them and
 * refuses with HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT. All may fail with HE_NO_MEMORY. */
#ifndef HE_EDIT_LOCAL_VERTEX_H
#define HE_EDIT_LOCAL_VERTEX_H

#include "mesh/mesh.h"

/* vertex_add: V + 1. An isolated vertex at `position`; that another may lie there is not looked
 * at. Refused: HE_NOT_FINITE. HE_IDS_EXHAUSTED. */
HE_NODISCARD he_status he_vertex_add(he_mesh *m, he_vec3 position, he_vertex *out, he_error *err);

typedef enum he_move { HE_MOVE_TO, HE_MOVE_BY } he_move;

/* vertex_move: no element comes or goes. Each of `count` vertices goes to its point, or by it;
 * `points` holds one for each vertex, or a single one for all of them.
 *
 * Refused, all or nothing: HE_REPEATED_ELEMENT; HE_BAD_VALUE when there are neither `count` points
 * nor one; HE_NOT_FINITE for a point, or a sum, that is not finite; HE_LOCKED_ELEMENT for a locked
 * vertex (marks.h), even one that would come to where it is. */
HE_NODISCARD he_status he_vertex_move(he_mesh *m, const uint32_t *vertices, size_t count,
                                      he_move how, const he_vec3 *points, size_t point_count,
                                      he_error *err);

#endif
