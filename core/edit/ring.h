/* ring.h - keeping the half-edge a vertex stores right (I8) after the ring about it changed. */
#ifndef HE_EDIT_RING_H
#define HE_EDIT_RING_H

#include "mesh/write.h"

/* Links of one call, for he_need. */
enum { HE_SETTLE_LINKS = 1 };

/* Make halfedge(v) what I8 asks, given `leaving`, any half-edge that leaves v. The stored one stays
 * wherever it may. Called in COMMIT, once all links, origins and faces about v are final. Turns
 * about v only when the stored one does not already prove itself. */
void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving);

#endif
