#include "edit/local/cut.h"

#include "edit/piece/point.h"
#include "mesh/marks.h"

void he_cut_reservation(uint32_t corners, he_reservation *need)
{
    need->edges++;
    need->faces++;
    need->links +=
        /* An upper bound of the links written in existing elements: the face of each half-edge that
         * moves to the new face, four next and prev links, and the half-edge that the old face
         * stores. */
        (size_t)corners + 5;
    need->lineage++;
}

he_halfedge he_cut_commit(he_mesh *m, he_halfedge from, he_halfedge to)
{
    he_face old = he_face_of(m, from);
    he_halfedge before_from = he_prev(m, from), before_to = he_prev(m, to);
    he_halfedge d = he_edge_halfedge(he_new_edge(m), 0), back = he_twin(d);
    he_face f = he_new_face(m);
    for (he_halfedge h = from; h.i != to.i; h = he_next(m, h)) {
        he_set_face(m, h, f);
    }
    he_set_halfedge(m, d, to, before_from, he_origin(m, from), old);
    he_set_halfedge(m, back, from, before_to, he_origin(m, to), f);
    he_set_next(m, before_from, d);
    he_set_prev(m, to, d);
    he_set_next(m, before_to, back);
    he_set_prev(m, from, back);
    he_set_face_halfedge(m, f, from);
    if (he_face_of(m, he_face_halfedge(m, old)).i == f.i) {
        he_set_face_halfedge(m, old, d);
    }
    he_attributes_copy(m, HE_FACE, f.i, old.i);
    he_attributes_copy(m, HE_HALFEDGE, d.i, from.i);
    he_attributes_copy(m, HE_HALFEDGE, back.i, to.i);
    he_note_parent(m, HE_FACE, f.i, old.i);
    return d;
}

he_halfedge he_face_corner(const he_mesh *m, he_face f, he_vertex v)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        if (he_origin(m, h).i == v.i) {
            return h;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    return (he_halfedge){HE_NONE};
}

static he_status check_corner(const he_mesh *m, he_face f, he_halfedge h, he_error *err)
{
    he_status status = he_mesh_require(m, HE_HALFEDGE, h.i, err);
    if (status == HE_OK && he_face_of(m, h).i != f.i) {
        return he_fail(err, HE_NOT_A_CORNER, HE_HALFEDGE, h.i,
                       "half-edge %u is not a half-edge of face %u", h.i, f.i);
    }
    return status;
}

static he_status check_split(const he_mesh *m, he_face f, he_halfedge from, he_halfedge to,
                             he_error *err)
{
    he_status status = he_mesh_require(m, HE_FACE, f.i, err);
    if (status == HE_OK) {
        status = check_corner(m, f, from, err);
    }
    if (status == HE_OK) {
        status = check_corner(m, f, to, err);
    }
    if (status != HE_OK) {
        return status;
    }
    he_vertex a = he_origin(m, from), b = he_origin(m, to);
    if (from.i == to.i) {
        return he_fail(err, HE_SAME_CORNER, HE_VERTEX, a.i,
                       "a diagonal cannot join vertex %u to itself", a.i);
    }
    if (he_next(m, from).i == to.i || he_next(m, to).i == from.i) {
        return he_fail(err, HE_ADJACENT_CORNERS, HE_FACE, f.i,
                       "vertices %u and %u are neighbours on face %u", a.i, b.i, f.i);
    }
    he_halfedge joined = he_find_halfedge(m, a, b);
    if (joined.i != HE_NONE) {
        return he_fail(err, HE_DOUBLED_EDGE, HE_EDGE, he_edge_of(joined).i,
                       "edge %u already joins vertices %u and %u", he_edge_of(joined).i, a.i, b.i);
    }
    return HE_OK;
}

he_status he_face_split(he_mesh *m, he_face f, he_halfedge from, he_halfedge to, he_edge *edge,
                        he_face *face, he_error *err)
{
    he_status status = check_split(m, f, from, to, err);
    if (status != HE_OK) {
        return status;
    }
    he_reservation need = {0};
    he_cut_reservation(he_face_degree(m, f), &need);
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_halfedge d = he_cut_commit(m, from, to);
    if (edge != NULL) {
        *edge = he_edge_of(d);
    }
    if (face != NULL) {
        *face = he_face_of(m, he_twin(d));
    }
    return HE_OK;
}

/* Returns a vertex, other than the ends of h, that is a corner of face(h) and also of the face
 * `other`; HE_NONE if there is none. The function walks around each corner of face(h), which takes
 * at most time linear in the half-edges of the mesh. */
static he_vertex shared_corner(const he_mesh *m, he_halfedge h, he_face other)
{
    he_halfedge x = he_next(m, he_next(m, h));
    for (; x.i != h.i; x = he_next(m, x)) {
        he_halfedge k = x;
        do {
            if (he_face_of(m, k).i == other.i) {
                return he_origin(m, x);
            }
            k = he_swing_ccw(m, k);
        } while (k.i != x.i);
    }
    return (he_vertex){HE_NONE};
}

static he_status check_join(const he_mesh *m, he_edge e, he_error *err)
{
    he_status status = he_mesh_require(m, HE_EDGE, e.i, err);
    if (status != HE_OK) {
        return status;
    }
    if (he_is_boundary_edge(m, e)) {
        return he_fail(err, HE_BOUNDARY_EDGE, HE_EDGE, e.i, "edge %u has only one face", e.i);
    }
    he_halfedge h = he_edge_halfedge(e, 0);
    he_face f = he_face_of(m, h), g = he_face_of(m, he_twin(h));
    he_vertex v = shared_corner(m, h, g);
    if (v.i != HE_NONE) {
        return he_fail(err, HE_SHARED_BOUNDARY, HE_VERTEX, v.i,
                       "faces %u and %u share vertex %u besides edge %u", f.i, g.i, v.i, e.i);
    }
    he_marks marks;
    if (he_marks_find(m, &marks)) {
        status = he_require_unlocked(&marks, HE_EDGE, e.i, err);
        if (status == HE_OK) {
            status = he_require_unlocked(&marks, HE_FACE, f.i, err);
        }
        if (status == HE_OK) {
            status = he_require_unlocked(&marks, HE_FACE, g.i, err);
        }
    }
    return status;
}

he_status he_face_join(he_mesh *m, he_edge e, he_face *face, he_error *err)
{
    he_status status = check_join(m, e, err);
    if (status != HE_OK) {
        return status;
    }
    he_halfedge h = he_edge_halfedge(e, 0), back = he_twin(h);
    he_face f = he_face_of(m, h), g = he_face_of(m, back);
    he_reservation need = {.deleted_edges = 1, .deleted_faces = 1, .attributes = 1, .lineage = 1};
    need.links = (size_t)he_face_degree(m, g) + 7;
    status = he_reserve(m, need, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    for (he_halfedge x = he_next(m, back); x.i != back.i; x = he_next(m, x)) {
        he_set_face(m, x, f);
    }
    he_halfedge at_a = he_next(m, back), at_b = he_next(m, h);
    if (he_face_halfedge(m, f).i == h.i) {
        he_set_face_halfedge(m, f, at_a);
    }
    if (he_vertex_halfedge(m, he_origin(m, h)).i == h.i) {
        he_set_vertex_halfedge(m, he_origin(m, h), at_a);
    }
    if (he_vertex_halfedge(m, he_origin(m, back)).i == back.i) {
        he_set_vertex_halfedge(m, he_origin(m, back), at_b);
    }
    he_link(m, he_prev(m, h), at_a);
    he_link(m, he_prev(m, back), at_b);
    he_attributes_merge(m, HE_FACE, f.i, g.i, 0.5);
    he_note_merged(m, HE_FACE, g.i, f.i);
    he_delete_edge(m, e);
    he_delete_face(m, g);
    if (face != NULL) {
        *face = f;
    }
    return HE_OK;
}
