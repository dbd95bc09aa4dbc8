/* hole.h - holes closed. */
#ifndef HE_EDIT_BORDER_HOLE_H
#define HE_EDIT_BORDER_HOLE_H

#include "mesh/mesh.h"

typedef enum he_fill {
    HE_FILL_POLYGON,    /* one face: V + 0, E + 0, F + 1 */
    HE_FILL_FAN,        /* triangles about a new vertex at the mean: V + 1, E + n, F + n */
    HE_FILL_TRIANGULATE /* triangles between the corners: V + 0, E + (n - 3), F + (n - 2) */
} he_fill;

typedef struct he_filled {
    he_vertex vertex;    /* of a fan, else HE_NONE */
    he_ids edges, faces; /* the new ones */
} he_filled;

/* hole_fill: the hole to the left of the boundary half-edge h, a loop of n, is closed.
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
 * The loop is as the boundary links have it: at a bow-tie it may lead from one fan to another.
 * There it fills the gap between two fans, so that they become one; the gap of a fan with itself
 * exists only where there is no other, so no fan closes beside another. Nothing old changes its
 * id; faces and the vertex have no parents. A polygon's half-edge is h.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_NOT_BOUNDARY; HE_REPEATED_CORNER when the
 * loop visits a vertex twice; for triangulate HE_DOUBLED_EDGE, as in triangulation.h.
 * HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL, else he_filled_clear frees it. */
HE_NODISCARD he_status he_hole_fill(he_mesh *m, he_halfedge h, he_fill method, he_filled *out,
                                    he_error *err);
void he_filled_clear(he_filled *filled);

#endif
