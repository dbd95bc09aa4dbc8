/* plane_split.h - splits faces along a plane. */
#ifndef HE_EDIT_PLANE_PLANE_SPLIT_H
#define HE_EDIT_PLANE_PLANE_SPLIT_H

#include "edit/plane/plane.h"

typedef struct he_plane_parts {
    he_ids vertices;      /* the new vertices, one for each edge that was split */
    he_ids edges;         /* the new diagonals */
    he_ids faces;         /* the new faces: one for each new diagonal */
    uint32_t faces_split; /* number of old faces that were split */
} he_plane_parts;

/* plane_split splits faces along a plane: V + k, E + k + d, F + d for k edges that the plane
 * crosses and d diagonals. A convex face gets one diagonal. Each edge whose ends are on different
 * sides gets a vertex where it meets the plane (see edge_bisect), then each face with corners on
 * both sides is split along the plane (see face_split). A concave face may get several diagonals
 * (chords.h). Nothing is deleted and nothing moves.
 *
 *        o-------o-------o              o---w---o-------o
 *        |   .   |       |              |  /|   |       |
 *        |  .    |       |              | / |   |       |         a vertex within the tolerance of
 *        | .  f  |   g   |    --->      |/  |  ..                 the plane is used as it is; an
 *        |.      |       |              .                         edge in the plane is left alone
 *       .o-------o-------o
 *
 * If faces are listed, only these are split. An edge between a listed face and an unlisted face is
 * bisected as well, so the unlisted face gets one more corner.
 *
 * Afterwards no face (or, if faces are listed, no listed one) has corners on both sides of the
 * plane, and splitting again along the same plane changes nothing. A plane that only touches a
 * face, at corners or along sides, does not cross it.
 *
 * Edges are split in the order of their ids, then faces in the order of their ids. A diagonal of a
 * face is made after the diagonals that it separates from the face's stored half-edge. The part of
 * an edge at the origin of half-edge 2e keeps the id of the edge. The part of a face with the
 * stored half-edge keeps the id of the face; the other parts descend from the face. Diagonals and
 * new vertices have no parents.
 *
 * A NULL list of faces stands for all faces.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_plane_parts_clear frees
 * it.
 * Returns HE_NOT_FINITE or HE_BAD_VALUE as he_sides_find does.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT or HE_REPEATED_ELEMENT if an element of the list
 * is not live or is listed twice.
 * Returns HE_DOUBLED_EDGE if a diagonal would join two vertices that another edge or diagonal
 * joins.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_plane_split(he_mesh *m, const he_plane *plane, const uint32_t *faces,
                                      size_t count, he_plane_parts *out, he_error *err);
void he_plane_parts_clear(he_plane_parts *parts);

#endif
