#include "edit/local/vertex_split.h"

#include "edit/piece/point.h"
#include "edit/piece/ring.h"

/* Says where vertex v is split: along the half-edges `left` and `right`, which leave v. One of them
 * is HE_NONE if the caller named the boundary instead of a vertex. After the split, `count`
 * half-edges, counter-clockwise from `first`, leave the new vertex u. */
typedef struct cut {
    he_halfedge left, right;
    he_halfedge first;
    uint32_t count;
} cut;

static he_status find_side(const he_mesh *m, he_vertex v, he_vertex to, he_halfedge *out,
                           he_error *err)
{
    if (to.i == HE_NONE) {
        if (!he_is_boundary_vertex(m, v)) {
            return he_fail(err, HE_NOT_BOUNDARY, HE_VERTEX, v.i,
                           "\"left\" or \"right\" is null, which stands for the boundary, but "
                           "vertex %u is not on the boundary",
                           v.i);
        }
        *out = (he_halfedge){HE_NONE};
        return HE_OK;
    }
    he_status status = he_mesh_require(m, HE_VERTEX, to.i, err);
    if (status != HE_OK) {
        return status;
    }
    *out = he_find_halfedge(m, v, to);
    if (out->i == HE_NONE) {
        return he_fail(err, HE_NOT_NEIGHBOUR, HE_VERTEX, to.i,
                       "vertex %u is not a neighbour of vertex %u", to.i, v.i);
    }
    return HE_OK;
}

static he_status check(const he_mesh *m, he_vertex v, he_vertex left, he_vertex right, he_vec3 to,
                       cut *out, he_error *err)
{
    cut c = {.count = 0};
    he_status status = he_mesh_require(m, HE_VERTEX, v.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (left.i == HE_NONE && right.i == HE_NONE) {
        return he_fail(err, HE_BAD_VALUE, HE_VERTEX, v.i,
                       "\"left\" and \"right\" cannot both be null");
    }
    if (!he_point_is_finite(to)) {
        return he_fail(err, HE_NOT_FINITE, HE_VERTEX, v.i, "the position must be finite");
    }
    if (left.i == right.i) {
        return he_fail(err, HE_REPEATED_ELEMENT, HE_VERTEX, left.i,
                       "\"left\" and \"right\" are both vertex %u", left.i);
    }
    if (he_vertex_fans(m, v) > 1) {
        return he_fail(err, HE_BOWTIE, HE_VERTEX, v.i,
                       "vertex %u is a bow-tie: it has %u fans of faces", v.i,
                       he_vertex_fans(m, v));
    }
    status = find_side(m, v, left, &c.left, err);
    if (status == HE_OK) {
        status = find_side(m, v, right, &c.right, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* A null `left` or `right` stands for the hole at v. Counter-clockwise around v, the fan ends
     * with the boundary half-edge that v stores. Then comes the hole, then the first half-edge of
     * the fan. */
    he_halfedge hole = he_vertex_halfedge(m, v);
    he_halfedge end = c.right.i != HE_NONE ? c.right : he_swing_ccw(m, hole);
    he_halfedge h = he_swing_ccw(m, c.left.i != HE_NONE ? c.left : hole);
    bool sector = c.left.i != HE_NONE && !he_is_boundary_halfedge(m, c.left);
    c.first = h;
    c.count = 0;
    for (; h.i != end.i; h = he_swing_ccw(m, h)) {
        sector |= !he_is_boundary_halfedge(m, h);
        c.count++;
    }
    if (!sector) {
        return he_fail(err, HE_NO_SECTOR, HE_VERTEX, v.i,
                       "no face around vertex %u lies between \"left\" and \"right\", counted "
                       "counter-clockwise",
                       v.i);
    }
    *out = c;
    return HE_OK;
}

static he_halfedge new_edge(he_mesh *m, he_vertex from, he_vertex to)
{
    he_halfedge h = he_edge_halfedge(he_new_edge(m), 0);
    he_set_origin(m, h, from);
    he_set_origin(m, he_twin(h), to);
    return h;
}

/* Replaces half-edge `old` by the new half-edge `made` in the loop of `old`. */
static void replace(he_mesh *m, he_halfedge old, he_halfedge made)
{
    he_face f = he_face_of(m, old);
    he_link(m, he_prev(m, old), made);
    he_link(m, made, he_next(m, old));
    he_set_face(m, made, f);
    if (f.i != HE_NONE && he_face_halfedge(m, f).i == old.i) {
        he_set_face_halfedge(m, f, made);
    }
    he_attributes_move(m, HE_HALFEDGE, made.i, old.i);
}

static he_face new_triangle(he_mesh *m, he_halfedge a, he_halfedge b, he_halfedge c)
{
    he_face f = he_new_face(m);
    he_link(m, a, b);
    he_link(m, b, c);
    he_link(m, c, a);
    he_set_face(m, a, f);
    he_set_face(m, b, f);
    he_set_face(m, c, f);
    he_set_face_halfedge(m, f, a);
    return f;
}

/* Inserts the new boundary half-edge h into the loop of a hole, directly before half-edge
 * `hole`. */
static void into_hole(he_mesh *m, he_halfedge h, he_halfedge hole)
{
    he_link(m, he_prev(m, hole), h);
    he_link(m, h, hole);
    he_set_face(m, h, (he_face){HE_NONE});
}

static void commit(he_mesh *m, he_vertex v, const cut *c, he_vec3 to, he_vertex_parts *out)
{
    he_halfedge hole = he_vertex_halfedge(m, v);
    he_vertex_parts made = {.vertex = he_new_vertex(m)};
    he_vertex u = made.vertex;
    he_set_position(m, u, to);
    he_attributes_copy(m, HE_VERTEX, u.i, v.i);
    he_note_parent(m, HE_VERTEX, u.i, v.i);
    he_halfedge k = c->first;
    for (uint32_t i = 0; i < c->count; i++) {
        he_halfedge next = he_swing_ccw(m, k);
        he_set_origin(m, k, u);
        k = next;
    }
    he_halfedge h = new_edge(m, u, v), back = he_twin(h);
    made.edges[0] = he_edge_of(h);
    if (c->left.i != HE_NONE) {
        he_halfedge side = new_edge(m, u, he_target(m, c->left));
        replace(m, c->left, side);
        he_attributes_copy(m, HE_HALFEDGE, he_twin(side).i, he_next(m, side).i);
        he_attributes_copy(m, HE_HALFEDGE, h.i, side.i);
        he_attributes_copy(m, HE_EDGE, he_edge_of(side).i, he_edge_of(c->left).i);
        he_note_parent(m, HE_EDGE, he_edge_of(side).i, he_edge_of(c->left).i);
        made.faces[made.sides++] = new_triangle(m, h, c->left, he_twin(side));
        made.edges[made.sides] = he_edge_of(side);
    } else {
        into_hole(m, h, hole);
    }
    if (c->right.i != HE_NONE) {
        he_halfedge in = he_twin(c->right), side = new_edge(m, u, he_target(m, c->right));
        he_vertex d = he_origin(m, in);
        replace(m, in, he_twin(side));
        if (he_vertex_halfedge(m, d).i == in.i) {
            he_set_vertex_halfedge(m, d, he_twin(side));
        }
        he_attributes_copy(m, HE_HALFEDGE, side.i, he_next(m, he_twin(side)).i);
        he_attributes_copy(m, HE_HALFEDGE, back.i, c->right.i);
        he_attributes_copy(m, HE_EDGE, he_edge_of(side).i, he_edge_of(c->right).i);
        he_note_parent(m, HE_EDGE, he_edge_of(side).i, he_edge_of(c->right).i);
        made.faces[made.sides++] = new_triangle(m, back, side, in);
        made.edges[made.sides] = he_edge_of(side);
    } else {
        into_hole(m, back, hole);
    }
    he_ring_settle(m, u, h);
    he_ring_settle(m, v, back);
    if (out != NULL) {
        *out = made;
    }
}

he_status he_vertex_split(he_mesh *m, he_vertex v, he_vertex left, he_vertex right, he_vec3 to,
                          he_vertex_parts *out, he_error *err)
{
    cut c = {.count = 0};
    he_status status = check(m, v, left, right, to, &c, err);
    if (status != HE_OK) {
        return status;
    }
    he_reservation need = {.vertices = 1, .edges = 3, .faces = 2, .lineage = 3};
    need.links = (size_t)c.count + 16 + 2 * HE_SETTLE_LINKS;
    status = he_reserve(m, need, err);
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, v, &c, to, out);
    }
    return status;
}
