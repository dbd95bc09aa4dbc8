#include "edit/local/face_add.h"

#include "edit/piece/list.h"
#include "edit/piece/ring.h"

/* Finds the boundary half-edge that runs from vertex a to vertex b. Sets *out to HE_NONE if no edge
 * joins a and b. Refuses if the half-edge from a to b has a face. */
static he_status find_side(const he_mesh *m, he_vertex a, he_vertex b, uint32_t *out, he_error *err)
{
    he_halfedge h = he_find_halfedge(m, a, b);
    if (h.i != HE_NONE && !he_is_boundary_halfedge(m, h)) {
        uint32_t e = he_edge_of(h).i;
        if (he_is_boundary_halfedge(m, he_twin(h))) {
            return he_fail(
                err, HE_ORIENTATION, HE_EDGE, e,
                "face %u already has the side from vertex %u to %u: reverse the new face",
                he_face_of(m, h).i, a.i, b.i);
        }
        return he_fail(err, HE_NONMANIFOLD_EDGE, HE_EDGE, e,
                       "edge %u from vertex %u to %u already has two faces", e, a.i, b.i);
    }
    *out = h.i;
    return HE_OK;
}

static he_status check_corner(const he_mesh *m, uint32_t in, uint32_t out, he_error *err)
{
    if (in == HE_NONE || out == HE_NONE || m->c.next[in] == out ||
        he_ring_fan_end(m, (he_halfedge){in}).i != out) {
        return HE_OK;
    }
    uint32_t v = m->c.origin[out];
    return he_fail(err, HE_CLOSED_FAN, HE_VERTEX, v,
                   "a closed fan of faces would form around vertex %u, which also belongs to %u "
                   "other fans of faces",
                   v, he_vertex_fans(m, (he_vertex){v}) - 1);
}

/* Checks the vertices of the new face. Fills sides[i] with the existing half-edge from vertices[i]
 * to the next vertex of the face, or with HE_NONE if there is no such half-edge. */
static he_status check(const he_mesh *m, const uint32_t *vertices, size_t n, uint32_t *sides,
                       he_error *err)
{
    for (size_t i = 0; i < n; i++) {
        if (!he_is_boundary_vertex(m, (he_vertex){vertices[i]})) {
            return he_fail(err, HE_INTERIOR_VERTEX, HE_VERTEX, vertices[i],
                           "vertex %u is surrounded by faces", vertices[i]);
        }
    }
    for (size_t i = 0; i < n; i++) {
        he_status status = find_side(m, (he_vertex){vertices[i]},
                                     (he_vertex){vertices[i + 1 == n ? 0 : i + 1]}, &sides[i], err);
        if (status != HE_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < n; i++) {
        he_status status = check_corner(m, sides[i == 0 ? n - 1 : i - 1], sides[i], err);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

/* Links two consecutive sides of the new face: `in` arrives at vertex v, `out` leaves v. Each of
 * the two may be a new half-edge that has no links yet. Links at other vertices are not written. */
static void link_corner(he_mesh *m, he_vertex v, he_halfedge in, bool in_is_new, he_halfedge out,
                        bool out_is_new)
{
    he_halfedge outer_in = he_twin(in), outer_out = he_twin(out);
    if (!in_is_new && !out_is_new) {
        he_ring_close_gap(m, in, out);
    } else if (!in_is_new) {
        he_link(m, outer_out, he_next(m, in));
        he_link(m, in, out);
    } else if (!out_is_new) {
        he_link(m, he_prev(m, out), outer_in);
        he_link(m, in, out);
    } else {
        he_halfedge stored = he_vertex_halfedge(m, v);
        if (stored.i == HE_NONE) {
            he_link(m, outer_out, outer_in);
        } else {
            he_link(m, he_prev(m, stored), outer_in);
            he_link(m, outer_out, stored);
        }
        he_link(m, in, out);
    }
}

/* Makes vertex v store a boundary half-edge, as invariant I8 of mesh.h demands, if one leaves v. */
static void store_boundary(he_mesh *m, he_vertex v, he_halfedge in, bool in_is_new, he_halfedge out)
{
    he_halfedge stored = he_vertex_halfedge(m, v);
    if (stored.i == HE_NONE || (in_is_new && stored.i == out.i)) {
        he_set_vertex_halfedge(m, v, he_twin(in));
    } else if (stored.i == out.i) {
        he_halfedge h = he_swing_ccw(m, out);
        while (h.i != out.i && !he_is_boundary_halfedge(m, h)) {
            h = he_swing_ccw(m, h);
        }
        if (h.i != out.i) {
            he_set_vertex_halfedge(m, v, h);
        }
    }
}

static void commit(he_mesh *m, const uint32_t *vertices, size_t n, uint32_t *sides, he_face *out,
                   he_ids *edges)
{
    /* The half-edges with ids from `old` up are made by this call. */
    uint32_t old = 2 * m->c.edges.issued;
    for (size_t i = 0; i < n; i++) {
        if (sides[i] == HE_NONE) {
            he_edge e = he_new_edge(m);
            he_halfedge h = he_edge_halfedge(e, 0);
            he_set_origin(m, h, (he_vertex){vertices[i]});
            he_set_origin(m, he_twin(h), (he_vertex){vertices[i + 1 == n ? 0 : i + 1]});
            he_set_face(m, he_twin(h), (he_face){HE_NONE});
            sides[i] = h.i;
            if (edges != NULL) {
                edges->ids[edges->count++] = e.i;
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        he_halfedge in = {sides[i == 0 ? n - 1 : i - 1]}, side = {sides[i]};
        link_corner(m, (he_vertex){vertices[i]}, in, in.i >= old, side, side.i >= old);
    }
    he_face f = he_new_face(m);
    he_set_face_halfedge(m, f, (he_halfedge){sides[0]});
    for (size_t i = 0; i < n; i++) {
        he_set_face(m, (he_halfedge){sides[i]}, f);
    }
    for (size_t i = 0; i < n; i++) {
        he_halfedge in = {sides[i == 0 ? n - 1 : i - 1]}, side = {sides[i]};
        store_boundary(m, (he_vertex){vertices[i]}, in, in.i >= old, side);
    }
    if (out != NULL) {
        *out = f;
    }
}

he_status he_face_add(he_mesh *m, const uint32_t *vertices, size_t count, he_face *out,
                      he_ids *edges, he_error *err)
{
    if (count < 3) {
        return he_fail_plain(err, HE_TOO_FEW_CORNERS, "a face needs at least 3 corners, not %zu",
                             count);
    }
    he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_CORNER, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t *sides = he_mem_array(NULL, count, sizeof *sides);
    if (sides == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a face of %zu corners", count);
    }
    status = check(m, vertices, count, sides, err);
    if (status != HE_OK) {
        goto out;
    }
    he_reservation need = {.faces = 1, .links = 8 * count};
    for (size_t i = 0; i < count; i++) {
        need.edges += sides[i] == HE_NONE;
    }
    status = edges == NULL ? HE_OK : he_ids_reserve(edges, need.edges, err);
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, vertices, count, sides, out, edges);
    }
out:
    he_mem_free(sides);
    return status;
}
