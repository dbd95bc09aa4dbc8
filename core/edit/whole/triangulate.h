/* triangulate.h - faces cut into triangles. */
#ifndef HE_EDIT_WHOLE_TRIANGULATE_H
#define HE_EDIT_WHOLE_TRIANGULATE_H

#include "mesh/mesh.h"

/* face_triangulate: for each face of n corners V + 0, E + (n - 3), F + (n - 3).
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
 * Concave faces come out right: see triangulation.h for what is chosen. The triangle of the stored
 * half-edge keeps the id of its face, the others descend from it; a triangle is left as it is.
 *
 * New ids are appended to `edges` and `faces`, and to `degenerate` the faces in whose plane some
 * triangle has no area or is turned over, as in faces without area or that cross themselves; they
 * are triangulated all the same. All three may be NULL.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT;
 * HE_DOUBLED_EDGE when a face cannot be triangulated without a diagonal that exists as an edge
 * elsewhere. HE_NO_MEMORY, HE_IDS_EXHAUSTED. */
HE_NODISCARD he_status he_face_triangulate(he_mesh *m, const uint32_t *face_ids, size_t count,
                                           he_ids *edges, he_ids *faces, he_ids *degenerate,
                                           he_error *err);

/* triangulate: face_triangulate of every face of more than three corners, in the order of ids. Of
 * its refusals HE_DOUBLED_EDGE is left. */
HE_NODISCARD he_status he_triangulate(he_mesh *m, he_ids *edges, he_ids *faces, he_ids *degenerate,
                                      he_error *err);

#endif
