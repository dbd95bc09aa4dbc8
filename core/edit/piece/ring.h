/* ring.h - maintains the ring of a vertex, which is the cycle of half-edges that leave it: which of
 * them the vertex stores (invariant I8 of mesh.h), and in which order its fans are chained. */
#ifndef HE_EDIT_PIECE_RING_H
#define HE_EDIT_PIECE_RING_H

#include "mesh/write.h"

/* The most links that one call of he_ring_settle writes. Edits add it to the memory they
 * reserve. */
enum { HE_SETTLE_LINKS = 1 };

/* Makes the half-edge that vertex v stores satisfy I8: it must leave v, and be a boundary half-edge
 * if v has any. `leaving` is any half-edge that leaves v. A stored half-edge that satisfies I8
 * stays. An edit calls this for each vertex it changed, once all links, origins and faces at v are
 * final. It walks around v only if one look at the stored half-edge does not suffice. */
void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving);

/* `in` is a boundary half-edge. One of the fans at its target begins there; returns the boundary
 * half-edge that leaves the target and ends that fan. Takes time linear in the size of the fan. */
he_halfedge he_ring_fan_end(const he_mesh *m, he_halfedge in);

/* Makes `out` follow `in`. They are boundary half-edges that end and begin different fans, or the
 * only fan, at a vertex. The fans between them move to the gap behind the fan that begins at `in`:
 *
 *     Y (from in), Z.., X (to out), W..   --->   X Y next to each other, Z.., W..
 *
 * Writes at most HE_GAP_LINKS links. */
enum { HE_GAP_LINKS = 6 };
void he_ring_close_gap(he_mesh *m, he_halfedge in, he_halfedge out);

#endif
