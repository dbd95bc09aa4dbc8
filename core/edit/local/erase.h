/* erase.h - deletes faces, edges and vertices.
 *
 * A deleted face leaves a hole: its half-edges keep their links and become boundary half-edges.
 * Edges that are left without a face are deleted, so holes that touch along an edge merge.
 * The half-edges that remain around a vertex keep their order, so a walk around the vertex still
 * visits all its fans; the vertex may become a bow-tie.
 *
 *        o-------o-------o            o-------o-------o
 *        |       |       |            |       |       |
 *        |   f   |   g   |    --->    |       |   g   |
 *        |       |       |            |       |       |
 *        o-------o-------o            .       o-------o
 *                                   deleted   (the left edges had no other face)
 *
 * Vertices that are left without an edge are deleted, too, unless the caller asks to keep them.
 *
 * Every function returns HE_LOCKED_ELEMENT if a face, edge or vertex that would be deleted is
 * locked (marks.h), and HE_NO_MEMORY if memory is out; the mesh is then as it was. */
#ifndef HE_EDIT_LOCAL_ERASE_H
#define HE_EDIT_LOCAL_ERASE_H

#include "mesh/mesh.h"

/* What happens to vertices that are left without an edge: they are deleted or kept. */
typedef enum he_leftover { HE_DROP_ISOLATED, HE_KEEP_ISOLATED } he_leftover;

/* face_delete: deletes `count` faces, with the edges that are left without a face. All other
 * elements keep their ids. If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice. */
HE_NODISCARD he_status he_face_delete(he_mesh *m, const uint32_t *faces, size_t count,
                                      he_leftover leftover, he_error *err);

/* edge_delete: deletes the faces beside the edges as face_delete does. The edges then have no face,
 * so they are deleted as well. A face beside two of the edges is deleted once. V varies, E falls by
 * `count` or more, F by the number of faces beside the edges. If the edit is refused, nothing
 * changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice. */
HE_NODISCARD he_status he_edge_delete(he_mesh *m, const uint32_t *edges, size_t count,
                                      he_leftover leftover, he_error *err);

/* vertex_delete: deletes the faces at v as face_delete does, then v itself. `leftover` says what
 * happens to neighbours of v that are left without an edge.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live. */
HE_NODISCARD he_status he_vertex_delete(he_mesh *m, he_vertex v, he_leftover leftover,
                                        he_error *err);

/* delete_isolated deletes every vertex without an edge: V - n for n such vertices, E + 0, F + 0. */
HE_NODISCARD he_status he_delete_isolated(he_mesh *m, he_error *err);

#endif
