#include "edit/local/split_corners.h"

#include "edit/piece/ring.h"

static he_status check(const he_mesh *m, he_halfedge a, he_halfedge b, he_error *err)
{
    he_status status = he_mesh_require(m, HE_HALFEDGE, a.i, err);
    if (status == HE_OK) {
        status = he_mesh_require(m, HE_HALFEDGE, b.i, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (a.i == b.i) {
        return he_fail(err, HE_SAME_CORNER, HE_HALFEDGE, a.i,
                       "\"a\" and \"b\" are the same half-edge, %u", a.i);
    }
    if (he_origin(m, a).i != he_origin(m, b).i) {
        return he_fail(err, HE_DIFFERENT_ORIGINS, HE_HALFEDGE, b.i,
                       "half-edge %u leaves vertex %u, not vertex %u", b.i, he_origin(m, b).i,
                       he_origin(m, a).i);
    }
    if (he_is_boundary_halfedge(m, he_twin(a)) && he_is_boundary_halfedge(m, he_twin(b))) {
        return he_fail(
            err, HE_NO_FACE, HE_VERTEX, he_origin(m, a).i,
            "both corners at vertex %u lie on the boundary, so the new edge would have no face",
            he_origin(m, a).i);
    }
    return HE_OK;
}

/* Inserts half-edge h into a loop, between half-edge `enters` and the half-edge that follows
 * `enters`. Half-edge h gets the face of `enters` and the attributes of the corner between them. */
static void into_corner(he_mesh *m, he_halfedge enters, he_halfedge h)
{
    he_halfedge leaves = he_next(m, enters);
    he_link(m, enters, h);
    he_link(m, h, leaves);
    he_set_face(m, h, he_face_of(m, enters));
    if (!he_is_boundary_halfedge(m, h)) {
        he_attributes_copy(m, HE_HALFEDGE, h.i, leaves.i);
    }
}

he_status he_vertex_split_corners(he_mesh *m, he_halfedge a, he_halfedge b, he_vertex *vertex,
                                  he_edge *edge, he_error *err)
{
    he_status status = check(m, a, b, err);
    if (status != HE_OK) {
        return status;
    }
    he_reservation need = {
        .vertices = 1, .edges = 1, .links = 4 + 2 * HE_SETTLE_LINKS, .lineage = 1};
    for (he_halfedge k = a; k.i != b.i; k = he_swing_ccw(m, k)) {
        need.links++;
    }
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_vertex v = he_origin(m, a), u = he_new_vertex(m);
    he_halfedge h = he_edge_halfedge(he_new_edge(m), 0), back = he_twin(h);
    he_set_position(m, u, he_position(m, v));
    he_attributes_copy(m, HE_VERTEX, u.i, v.i);
    he_note_parent(m, HE_VERTEX, u.i, v.i);
    for (he_halfedge k = a; k.i != b.i; k = he_swing_ccw(m, k)) {
        he_set_origin(m, k, u);
    }
    he_set_origin(m, h, u);
    he_set_origin(m, back, v);
    into_corner(m, he_twin(a), h);
    into_corner(m, he_twin(b), back);
    he_ring_settle(m, u, h);
    he_ring_settle(m, v, back);
    if (vertex != NULL) {
        *vertex = u;
    }
    if (edge != NULL) {
        *edge = he_edge_of(h);
    }
    return HE_OK;
}
