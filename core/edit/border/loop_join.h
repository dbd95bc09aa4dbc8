/* loop_join.h - two loops sewn together, edge to edge; loop_split.h takes them apart again. */
#ifndef HE_EDIT_BORDER_LOOP_JOIN_H
#define HE_EDIT_BORDER_LOOP_JOIN_H

#include "mesh/mesh.h"

/* loop_join: V - n, E - n for loops of n half-edges, F less one for each of the two that is a
 * face's. It connects two components, or adds a handle to one.
 *
 *         \     /                      \     /
 *          o<--o   face or hole         \   /
 *          | b |                         \ /
 *          o-->o                      o---o---o        a and b become one edge, then the one after
 *                         --->        |       |        a and the one before b, and so on around:
 *          o<--o                      o---o---o        the origin of a becomes one with the target
 *          | a |                         / \           of b.
 *          o-->o   face or hole         /   \
 *         /     \                      /     \
 *
 * A loop that is a face's is taken away first, so that it is a hole. The vertices and edges of a
 * stay, those of b are merged into them. A vertex comes to lie half-way between the two.
 * What it says goes to its corners where the two differ (keep.h), and is counted in `moved`, which
 * may be NULL. Corner values follow their half-edges.
 *
 * No fan closes beside another: the ring about a joined vertex is the two rings one after the
 * other.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_SAME_LOOP; HE_LOOP_LENGTH;
 * HE_REPEATED_CORNER when a loop passes a vertex twice, or a face has two corners that would become
 * one; HE_SHARED_VERTEX; HE_BOUNDARY_EDGE when neither of two edges would have a face left;
 * HE_DOUBLED_EDGE when two other edges would join the same vertices; HE_LOCKED_ELEMENT for what
 * goes, a vertex that would move, and edges and faces at the vertices of b, which get another
 * (marks.h). HE_NO_MEMORY. Costs what is about the vertices of both loops. */
HE_NODISCARD he_status he_loop_join(he_mesh *m, he_halfedge a, he_halfedge b, uint64_t *moved,
                                    he_error *err);

#endif
