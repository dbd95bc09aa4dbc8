/* bridge.h - two holes joined by a strip of faces. */
#ifndef HE_EDIT_BORDER_BRIDGE_H
#define HE_EDIT_BORDER_BRIDGE_H

#include "mesh/mesh.h"

/* What loop_bridge made, from the origin of `a` on along its loop. */
typedef struct he_bridge {
    he_ids edges; /* rungs: half-edge 2e leaves the loop of a */
    he_ids faces; /* the n-th between the n-th rung and the one after it */
} he_bridge;

/* loop_bridge: V + 0; for loops of n and n half-edges E + n, F + n quadrilaterals, for loops of n
 * and m E + (n + m), F + (n + m) triangles.
 *
 *        o<------o<------o  loop of b          o-------o-------o
 *        |   b       .   |                     |       |       |
 *                                     --->     | f_0   |  f_1  |    rungs run from the loop of a
 *        |   a       .   |                     |       |       |    to the loop of b
 *        o------>o------>o  loop of a          o-------o-------o
 *
 * a and b are boundary half-edges that name their loops; where on them they are does not matter but
 * for the order of what is made. Loops are as the boundary links have them; at a bow-tie one may
 * pass a vertex more than once. The strip fills the gaps it passes there, so that fans become one;
 * the gap of a fan with itself exists only where there is no other, so none closes beside another.
 *
 * LEAST TWIST. Corner i of one loop is paired with corner s + i * m / n, rounded, of the other, and
 * s chosen so that the squared distances of the pairs sum to the least, the lowest s where several
 * do. On loops of more than HE_TWIST_PAIRS corners the sum is over so many, evenly spread. A
 * pairing by which an edge would be doubled is passed over for the one with the next least twist:
 * on loops of one length that pass no vertex twice until one does, on others HE_TWIST_TRIES times.
 *
 * Triangles start at the pair of a's origin, and the strip goes on by the shorter of the two rungs
 * that are next (H. N. Christiansen and T. W. Sederberg, "Conversion of complex contour line
 * definitions into polygonal element mosaics", 1978), but never runs half a loop ahead on one side.
 *
 * Nothing old changes its id; what is new has no parents.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_NOT_BOUNDARY; HE_SAME_LOOP; HE_SHARED_VERTEX;
 * HE_DOUBLED_EDGE where an edge, or another rung, joins the ends of a rung already, by each pairing
 * that is tried; it names one by the pairing of least twist. HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out`
 * may be NULL, else he_bridge_clear frees it. Costs the loops. */
HE_NODISCARD he_status he_loop_bridge(he_mesh *m, he_halfedge a, he_halfedge b, he_bridge *out,
                                      he_error *err);
void he_bridge_clear(he_bridge *bridge);

enum { HE_TWIST_PAIRS = 64, HE_TWIST_TRIES = 64 };

#endif
