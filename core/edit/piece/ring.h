/* ring.h - maintains the ring of a vertex: its stored half-edge (I8) and the chain of its fans. */
#ifndef HE_EDIT_PIECE_RING_H
#define HE_EDIT_PIECE_RING_H

#include "mesh/write.h"

/* Links that one call writes, for he_need. */
enum { HE_SETTLE_LINKS = 1 };

/* Makes halfedge(v) satisfy I8, given `leaving`, any half-edge that leaves v. The stored one stays
 * if it may. Called in COMMIT, once all links, origins and faces at v are final. Walks around v
 * only if the stored half-edge does not satisfy I8 evidently. */
void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving);

/* Returns the boundary half-edge that leaves the target of `in`, a boundary half-edge, and ends the
 * fan that begins there. Costs the fan. */
he_halfedge he_ring_fan_end(const he_mesh *m, he_halfedge in);

/* Makes `out` follow `in`. They are boundary half-edges that end and begin different fans, or the
 * only fan, at a vertex. The fans between them move to the gap behind the fan that begins at `in`:
 *
 *     Y (from in), Z.., X (to out), W..   --->   X Y next to each other, Z.., W..
 *
 * Writes HE_GAP_LINKS links at most. */
enum { HE_GAP_LINKS = 6 };
void he_ring_close_gap(he_mesh *m, he_halfedge in, he_halfedge out);

#endif
