/* triangulate.h - cuts faces into triangles. */
#ifndef HE_EDIT_WHOLE_TRIANGULATE_H
#define HE_EDIT_WHOLE_TRIANGULATE_H

#include "mesh/mesh.h"

/* face_triangulate cuts faces into triangles: for each face of n corners V + 0, E + (n - 3),
 * F + (n - 3).
 *
 *        o-------o-------o               o-------o-------o
 *        |               |               | \     |     / |
 *        |       f       |               |   \   |   /   |
 *        |               |     --->      |     \ | /     |
 *        o       o       o               o       o       o
 *         \    /   \    /                 \    /   \    /
 *          \ /       \ /                   \ /       \ /
 *           o         o                     o         o
 *
 * Concave faces are handled correctly; triangulation.h says which triangles are chosen. The
 * triangle of the stored half-edge keeps the id of its face; the other triangles descend from the
 * face. A face that already is a triangle is not changed.
 *
 * The ids of new elements are appended to `edges` and `faces`. A face that has no area or
 * intersects itself is triangulated as well, but then some of its triangles have no area or are
 * flipped; the ids of such faces are appended to `degenerate`. Each of the three lists may be NULL.
 *
 * If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_DOUBLED_EDGE if a face cannot be triangulated without a diagonal that exists as an
 * edge elsewhere.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_triangulate(he_mesh *m, const uint32_t *face_ids, size_t count,
                                           he_ids *edges, he_ids *faces, he_ids *degenerate,
                                           he_error *err);

/* triangulate: runs face_triangulate for every face of more than three corners, in the order of
 * ids. The only refusal is HE_DOUBLED_EDGE. */
HE_NODISCARD he_status he_triangulate(he_mesh *m, he_ids *edges, he_ids *faces, he_ids *degenerate,
                                      he_error *err);

#endif
