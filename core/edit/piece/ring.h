/* ring.h - maintains the ring of a vertex, which is the cycle of half-edges that leave it: chooses
 * which of these half-edges the vertex stores (invariant I8 of mesh.h), and changes the order in
 * which the fans of the vertex are linked. */
#ifndef HE_EDIT_PIECE_RING_H
#define HE_EDIT_PIECE_RING_H

#include "mesh/write.h"

/* The most links that one call of he_ring_settle writes. Edits reserve memory for them. */
enum { HE_SETTLE_LINKS = 1 };

/* Makes the half-edge that vertex v stores satisfy I8: it must leave v, and be a boundary half-edge
 * if v has any. `leaving` is any half-edge that leaves v. A stored half-edge that satisfies I8
 * stays. An edit calls this for each vertex it changed, once all links, origins and faces at v are
 * final. The function walks around v unless the stored half-edge is a boundary half-edge that
 * leaves v. */
void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving);

/* Returns the half-edge with which a fan ends. `in` is a boundary half-edge; a fan at its target
 * begins with it. The result is the boundary half-edge that leaves the target and ends this fan.
 * Takes time linear in the size of the fan. */
he_halfedge he_ring_fan_end(const he_mesh *m, he_halfedge in);

/* Makes `out` follow `in` in the loop of a hole. Both are boundary half-edges at one vertex: a fan
 * X ends with `out`, and a fan Y begins with `in`; X may be Y if the vertex has no other fan. The
 * fans Z between X and Y are moved to the gap after Y:
 *
 *     Y (from in), Z.., X (to out), W..   --->   X Y next to each other, Z.., W..
 *
 * Writes at most HE_GAP_LINKS links. */
enum { HE_GAP_LINKS = 6 };
void he_ring_close_gap(he_mesh *m, he_halfedge in, he_halfedge out);

#endif
