/* erase.h - taking faces and vertices away.
 *
 * A deleted face leaves a hole: its half-edges keep their links and become boundary half-edges.
 * Edges with no face left go, so holes that touch along an edge merge; links about a vertex only
 * ever lose half-edges that leave it, so the ring still visits every fan and a bow-tie may appear.
 *
 *        o-------o-------o            o-------o-------o
 *        |       |       |            |       |       |
 *        |   f   |   g   |    --->    |       |   g   |
 *        |       |       |            |       |       |
 *        o-------o-------o            .       o-------o
 *                                   goes      (the left edges had no other face)
 *
 * Vertices left without an edge go too, unless they are to be kept as isolated ones.
 *
 * All may be refused with HE_LOCKED_ELEMENT for a face, edge or vertex that would go (marks.h), and
 * fail with HE_NO_MEMORY; a refusal or failure leaves the mesh as it was. */
#ifndef HE_EDIT_LOCAL_ERASE_H
#define HE_EDIT_LOCAL_ERASE_H

#include "mesh/mesh.h"

/* What happens to vertices left without an edge. */
typedef enum he_leftover { HE_DROP_ISOLATED, HE_KEEP_ISOLATED } he_leftover;

/* face_delete: F - count, V and E as above. Other elements keep their ids. Refused, all or
 * nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT. */
HE_NODISCARD he_status he_face_delete(he_mesh *m, const uint32_t *faces, size_t count,
                                      he_leftover leftover, he_error *err);

/* edge_delete: the faces beside the edges go as by face_delete, and with them the edges. A face
 * beside two of the edges goes once. V varies, E - count at least, F - the faces beside them.
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT. */
HE_NODISCARD he_status he_edge_delete(he_mesh *m, const uint32_t *edges, size_t count,
                                      he_leftover leftover, he_error *err);

/* vertex_delete: the faces of v go as by face_delete, then v itself; `leftover` is about the other
 * vertices. An isolated vertex just goes. Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT. */
HE_NODISCARD he_status he_vertex_delete(he_mesh *m, he_vertex v, he_leftover leftover,
                                        he_error *err);

/* delete_isolated: V - n, E + 0, F + 0. Every vertex without an edge goes. */
HE_NODISCARD he_status he_delete_isolated(he_mesh *m, he_error *err);

#endif
