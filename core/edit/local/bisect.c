#include "edit/local/bisect.h"

#include "edit/piece/point.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"

void he_bisect_reservation(he_reservation *need)
{
    need->vertices++;
    need->edges++;
    /* A bisection writes at most seven links of existing elements: four next and prev links, one
     * origin, and the half-edges that a vertex and a face store. 16 is a safe upper bound. */
    need->links += 16;
    need->attributes += 2;
    need->lineage++;
}

he_halfedge he_bisect_commit(he_mesh *m, he_edge e, double t)
{
    he_halfedge h = he_edge_halfedge(e, 0), back = he_twin(h);
    he_halfedge next = he_next(m, h), before = he_prev(m, back);
    he_vertex a = he_origin(m, h), b = he_target(m, h);
    he_face left = he_face_of(m, h), right = he_face_of(m, back);

    he_vertex w = he_new_vertex(m);
    he_edge part = he_new_edge(m);
    he_halfedge on = he_edge_halfedge(part, 0), off = he_twin(on);
    he_set_position(m, w, he_point_between(he_position(m, a), he_position(m, b), t));
    he_set_origin(m, back, w);
    he_set_halfedge(m, on, next, h, w, left);
    he_set_halfedge(m, off, back, before, b, right);
    he_set_next(m, h, on);
    he_set_prev(m, next, on);
    he_set_next(m, before, off);
    he_set_prev(m, back, off);
    he_set_vertex_halfedge(m, w, right.i == HE_NONE ? back : on);
    if (he_vertex_halfedge(m, b).i == back.i) {
        he_set_vertex_halfedge(m, b, off);
    }
    if (right.i != HE_NONE && he_face_halfedge(m, right).i == back.i) {
        he_set_face_halfedge(m, right, off);
    }

    he_attributes_between(m, HE_VERTEX, w.i, a.i, b.i, t);
    he_attributes_copy(m, HE_EDGE, part.i, e.i);
    if (left.i != HE_NONE) {
        he_attributes_between(m, HE_HALFEDGE, on.i, h.i, next.i, t);
    }
    if (right.i != HE_NONE) {
        /* The attributes of a corner are stored with the half-edge that leaves it. The corner at
         * vertex b is now left by half-edge `off` instead of `back`, so its attributes move. */
        he_attributes_move(m, HE_HALFEDGE, off.i, back.i);
        he_attributes_between(m, HE_HALFEDGE, back.i, he_next(m, back).i, off.i, t);
    }
    he_note_parent(m, HE_EDGE, part.i, e.i);
    return on;
}

he_status he_edge_bisect(he_mesh *m, he_edge e, double t, he_vertex *vertex, he_edge *edge,
                         he_error *err)
{
    he_status status = he_mesh_require(m, HE_EDGE, e.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (!(t > 0 && t < 1)) {
        return he_fail(err, HE_BAD_VALUE, HE_EDGE, e.i, "\"t\" must be between 0 and 1, not %g", t);
    }
    he_reservation need = {0};
    he_bisect_reservation(&need);
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge on = he_bisect_commit(m, e, t);
    if (vertex != NULL) {
        *vertex = he_origin(m, on);
    }
    if (edge != NULL) {
        *edge = he_edge_of(on);
    }
    return HE_OK;
}

static he_status check_join(const he_mesh *m, he_vertex v, he_error *err)
{
    he_status status = he_mesh_require(m, HE_VERTEX, v.i, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t degree = he_vertex_degree(m, v);
    if (degree != 2) {
        return he_fail(err, HE_WRONG_DEGREE, HE_VERTEX, v.i, "vertex %u has degree %u, not 2", v.i,
                       degree);
    }
    he_halfedge one = he_vertex_halfedge(m, v), other = he_swing_ccw(m, one);
    const he_halfedge sides[2] = {one, other};
    for (unsigned i = 0; i < 2; i++) {
        he_face f = he_face_of(m, sides[i]);
        if (f.i != HE_NONE && he_loop_length(m, sides[i]) == 3) {
            return he_fail(err, HE_TRIANGLE_SIDE, HE_FACE, f.i,
                           "face %u is a triangle, and would lose its corner at vertex %u", f.i,
                           v.i);
        }
    }
    he_halfedge joined = he_find_halfedge(m, he_target(m, one), he_target(m, other));
    if (joined.i != HE_NONE) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(joined).i,
                       "edge %u already joins vertices %u and %u", he_edge_of(joined).i,
                       he_target(m, one).i, he_target(m, other).i);
    }
    he_marks marks;
    if (he_marks_find(m, &marks)) {
        status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
        for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
            status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(sides[i]).i, err);
            if (status == HE_OK) {
                status = he_require_unlocked(&marks, HE_FACE, he_face_of(m, sides[i]).i, err);
            }
        }
    }
    return status;
}

he_status he_edge_join(he_mesh *m, he_vertex v, he_edge *edge, he_error *err)
{
    he_status status = check_join(m, v, err);
    if (status == HE_OK) {
        status = he_reserve(m,
                            (he_reservation){.deleted_vertices = 1,
                                             .deleted_edges = 1,
                                             .links = 8,
                                             .attributes = 2,
                                             .lineage = 1},
                            err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge kept = he_vertex_halfedge(m, v), gone = he_swing_ccw(m, kept);
    if (gone.i < kept.i) {
        he_halfedge swap = kept;
        kept = gone;
        gone = swap;
    }
    /* Half-edge `kept` runs from v to a, and `gone` from v to b. After the join, `kept` runs from b
     * to a. It replaces two consecutive half-edges of its loop: twin(gone) and `kept` itself. */
    he_halfedge to_v = he_twin(gone), in = he_twin(kept);
    he_vertex b = he_target(m, gone);
    he_face right = he_face_of(m, gone), left = he_face_of(m, kept);
    he_link(m, in, he_next(m, gone));
    he_link(m, he_prev(m, to_v), kept);
    he_set_origin(m, kept, b);
    if (he_vertex_halfedge(m, b).i == to_v.i) {
        he_set_vertex_halfedge(m, b, kept);
    }
    if (right.i != HE_NONE && he_face_halfedge(m, right).i == gone.i) {
        he_set_face_halfedge(m, right, he_next(m, in));
    }
    if (left.i != HE_NONE && he_face_halfedge(m, left).i == to_v.i) {
        he_set_face_halfedge(m, left, kept);
    }
    he_attributes_move(m, HE_HALFEDGE, kept.i, to_v.i);
    he_attributes_merge(m, HE_EDGE, he_edge_of(kept).i, he_edge_of(gone).i, 0.5);
    he_note_merged(m, HE_EDGE, he_edge_of(gone).i, he_edge_of(kept).i);
    he_delete_edge(m, he_edge_of(gone));
    he_delete_vertex(m, v);
    if (edge != NULL) {
        *edge = he_edge_of(kept);
    }
    return HE_OK;
}
