#include "edit/piece/ring.h"

void he_ring_settle(he_mesh *m, he_vertex v, he_halfedge leaving)
{
    he_halfedge stored = he_vertex_halfedge(m, v);
    /* The origin of a deleted half-edge is HE_DEAD, so `leaves` is also false if the stored
     * half-edge was deleted. */
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
        h = he_swing_ccw(m, h);
    } while (h.i != leaving.i);
    if (!leaves) {
        he_set_vertex_halfedge(m, v, leaving);
    }
}

he_halfedge he_ring_fan_end(const he_mesh *m, he_halfedge in)
{
    he_halfedge h = he_twin(in);
    while (!he_is_boundary_halfedge(m, h)) {
        h = he_swing_ccw(m, h);
    }
    return h;
}

void he_ring_close_gap(he_mesh *m, he_halfedge in, he_halfedge out)
{
    he_halfedge after_in = he_next(m, in);
    if (after_in.i == out.i) {
        return;
    }
    he_halfedge before_out = he_prev(m, out), end = he_ring_fan_end(m, in);
    he_halfedge before_end = he_prev(m, end);
    he_link(m, in, out);
    he_link(m, before_out, end);
    he_link(m, before_end, after_in);
}
