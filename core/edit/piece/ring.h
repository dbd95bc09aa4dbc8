/* ring.h - the ring about a vertex: its stored half-edge kept right (I8), its fans chained anew. */
#ifndef HE_EDIT_PIECE_RING_H
#define HE_EDIT_PIECE_RING_H

#include "mesh/write.h"

/* Links of one call, for he_need. */
enum { HE_SETTLE_LINKS = 1 };

/* Make halfedge(v) what I8 asks, given `leaving`, any half-edge that leaves v. The stored one stays
 * wherever it may. Called in COMMIT, once all links, origins and faces about v are final. Turns
 * about v only when the stored one does not already prove itself. */
void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving);

/* The boundary half-edge that leaves the target of `in`, a boundary half-edge, and ends the fan
 * that begins there. Costs the fan. */
he_halfedge he_ring_fan_end(const he_mesh *m, he_halfedge in);

/* Make `out` follow `in`, boundary half-edges that end and begin different fans, or the only one,
 * at a vertex. The fans between them move to the gap behind the fan that begins at `in`:
 *
 *     Y (from in), Z.., X (to out), W..   --->   X Y next to each other, Z.., W..
 *
 * Writes HE_GAP_LINKS links at most. */
enum { HE_GAP_LINKS = 6 };
void he_ring_close_gap(he_mesh *m, he_halfedge in, he_halfedge out);

#endif
