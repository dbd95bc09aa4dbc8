/* loop_join.h - joins two loops edge by edge; loop_split.h is the inverse. */
#ifndef HE_EDIT_BORDER_LOOP_JOIN_H
#define HE_EDIT_BORDER_LOOP_JOIN_H

#include "mesh/mesh.h"

/* loop_join joins two loops edge by edge: V - n, E - n for loops of n half-edges, F - 1 for each of
 * the two loops that is the border of a face. The edit connects two components, or adds a handle to
 * one.
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
 * If a loop is the border of a face, that face is deleted first. The vertices and edges of the loop
 * of a stay; the vertices and edges of the loop of b are merged into them. A vertex that stays
 * moves half-way to the vertex that is merged into it. Values in which two merged vertices differ
 * move to their corners (keep.h); `moved`, which may be NULL, gets the number of these values.
 * Corner values follow their half-edges.
 *
 * No vertex gets a closed fan beside another fan: the half-edges around a vertex of the loop of a
 * are followed by those around the vertex that is merged into it.
 *
 * Takes time linear in the number of half-edges around the vertices of the two loops.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_SAME_LOOP if a and b are on one loop.
 * Returns HE_LOOP_LENGTH if the loops have different lengths.
 * Returns HE_REPEATED_CORNER if a loop passes a vertex twice, or a face has two corners that would
 * become one.
 * Returns HE_SHARED_VERTEX if the loops share a vertex.
 * Returns HE_BOUNDARY_EDGE if two edges would merge into an edge without a face.
 * Returns HE_DOUBLED_EDGE if two edges that are not on the loops would join one pair of vertices.
 * Returns HE_LOCKED_ELEMENT if an element is locked (marks.h) that would be deleted or moved, or if
 * an edge or face at a vertex of the loop of b is locked, since it would get another vertex.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_loop_join(he_mesh *m, he_halfedge a, he_halfedge b, uint64_t *moved,
                                    he_error *err);

#endif
