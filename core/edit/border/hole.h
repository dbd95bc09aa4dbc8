/* hole.h - closes holes. */
#ifndef HE_EDIT_BORDER_HOLE_H
#define HE_EDIT_BORDER_HOLE_H

#include "mesh/mesh.h"

typedef enum he_fill {
    HE_FILL_POLYGON, /* one face: V + 0, E + 0, F + 1 */
    HE_FILL_FAN, /* triangles around a new vertex at the mean of the corners: V + 1, E + n, F + n */
    HE_FILL_TRIANGULATE /* triangles between the corners: V + 0, E + (n - 3), F + (n - 2) */
} he_fill;

typedef struct he_filled {
    he_vertex vertex;    /* the new vertex if there is exactly one, else HE_NONE */
    he_ids edges, faces; /* the new edges and faces */
    he_ids loop;         /* the half-edges of the hole, from the given one on */
} he_filled;

/* hole_fill: closes the hole to the left of the boundary half-edge h, a loop of n half-edges.
 *
 *        o-----o-----o            o-----o-----o          o-----o-----o          o-----o-----o
 *        |     |     |            |     |     |          |     |     |          |     |     |
 *        o-----o-----o            o-----o-----o          o-----o-----o          o-----o-----o
 *        |     |      h    --->   |     |     |    or    |     | \ / |    or    |     | \   |
 *        o-----o     o            o-----o     o          o-----o  o  o          o-----o   \ o
 *        |     |     |            |     |     |          |     | / \ |          |     |     |
 *        o-----o-----o            o-----o-----o          o-----o-----o          o-----o-----o
 *                                    polygon                  fan                triangulate
 *
 * The loop follows the links of boundary half-edges, so at a bow-tie it may lead from one fan to
 * another. The new faces fill the gap between these fans, which become one fan. A fan is closed
 * only if its vertex has no other fan, so no vertex gets a closed fan beside another fan. Old
 * elements keep their ids; the new faces and the new vertex have no parents. With HE_FILL_POLYGON
 * the new face stores h.
 *
 * `out` may be NULL; otherwise he_filled_clear frees it.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_NOT_BOUNDARY if an element is not on the boundary.
 * Returns HE_REPEATED_CORNER if the loop visits a vertex twice.
 * Returns HE_DOUBLED_EDGE if HE_FILL_TRIANGULATE finds no triangulation without an existing edge
 * (triangulation.h).
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_hole_fill(he_mesh *m, he_halfedge h, he_fill method, he_filled *out,
                                    he_error *err);
void he_filled_clear(he_filled *filled);

/* Lists the half-edges of the hole to the left of h, beginning with h, into an empty list, which
 * the caller clears, also after a failure. Returns HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT,
 * HE_NOT_BOUNDARY, HE_REPEATED_CORNER or HE_NO_MEMORY as he_hole_fill does. */
HE_NODISCARD he_status he_hole_loop(const he_mesh *m, he_halfedge h, he_ids *loop, he_error *err);

#endif
