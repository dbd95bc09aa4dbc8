/* bridge.h - joins two holes by a strip of faces. */
#ifndef HE_EDIT_BORDER_BRIDGE_H
#define HE_EDIT_BORDER_BRIDGE_H

#include "mesh/mesh.h"

/* The elements that loop_bridge made, in the order of the loop of half-edge `a` from the origin of
 * `a` on. */
typedef struct he_bridge {
    /* The rungs, edges between the two loops: half-edge 2e of each leaves the loop of a. */
    he_ids edges;
    he_ids faces; /* face n is between rung n and the next one */
} he_bridge;

/* loop_bridge joins the loops of two holes by a strip of faces: V + 0; for two loops of n
 * half-edges E + n, F + n quadrilaterals; for loops of n and m half-edges E + (n + m), F + (n + m)
 * triangles.
 *
 *        o<------o<------o  loop of b          o-------o-------o
 *        |   b       .   |                     |       |       |
 *                                     --->     | f_0   |  f_1  |    rungs run from the loop of a
 *        |   a       .   |                     |       |       |    to the loop of b
 *        o------>o------>o  loop of a          o-------o-------o
 *
 * a and b are any boundary half-edges of the two loops; they decide only the order of the new
 * elements. The loops are those that the links of boundary half-edges make; at a bow-tie a loop may
 * pass a vertex more than once. At such a vertex the strip fills gaps between fans, so that these
 * become one fan. A fan is closed only if it is the only one of its vertex, so no vertex gets a
 * closed fan beside another fan.
 *
 * LEAST TWIST. Corner i of one loop is paired with corner s + i * m / n, rounded, of the other, and
 * s is chosen so that the sum of the squared distances of the pairs is smallest; of several such s
 * the lowest is taken. On loops of more than HE_TWIST_PAIRS corners the sum is over that many
 * corners, evenly spread. If a pairing would join two vertices that an edge joins already, the
 * pairing with the next smallest sum is tried: all pairings on loops of equal length that pass no
 * vertex twice, at most HE_TWIST_TRIES on others.
 *
 * Triangles start at the pair of corners with the origin of a, and each next rung is the shorter of
 * two candidates (H. N. Christiansen and T. W. Sederberg, "Conversion of complex contour line
 * definitions into polygonal element mosaics", 1978), but neither side of the strip gets half a
 * loop ahead of the other.
 *
 * Old elements keep their ids; new ones have no parents.
 *
 * `out` may be NULL; otherwise he_bridge_clear frees it. Takes time linear in the lengths of the
 * loops.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_NOT_BOUNDARY if an element is not on the boundary.
 * Returns HE_SAME_LOOP if a and b are on one loop.
 * Returns HE_SHARED_VERTEX if the loops share a vertex.
 * Returns HE_DOUBLED_EDGE if every pairing that was tried has a rung whose ends another edge or
 * rung joins already (the message names one in the pairing of least twist).
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_loop_bridge(he_mesh *m, he_halfedge a, he_halfedge b, he_bridge *out,
                                      he_error *err);
void he_bridge_clear(he_bridge *bridge);

enum { HE_TWIST_PAIRS = 64, HE_TWIST_TRIES = 64 };

#endif
