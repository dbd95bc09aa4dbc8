/* bridge.h - joins two holes by a strip of faces. */
#ifndef HE_EDIT_BORDER_BRIDGE_H
#define HE_EDIT_BORDER_BRIDGE_H

#include "mesh/mesh.h"

/* The elements that loop_bridge made, in the order of the loop of half-edge `a`, beginning at the
 * origin of `a`. */
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
 * elements. A loop follows the links of boundary half-edges, so it may pass a bow-tie more than
 * once. At such a vertex the strip fills gaps between fans, so that these fans become one. A fan is
 * closed only if its vertex has no other fan, so no vertex gets a closed fan beside another fan.
 *
 * LEAST TWIST. A number s decides how corners are paired: corner i of the loop of a is paired with
 * corner s + i * m / n, rounded, of the loop of b. The chosen s is the lowest one with the smallest
 * sum of squared distances between paired corners. If the loops have more than HE_TWIST_PAIRS
 * corners, the sum is taken over HE_TWIST_PAIRS corners that are evenly spread. If a pairing would
 * join two vertices that an edge joins already, the pairing with the next smallest sum is tried.
 * All pairings may be tried if the loops have equal lengths and pass no vertex twice, otherwise at
 * most HE_TWIST_TRIES.
 *
 * If the strip consists of triangles, the first rung joins the pair of corners to which the origin
 * of a belongs. Each further rung is the shorter of two candidates (H. N. Christiansen and T. W.
 * Sederberg, "Conversion of complex contour line definitions into polygonal element mosaics",
 * 1978), except that no side of the strip may get half a loop ahead of the opposite side.
 *
 * Old elements keep their ids; new ones have no parents.
 *
 * `out` may be NULL; otherwise he_bridge_clear frees it. Takes time linear in the lengths of the
 * loops.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_NOT_BOUNDARY if an element is not on the boundary.
 * Returns HE_SAME_LOOP if a and b are on one loop.
 * Returns HE_SHARED_VERTEX if the loops share a vertex.
 * Returns HE_DOUBLED_EDGE if in every pairing that was tried the ends of a rung are joined by an
 * edge or by another rung. The message names such a rung of the pairing with the least twist.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_loop_bridge(he_mesh *m, he_halfedge a, he_halfedge b, he_bridge *out,
                                      he_error *err);
void he_bridge_clear(he_bridge *bridge);

enum { HE_TWIST_PAIRS = 64, HE_TWIST_TRIES = 64 };

#endif
