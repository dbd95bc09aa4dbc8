#include "edit/local/erase.h"

#include "edit/piece/list.h"
#include "mesh/marks.h"
#include "mesh/write.h"
#include "query/idmap.h"

static bool edge_would_die(const he_mesh *m, he_halfedge h)
{
    return he_is_boundary_halfedge(m, he_twin(h));
}

/* Adds to `need` the memory for deleting face f. An edge is deleted with the last of its faces. If
 * other faces are deleted before f (`alone` is false), every edge of f may be deleted with f. */
static void add_need(const he_mesh *m, he_face f, bool alone, he_reservation *need)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        /* Two links are written for each corner: the face of its half-edge and the half-edge that
         * its vertex stores. Six more are written for each deleted edge: two pairs of next and prev
         * links, and the half-edges that its two ends store. */
        need->links += 2;
        if (!alone || edge_would_die(m, h)) {
            need->links += 6;
            need->deleted_edges++;
        }
        need->deleted_vertices++;
        h = he_next(m, h);
    } while (h.i != first.i);
    need->deleted_faces++;
}

/* Deletes an edge that has no faces left, and links its neighbours in the loops of holes to each
 * other. If an end of the edge stored a half-edge of the edge, this end now stores the next
 * half-edge that leaves it, or HE_NONE if there is none. */
static void erase_edge(he_mesh *m, he_edge e)
{
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side), t = he_twin(h);
        he_halfedge before = he_prev(m, h), after = he_next(m, t);
        he_vertex v = he_origin(m, h);
        if (after.i == h.i) {
            he_set_vertex_halfedge(m, v, (he_halfedge){HE_NONE});
            continue;
        }
        he_link(m, before, after);
        if (he_vertex_halfedge(m, v).i == h.i) {
            he_set_vertex_halfedge(m, v, after);
        }
    }
    he_delete_edge(m, e);
}

static void erase_face(he_mesh *m, he_face f, he_leftover leftover)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        he_set_face(m, h, (he_face){HE_NONE});
        he_vertex v = he_origin(m, h);
        if (!he_is_boundary_halfedge(m, he_vertex_halfedge(m, v))) {
            he_set_vertex_halfedge(m, v, h);
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    he_delete_face(m, f);

    /* Deleting an edge relinks its neighbours in the loop, so the walk reads the next half-edge
     * beforehand; that half-edge is not deleted before it is visited. The walk takes as many steps
     * as the loop had corners, because the first half-edge may be deleted when the walk comes back
     * to it. */
    uint32_t corners = he_loop_length(m, first);
    for (uint32_t i = 0; i < corners; i++) {
        he_halfedge next = he_next(m, h);
        if (he_is_boundary_halfedge(m, he_twin(h))) {
            he_vertex v = he_origin(m, h), w = he_target(m, h);
            erase_edge(m, he_edge_of(h));
            if (leftover == HE_DROP_ISOLATED && he_is_isolated(m, v)) {
                he_delete_vertex(m, v);
            }
            if (leftover == HE_DROP_ISOLATED && he_is_isolated(m, w)) {
                he_delete_vertex(m, w);
            }
        }
        h = next;
    }
}

/* Refuses if a locked element would be deleted with face f. A vertex is deleted with f if f is its
 * only face and the caller wants isolated vertices to be deleted. */
static he_status check_face_locks(const he_mesh *m, he_face f, he_leftover leftover, he_error *err)
{
    he_marks marks;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_status status = he_require_unlocked(&marks, HE_FACE, f.i, err);
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        he_halfedge before = he_swing_ccw(m, h);
        if (status == HE_OK && edge_would_die(m, h)) {
            status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(h).i, err);
        }
        if (status == HE_OK && leftover == HE_DROP_ISOLATED && he_swing_ccw(m, before).i == h.i &&
            edge_would_die(m, h) && he_is_boundary_halfedge(m, before)) {
            status = he_require_unlocked(&marks, HE_VERTEX, he_origin(m, h).i, err);
        }
        h = he_next(m, h);
    } while (status == HE_OK && h.i != first.i);
    return status;
}

/* Returns true if half-edge h will have no face: either it has none now, or its face is in `faces`,
 * the set of the faces to be deleted. */
static bool goes(const he_mesh *m, he_halfedge h, const he_idmap *faces)
{
    he_face f = he_face_of(m, h);
    return f.i == HE_NONE || he_idmap_find(faces, f.i) != HE_NONE;
}

static bool origin_goes(const he_mesh *m, he_halfedge h, const he_idmap *faces)
{
    he_halfedge k = h;
    do {
        if (!goes(m, k, faces)) {
            return false;
        }
        k = he_swing_ccw(m, k);
    } while (k.i != h.i);
    return true;
}

/* Refuses if a locked element would be deleted with the given faces. A locked vertex may be a
 * corner of many of these faces, but the function walks around it only once. */
static he_status check_star_locks(const he_mesh *m, const he_idmap *faces, he_leftover leftover,
                                  he_error *err)
{
    he_marks marks;
    he_idmap corners = {.slots = NULL};
    he_status status = HE_OK;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    for (size_t i = 0; status == HE_OK && i < faces->ids.count; i++) {
        he_halfedge first = he_face_halfedge(m, (he_face){faces->ids.ids[i]}), h = first;
        status = he_require_unlocked(&marks, HE_FACE, faces->ids.ids[i], err);
        while (status == HE_OK) {
            uint32_t index, w = he_origin(m, h).i;
            bool added = false;
            if (goes(m, he_twin(h), faces)) {
                status = he_require_unlocked(&marks, HE_EDGE, he_edge_of(h).i, err);
            }
            if (status == HE_OK && leftover == HE_DROP_ISOLATED &&
                he_is_locked(&marks, HE_VERTEX, w)) {
                status = he_idmap_add(&corners, w, &index, &added, err);
            }
            if (status == HE_OK && added && origin_goes(m, h, faces)) {
                status = he_require_unlocked(&marks, HE_VERTEX, w, err);
            }
            h = he_next(m, h);
            if (h.i == first.i) {
                break;
            }
        }
    }
    he_idmap_clear(&corners);
    return status;
}

static he_status erase_one(he_mesh *m, he_face f, he_leftover leftover, he_error *err)
{
    he_reservation need = {0};
    add_need(m, f, true, &need);
    he_status status = check_face_locks(m, f, leftover, err);
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        erase_face(m, f, leftover);
    }
    return status;
}

he_status he_face_delete(he_mesh *m, const uint32_t *faces, size_t count, he_leftover leftover,
                         he_error *err)
{
    he_status status = he_list_require(m, HE_FACE, faces, count, HE_REPEATED_ELEMENT, err);
    if (status != HE_OK) {
        return status;
    }
    if (count == 1) {
        return erase_one(m, (he_face){faces[0]}, leftover, err);
    }
    /* An edge between two faces of the list is deleted with the later face. Memory is reserved for
     * one face at a time: a single reservation for all faces would count each such edge twice. */
    he_bracket bracket;
    status = he_edit_begin(m, &bracket, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_progress_phase(m->progress, "deleting faces", 1, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        status = he_progress_at(m->progress, i, count, err);
        if (status == HE_OK) {
            status = erase_one(m, (he_face){faces[i]}, leftover, err);
        }
    }
    return he_edit_end(m, &bracket, status);
}

he_status he_edge_delete(he_mesh *m, const uint32_t *edges, size_t count, he_leftover leftover,
                         he_error *err)
{
    he_status status = he_list_require(m, HE_EDGE, edges, count, HE_REPEATED_ELEMENT, err);
    if (status != HE_OK) {
        return status;
    }
    he_bracket bracket;
    status = he_edit_begin(m, &bracket, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_progress_phase(m->progress, "deleting edges", 1, err);
    for (size_t i = 0; i < 2 * count && status == HE_OK; i++) {
        he_halfedge h = he_edge_halfedge((he_edge){edges[i / 2]}, i % 2);
        status = he_progress_at(m->progress, i, 2 * count, err);
        /* This edge may already have been deleted together with a face of an earlier edge. */
        if (status == HE_OK && he_edge_is_live(m, he_edge_of(h)) &&
            !he_is_boundary_halfedge(m, h)) {
            status = erase_one(m, he_face_of(m, h), leftover, err);
        }
    }
    return he_edit_end(m, &bracket, status);
}

static he_status find_star(const he_mesh *m, he_vertex v, he_idmap *faces, he_error *err)
{
    he_halfedge first = he_vertex_halfedge(m, v), h = first;
    he_status status = HE_OK;
    while (status == HE_OK && first.i != HE_NONE) {
        uint32_t index, f = he_face_of(m, h).i;
        bool added;
        status = f == HE_NONE ? HE_OK : he_idmap_add(faces, f, &index, &added, err);
        h = he_swing_ccw(m, h);
        if (h.i == first.i) {
            break;
        }
    }
    return status;
}

he_status he_vertex_delete(he_mesh *m, he_vertex v, he_leftover leftover, he_error *err)
{
    he_idmap faces = {.slots = NULL};
    he_reservation need = {.deleted_vertices = 1};
    he_marks marks;
    he_status status = he_mesh_require(m, HE_VERTEX, v.i, err);
    if (status == HE_OK && he_marks_find(m, &marks)) {
        status = he_require_unlocked(&marks, HE_VERTEX, v.i, err);
    }
    if (status == HE_OK) {
        status = find_star(m, v, &faces, err);
    }
    if (status == HE_OK) {
        status = check_star_locks(m, &faces, leftover, err);
    }
    for (size_t i = 0; i < faces.ids.count; i++) {
        add_need(m, (he_face){faces.ids.ids[i]}, false, &need);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        for (size_t i = 0; i < faces.ids.count; i++) {
            erase_face(m, (he_face){faces.ids.ids[i]}, leftover);
        }
        if (he_vertex_is_live(m, v)) {
            he_delete_vertex(m, v);
        }
    }
    he_idmap_clear(&faces);
    return status;
}

he_status he_delete_isolated(he_mesh *m, he_error *err)
{
    he_marks marks;
    bool marked = he_marks_find(m, &marks);
    he_reservation need = {0};
    he_status status = he_progress_phase(m->progress, "finding isolated vertices", 1, err);
    uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    for (uint32_t v = 0; status == HE_OK && v < issued; v++) {
        status = he_progress_at(m->progress, v, issued, err);
        if (status == HE_OK && he_is_isolated(m, (he_vertex){v})) {
            need.deleted_vertices++;
            status = marked ? he_require_unlocked(&marks, HE_VERTEX, v, err) : HE_OK;
        }
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    /* Nothing below can fail. */
    for (uint32_t v = 0; status == HE_OK && need.deleted_vertices > 0 && v < issued; v++) {
        if (he_is_isolated(m, (he_vertex){v})) {
            he_delete_vertex(m, (he_vertex){v});
        }
    }
    return status;
}
