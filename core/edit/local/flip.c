#include "edit/local/flip.h"

#include "edit/local/cut.h"
#include "mesh/marks.h"

/* Checks that the origin of h, which loses one edge by the flip, keeps at least three edges or is
 * on the boundary. Three steps around the vertex decide whether its degree is at least 4; a walk
 * around the whole vertex would be slow at a vertex with many edges. */
static he_status check_end(const he_mesh *m, he_halfedge h, he_error *err)
{
    he_halfedge second = he_swing_ccw(m, he_swing_ccw(m, h));
    he_vertex v = he_origin(m, h);
    if ((second.i != h.i && second.i != he_swing_cw(m, h).i) || he_is_boundary_vertex(m, v)) {
        return HE_OK;
    }
    return he_fail(err, HE_LOW_DEGREE, HE_VERTEX, v.i,
                   "vertex %u has degree %u, which is too low for it to lose edge %u", v.i,
                   second.i == h.i ? 2u : 3u, he_edge_of(h).i);
}

static he_status check_marks(const he_mesh *m, he_edge e, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    if (he_is_feature(&marks, e)) {
        return he_fail(err, HE_FEATURE_EDGE, HE_EDGE, e.i, "edge %u is a feature edge", e.i);
    }
    he_halfedge h = he_edge_halfedge(e, 0);
    he_status status = he_require_unlocked(&marks, HE_EDGE, e.i, err);
    if (status == HE_OK) {
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, h).i, err);
    }
    if (status == HE_OK) {
        status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, he_twin(h)).i, err);
    }
    return status;
}

static he_status check(const he_mesh *m, he_edge e, he_error *err)
{
    he_prefetch_links(m, he_edge_halfedge(e, 0));
    if (!he_edge_is_live(m, e)) {
        return he_mesh_require(m, HE_EDGE, e.i, err);
    }
    he_prefetch_about(m, e);
    if (he_is_boundary_edge(m, e)) {
        return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i, "edge %u has only one face", e.i);
    }
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    he_vertex c = he_target(m, he_next(m, h)), d = he_target(m, he_next(m, t));
    if (c.i == d.i) {
        return he_fail(err, HE_SAME_ENDS, HE_EDGE, e.i,
                       "both ends of edge %u would become vertex %u", e.i, c.i);
    }
    he_status status = check_end(m, h, err);
    if (status == HE_OK) {
        status = check_end(m, t, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* The search for an edge from c to d walks in both directions around c. It starts at
     * the half-edge twin(next(h)), which leaves c on the border of face(h), so it finds an edge of
     * that face or of a face next to it after few steps. */
    he_halfedge joined = he_find_halfedge_from(m, he_twin(he_next(m, h)), d);
    if (joined.i != HE_NONE) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(joined).i,
                       "edge %u already joins vertices %u and %u", he_edge_of(joined).i, c.i, d.i);
    }
    he_face f = he_face_of(m, h), g = he_face_of(m, t);
    /* Edge e joins vertices a and b. If face f is a triangle, its corners are a, b and c, so d is
     * not among them. */
    if (!he_is_triangle(m, h) && he_face_corner(m, f, d).i != HE_NONE) {
        return he_fail(err, HE_REPEATED_CORNER, HE_FACE, f.i, "face %u would use vertex %u twice",
                       f.i, d.i);
    }
    if (!he_is_triangle(m, t) && he_face_corner(m, g, c).i != HE_NONE) {
        return he_fail(err, HE_REPEATED_CORNER, HE_FACE, g.i, "face %u would use vertex %u twice",
                       g.i, c.i);
    }
    return check_marks(m, e, err);
}

/* Moves the origin of h from its vertex a to the next corner of the face of twin(h), which loses
 * the corner at a. `side` is the half-edge that follows twin(h); it moves into the face of h. */
static void turn_end(he_mesh *m, he_halfedge h, he_halfedge side)
{
    he_vertex a = he_origin(m, h);
    he_face g = he_face_of(m, side);
    if (he_vertex_halfedge(m, a).i == h.i) {
        he_set_vertex_halfedge(m, a, side);
    }
    if (he_face_halfedge(m, g).i == side.i) {
        he_set_face_halfedge(m, g, he_twin(h));
    }
    he_set_face(m, side, he_face_of(m, h));
    he_set_origin(m, h, he_target(m, side));
}

he_status he_edge_flip(he_mesh *m, he_edge e, he_error *err)
{
    he_status status = check(m, e, err);
    if (status == HE_OK) {
        status = he_reserve(m, (he_reservation){.links = 20, .attributes = 2}, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge h = he_edge_halfedge(e, 0), t = he_twin(h);
    he_halfedge from_b = he_next(m, h), from_a = he_next(m, t);
    he_halfedge before_h = he_prev(m, h), before_t = he_prev(m, t);
    he_halfedge from_c = he_next(m, from_b), from_d = he_next(m, from_a);
    turn_end(m, h, from_a);
    turn_end(m, t, from_b);
    he_link(m, before_h, from_a);
    he_link(m, from_a, h);
    he_link(m, h, from_c);
    he_link(m, before_t, from_b);
    he_link(m, from_b, t);
    he_link(m, t, from_d);
    he_attributes_move(m, HE_HALFEDGE, h.i, from_d.i);
    he_attributes_move(m, HE_HALFEDGE, t.i, from_c.i);
    return HE_OK;
}
