#include "edit/ring.h"

void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving)
{
    he_halfedge stored = he_vertex_halfedge(m, v);
    /* A dead row's origin is HE_DEAD, so this also sees that the stored half-edge died. */
    bool leaves = stored.i < HE_DEAD && he_origin(m, stored).i == v.i;
    if (leaves && he_is_boundary_halfedge(m, stored)) {
        return;
    }
    he_halfedge h = leaving;
    do {
        if (he_is_boundary_halfedge(m, h)) {
            he_set_vertex_halfedge(m, v, h);
            return;
        }
        h = he_turn_ccw(m, h);
    } while (h.i != leaving.i);
    if (!leaves) {
        he_set_vertex_halfedge(m, v, leaving);
    }
}
