/* seam_weld.c - implements edge_weld of seam.h, which merges two boundary edges. */
#include "edit/border/seam.h"
#include "edit/local/cut.h"
#include "edit/piece/keep.h"
#include "edit/piece/point.h"
#include "edit/piece/ring.h"
#include "mesh/marks.h"

/* Two vertices that a weld of edges a and b merges: `goes`, an end of b, is merged into `stays`, an
 * end of a. If the edges share this end, `goes` is equal to `stays`. Each edge has one boundary
 * half-edge: `in` is the one that arrives at this end, `out` the one that leaves it. */
typedef struct pair {
    he_vertex stays, goes;
    he_halfedge in, out;
} pair;

/* Returns the boundary half-edge of edge e, which is the one without a face. */
static he_halfedge outer(const he_mesh *m, he_edge e)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    return he_is_boundary_halfedge(m, h) ? h : he_twin(h);
}

static he_status require_boundary(const he_mesh *m, he_edge e, he_error *err)
{
    he_status status = he_mesh_require(m, HE_EDGE, e.i, err);
    if (status == HE_OK && !he_is_boundary_edge(m, e)) {
        return he_fail(err, HE_NOT_BOUNDARY, HE_EDGE, e.i,
                       "edge %u is not on a boundary: it has two faces", e.i);
    }
    return status;
}

/* Checks that the two vertices of `end` can be merged: no face may have both as corners, and no
 * vertex may be a neighbour of both, unless edge a joins one of them to it and edge b the other
 * one. */
static he_status check_merge(const he_mesh *m, const pair *end, he_edge a, he_edge b, he_error *err)
{
    he_vertex v = end->stays, w = end->goes;
    he_halfedge first = he_vertex_halfedge(m, w), h = first;
    do {
        he_face f = he_face_of(m, h);
        if (f.i != HE_NONE && he_face_corner(m, f, v).i != HE_NONE) {
            return he_fail(
                err, HE_REPEATED_CORNER, HE_FACE, f.i,
                "face %u has vertices %u and %u as corners, which would become one vertex", f.i,
                v.i, w.i);
        }
        he_halfedge other = he_find_halfedge(m, v, he_target(m, h));
        if (other.i != HE_NONE && !(he_edge_of(other).i == a.i && he_edge_of(h).i == b.i)) {
            return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(h).i,
                           "edges %u and %u would join the same vertices", he_edge_of(other).i,
                           he_edge_of(h).i);
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return HE_OK;
}

static he_status check_end(const he_mesh *m, const pair *end, he_edge a, he_edge b, he_error *err)
{
    if (end->stays.i != end->goes.i) {
        return check_merge(m, end, a, b, err);
    }
    if (he_next(m, end->in).i != end->out.i && he_ring_fan_end(m, end->in).i == end->out.i) {
        return he_fail(err, HE_CLOSED_FAN, HE_VERTEX, end->stays.i,
                       "a closed fan of faces would form around vertex %u, which also belongs to "
                       "%u other fans of faces",
                       end->stays.i, he_vertex_fans(m, end->stays) - 1);
    }
    return HE_OK;
}

static he_vec3 place_of(const he_mesh *m, const pair *end, he_keep keep)
{
    he_vec3 a = he_position(m, end->stays), b = he_position(m, end->goes);
    return keep == HE_KEEP_A ? a : keep == HE_KEEP_B ? b : he_point_between(a, b, 0.5);
}

static he_status check_locks(const he_mesh *m, const pair *end, he_keep keep, he_error *err)
{
    he_marks marks;
    if (end->stays.i == end->goes.i || !he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_vec3 from = he_position(m, end->stays), to = place_of(m, end, keep);
    he_status status = he_require_unlocked(&marks, HE_VERTEX, end->goes.i, err);
    if (status == HE_OK && (from.x != to.x || from.y != to.y || from.z != to.z)) {
        status = he_require_unlocked(&marks, HE_VERTEX, end->stays.i, err);
    }
    return status == HE_OK
               ? he_require_unlocked_about(m, &marks, he_vertex_halfedge(m, end->goes), err)
               : status;
}

static he_status check(const he_mesh *m, he_edge a, he_edge b, he_keep keep, pair ends[2],
                       he_error *err)
{
    he_status status = require_boundary(m, a, err);
    if (status == HE_OK) {
        status = require_boundary(m, b, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (a.i == b.i) {
        return he_fail(err, HE_REPEATED_ELEMENT, HE_EDGE, a.i,
                       "\"a\" and \"b\" are the same edge, %u", a.i);
    }
    he_halfedge h = outer(m, a), k = outer(m, b);
    ends[0] = (pair){he_target(m, h), he_origin(m, k), h, k};
    ends[1] = (pair){he_origin(m, h), he_target(m, k), k, h};
    if (ends[0].stays.i == ends[1].goes.i || ends[1].stays.i == ends[0].goes.i) {
        he_face f = he_face_of(m, he_twin(h));
        bool begin = ends[1].stays.i == ends[0].goes.i;
        return he_fail(err, HE_REPEATED_CORNER, HE_FACE, f.i,
                       "the boundary half-edges of edges %u and %u both %s at vertex %u: welding "
                       "would join the ends of edge %u, and face %u would use one vertex twice",
                       a.i, b.i, begin ? "begin" : "end", (begin ? ends[1] : ends[0]).stays.i, a.i,
                       f.i);
    }
    for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
        status = check_end(m, &ends[i], a, b, err);
    }
    for (unsigned i = 0; i < 2 && status == HE_OK; i++) {
        status = check_locks(m, &ends[i], keep, err);
    }
    return status;
}

/* Moves all edges and faces at vertex end->goes to vertex end->stays. */
static void merge(he_mesh *m, const pair *end, he_keep keep)
{
    he_halfedge first = he_vertex_halfedge(m, end->goes), h = first;
    do {
        he_halfedge next = he_swing_ccw(m, h);
        he_set_origin(m, h, end->stays);
        h = next;
    } while (h.i != first.i);
    he_set_position(m, end->stays, place_of(m, end, keep));
    he_note_merged(m, HE_VERTEX, end->goes.i, end->stays.i);
}

static void commit(he_mesh *m, he_edge a, he_edge b, he_keep keep, const pair ends[2])
{
    he_halfedge h = outer(m, a), k = he_twin(outer(m, b));
    he_face f = he_face_of(m, k);
    for (unsigned i = 0; i < 2; i++) {
        const pair *end = &ends[i];
        if (end->stays.i != end->goes.i) {
            merge(m, end, keep);
        } else {
            he_ring_close_gap(m, end->in, end->out);
        }
    }
    for (unsigned i = 0; i < 2; i++) {
        he_halfedge after = he_next(m, ends[i].in), before = he_prev(m, ends[i].out);
        if (after.i != ends[i].out.i) {
            he_link(m, before, after);
        }
    }
    he_link(m, he_prev(m, k), h);
    he_link(m, h, he_next(m, k));
    he_set_face(m, h, f);
    if (he_face_halfedge(m, f).i == k.i) {
        he_set_face_halfedge(m, f, h);
    }
    he_attributes_move(m, HE_HALFEDGE, h.i, k.i);
    he_note_merged(m, HE_EDGE, b.i, a.i);
    he_delete_edge(m, b);
    for (unsigned i = 0; i < 2; i++) {
        if (ends[i].stays.i != ends[i].goes.i) {
            he_delete_vertex(m, ends[i].goes);
        }
    }
    he_ring_settle(m, ends[0].stays, he_twin(h));
    he_ring_settle(m, ends[1].stays, h);
}

static he_status reserve(he_mesh *m, const pair ends[2], he_error *err)
{
    he_reservation need = {.deleted_edges = 1, .lineage = 3, .attributes = 1};
    need.links = 10 + 2 * (HE_GAP_LINKS + HE_SETTLE_LINKS);
    for (unsigned i = 0; i < 2; i++) {
        if (ends[i].stays.i != ends[i].goes.i) {
            need.deleted_vertices++;
            need.positions++;
            need.links += he_vertex_degree(m, ends[i].goes);
        }
    }
    return he_reserve(m, need, err);
}

he_status he_edge_weld(he_mesh *m, he_edge a, he_edge b, he_keep keep, uint64_t *moved,
                       he_error *err)
{
    pair ends[2];
    he_status status = check(m, a, b, keep, ends, err);
    if (status != HE_OK) {
        return status;
    }
    const uint32_t gone[2] = {ends[0].goes.i, ends[1].goes.i};
    const uint32_t into[2] = {ends[0].stays.i, ends[1].stays.i};
    const he_keep_pairs pairs = {gone, into, 2};
    he_keeping kept;
    status = he_keep_begin(m, &pairs, &kept, err);
    if (status != HE_OK) {
        return status;
    }
    status = reserve(m, ends, err);
    if (status == HE_OK) {
        /* Nothing below can fail. */
        commit(m, a, b, keep, ends);
    }
    return he_keep_end(m, &kept, status, moved);
}
