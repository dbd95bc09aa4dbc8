#include "edit/local/dissolve.h"

#include "edit/piece/list.h"
#include "mesh/marks.h"
#include "mesh/write.h"

/* Lists the vertices around the face that results when all faces around vertex v are merged. */
static he_status find_ring(const he_mesh *m, he_vertex v, he_ids *ring, he_error *err)
{
    he_status status = HE_OK;
    he_halfedge first = he_vertex_halfedge(m, v), k = first;
    do {
        he_halfedge end = he_prev(m, k);
        for (he_halfedge h = he_next(m, k); status == HE_OK && h.i != end.i; h = he_next(m, h)) {
            status = he_ids_add(ring, he_origin(m, h).i, err);
        }
        k = he_swing_ccw(m, k);
    } while (status == HE_OK && k.i != first.i);
    return status;
}

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

static he_status check(const he_mesh *m, he_vertex v, size_t *corners, he_error *err)
{
    he_ids ring = {0};
    he_status status = he_mesh_require(m, HE_VERTEX, v.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (he_is_boundary_vertex(m, v)) {
        return he_fail(err, HE_BOUNDARY_VERTEX, HE_VERTEX, v.i, "vertex %u is on the boundary",
                       v.i);
    }
    size_t at = 0;
    status = find_ring(m, v, &ring, err);
    if (status == HE_OK && ring.count < 3) {
        status = he_fail(err, HE_TOO_FEW_CORNERS, HE_VERTEX, v.i,
                         "the faces around vertex %u have only %zu other corners; a face needs 3",
                         v.i, ring.count);
    }
    if (status == HE_OK) {
        status = he_list_repeat(ring.ids, ring.count, &at, err);
    }
    if (status == HE_OK && at < ring.count) {
        status = he_fail(err, HE_REPEATED_CORNER, HE_VERTEX, ring.ids[at],
                         "the outline of the faces around vertex %u passes vertex %u twice", v.i,
                         ring.ids[at]);
    }
    *corners = ring.count;
    he_ids_clear(&ring);
    return status == HE_OK ? check_locks(m, v, err) : status;
}

static void commit(he_mesh *m, he_vertex v, he_face f)
{
    he_halfedge first = he_vertex_halfedge(m, v), k = first;
    do {
        he_halfedge end = he_prev(m, k);
        for (he_halfedge h = he_next(m, k); h.i != end.i; h = he_next(m, h)) {
            if (he_face_of(m, h).i != f.i) {
                he_set_face(m, h, f);
            }
        }
        k = he_swing_ccw(m, k);
    } while (k.i != first.i);
    he_halfedge stored = he_face_halfedge(m, f);
    if (stored.i == first.i || stored.i == he_prev(m, first).i) {
        he_set_face_halfedge(m, f, he_next(m, first));
    }
    double taken = 0; /* number of faces merged into face f so far */
    /* The edges at v keep their links until they are deleted, so he_swing_ccw() still visits them
     * all. */
    do {
        he_halfedge next = he_swing_ccw(m, k), back = he_twin(k), out = he_next(m, k);
        he_vertex a = he_target(m, k);
        he_face g = he_face_of(m, k);
        he_link(m, he_prev(m, back), out);
        if (he_vertex_halfedge(m, a).i == back.i) {
            he_set_vertex_halfedge(m, a, out);
        }
        if (g.i != f.i) {
            taken++;
            he_attributes_merge(m, HE_FACE, f.i, g.i, taken / (taken + 1));
            he_note_merged(m, HE_FACE, g.i, f.i);
            he_delete_face(m, g);
        }
        k = next;
    } while (k.i != first.i);
    do {
        he_halfedge next = he_swing_ccw(m, k);
        he_delete_edge(m, he_edge_of(k));
        k = next;
    } while (k.i != first.i);
    he_delete_vertex(m, v);
}

he_status he_vertex_dissolve(he_mesh *m, he_vertex v, he_face *face, he_error *err)
{
    size_t corners = 0;
    he_status status = check(m, v, &corners, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t degree = he_vertex_degree(m, v);
    he_face f = he_face_of(m, he_vertex_halfedge(m, v));
    he_reservation need = {.deleted_vertices = 1, .deleted_edges = degree, .deleted_faces = degree};
    need.links = corners + 3 * (size_t)degree + 1;
    need.lineage = degree;
    need.attributes = degree;
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    commit(m, v, f);
    if (face != NULL) {
        *face = f;
    }
    return HE_OK;
}
