#include "edit/bevel/vertex_bevel.h"

#include "edit/bevel/bevel.h"
#include "edit/piece/point.h"
#include "mesh/marks.h"
#include "mesh/write.h"

static he_status check_locks(const he_mesh *m, he_vertex v, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_status status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
    return status == HE_OK ? he_require_unlocked_about(m, &marks, he_vertex_halfedge(m, v), err)
                           : status;
}

static he_status check(const he_mesh *m, he_vertex v, double width, he_error *err)
{
    he_status status = he_mesh_require(m, HE_VERTEX, v.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (!(width > 0)) {
        return he_fail(err, HE_BAD_VALUE, HE_VERTEX, v.i, "the width must be above 0, not %g",
                       width);
    }
    if (he_is_boundary_vertex(m, v)) {
        return he_fail(err, HE_BOUNDARY_VERTEX, HE_VERTEX, v.i, "vertex %u is on the boundary",
                       v.i);
    }
    if (he_vertex_degree(m, v) < 3) {
        return he_fail(err, HE_LOW_DEGREE, HE_VERTEX, v.i, "vertex %u has only two edges", v.i);
    }
    return check_locks(m, v, err);
}

/* Makes the edge that cuts the corner at the bevelled vertex off the face of h. Half-edges h and
 * `following` leave the vertex along this face and are cut at the fractions t and s of their
 * lengths. The caller sets the ends of the new edge. Returns its half-edge that has no face yet. */
static he_halfedge cut_corner(he_mesh *m, he_halfedge h, he_halfedge following, double t, double s)
{
    he_halfedge in = he_twin(following), out = he_edge_halfedge(he_new_edge(m), 0);
    he_halfedge inner = he_twin(out);
    he_set_face(m, inner, he_face_of(m, h));
    he_attributes_between(m, HE_HALFEDGE, inner.i, h.i, in.i, s);
    he_attributes_mix(m, HE_HALFEDGE, h.i, he_next(m, h).i, 1 - t);
    he_link(m, in, inner);
    he_link(m, inner, h);
    return out;
}

/* Moves vertex w to the point at fraction t of the length of half-edge h, which leaves vertex v; w
 * may be v itself. */
static void move(he_mesh *m, he_vertex w, he_vertex v, he_halfedge h, double t)
{
    he_vertex far = he_target(m, h);
    he_set_position(m, w, he_point_between(he_position(m, v), he_position(m, far), t));
    if (w.i == v.i) {
        he_attributes_mix(m, HE_VERTEX, v.i, far.i, 1 - t);
    } else {
        he_attributes_between(m, HE_VERTEX, w.i, v.i, far.i, t);
    }
}

static void add(he_ids *list, uint32_t id)
{
    if (list != NULL) {
        list->ids[list->count++] = id;
    }
}

static he_face commit(he_mesh *m, he_vertex v, double width, he_ids *vertices, he_ids *edges)
{
    he_halfedge first = he_vertex_halfedge(m, v), h = first, before = {HE_NONE};
    he_halfedge start = {HE_NONE};
    double at_first = he_bevel_part(m, first, width), t = at_first;
    he_vertex w = v;
    he_face f = he_new_face(m);
    do {
        /* After the last edge at v, the first edge follows again; at_first is where it is cut.
         * Vertex v itself moves only after this loop, because the loop computes points from the
         * position of v. */
        he_halfedge following = he_swing_ccw(m, h);
        double s = following.i == first.i ? at_first : he_bevel_part(m, following, width);
        he_halfedge out = cut_corner(m, h, following, t, s);
        he_set_origin(m, out, w);
        he_set_face(m, out, f);
        add(edges, he_edge_of(out).i);
        if (before.i == HE_NONE) {
            start = out;
        } else {
            he_set_origin(m, h, w);
            he_set_vertex_halfedge(m, w, h);
            he_set_origin(m, he_twin(before), w);
            he_link(m, before, out);
        }
        if (following.i != first.i) {
            w = he_new_vertex(m);
            move(m, w, v, following, s);
            he_note_parent(m, HE_VERTEX, w.i, v.i);
            add(vertices, w.i);
        }
        before = out;
        h = following;
        t = s;
    } while (h.i != first.i);
    he_set_origin(m, he_twin(before), v);
    he_link(m, before, start);
    move(m, v, v, first, at_first);
    he_set_face_halfedge(m, f, start);
    return f;
}

he_status he_vertex_bevel(he_mesh *m, he_vertex v, double width, he_ids *vertices, he_ids *edges,
                          he_face *face, he_error *err)
{
    he_status status = check(m, v, width, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t degree = he_vertex_degree(m, v);
    he_reservation need = {.vertices = degree - 1, .edges = degree, .faces = 1};
    need.links = 3 * (size_t)degree;
    need.positions = 1;
    need.attributes = (size_t)degree + 1;
    need.lineage = degree - 1;
    if (vertices != NULL) {
        status = he_ids_reserve(vertices, degree - 1, err);
    }
    if (status == HE_OK && edges != NULL) {
        status = he_ids_reserve(edges, degree, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_face made = commit(m, v, width, vertices, edges);
    if (face != NULL) {
        *face = made;
    }
    return HE_OK;
}
