#include "edit/whole/separate.h"

#include "edit/piece/list.h"
#include "mesh/marks.h"
#include "mesh/write.h"

/* Checks that no edge or face of a fan is locked. *h is the half-edge with which the fan begins;
 * the function advances it to the half-edge with which the fan ends. */
static he_status check_fan(const he_mesh *m, const he_marks *marks, he_halfedge *h, he_error *err)
{
    he_status status = he_require_unlocked(marks, HE_EDGE, he_edge_of(*h).i, err);
    while (status == HE_OK && !he_is_boundary_halfedge(m, *h)) {
        status = he_require_unlocked(marks, HE_FACE, he_face_of(m, *h).i, err);
        *h = he_swing_ccw(m, *h);
        if (status == HE_OK) {
            status = he_require_unlocked(marks, HE_EDGE, he_edge_of(*h).i, err);
        }
    }
    return status;
}

static he_status check_locks(const he_mesh *m, he_vertex v, he_error *err)
{
    he_marks marks;
    he_status status = HE_OK;
    if (!he_marks_find(m, &marks)) {
        return HE_OK;
    }
    he_halfedge stored = he_vertex_halfedge(m, v), h = he_swing_ccw(m, stored);
    /* The last fan ends with the half-edge that v stores. This fan keeps vertex v, so locks of its
     * faces and edges do not matter. */
    for (uint32_t fans = he_vertex_fans(m, v); status == HE_OK && fans > 1; fans--) {
        status = check_fan(m, &marks, &h, err);
        h = he_swing_ccw(m, h);
    }
    return status;
}

/* If v is a bow-tie (a vertex with several fans), adds v to the list `ties`, and adds the memory
 * for separating the fans of v to `need`. */
static he_status plan(const he_mesh *m, he_vertex v, he_reservation *need, he_ids *ties,
                      he_error *err)
{
    if (!he_is_boundary_vertex(m, v)) {
        return HE_OK;
    }
    uint32_t fans = he_vertex_fans(m, v);
    if (fans < 2) {
        return HE_OK;
    }
    if (need->vertices > HE_MAX_ROWS - fans) {
        return he_fail_plain(err, HE_IDS_EXHAUSTED, "too many bow-ties to split");
    }
    need->vertices += fans - 1;
    need->lineage += fans - 1;
    need->links += (size_t)he_vertex_degree(m, v) + 2 * (size_t)fans;
    he_status status = check_locks(m, v, err);
    return status == HE_OK ? he_ids_add(ties, v.i, err) : status;
}

static void commit(he_mesh *m, he_vertex v, he_ids *made)
{
    he_halfedge stored = he_vertex_halfedge(m, v), h = he_swing_ccw(m, stored);
    for (;;) {
        he_halfedge first = h;
        while (!he_is_boundary_halfedge(m, h)) {
            h = he_swing_ccw(m, h);
        }
        if (h.i == stored.i) {
            he_link(m, he_twin(first), stored);
            return;
        }
        he_halfedge last = h, next = he_swing_ccw(m, last);
        he_link(m, he_twin(first), last);
        he_vertex u = he_new_vertex(m);
        he_set_position(m, u, he_position(m, v));
        he_attributes_copy(m, HE_VERTEX, u.i, v.i);
        he_note_parent(m, HE_VERTEX, u.i, v.i);
        h = first;
        do {
            he_set_origin(m, h, u);
            h = he_swing_ccw(m, h);
        } while (h.i != first.i);
        he_set_vertex_halfedge(m, u, last);
        if (made != NULL) {
            made->ids[made->count++] = u.i;
        }
        h = next;
    }
}

/* Gives each fan of the vertices in `ties` a vertex of its own, and frees the list `ties`. If
 * `status` is an error, it only frees the list. */
static he_status take_apart(he_mesh *m, he_ids *ties, he_reservation need, he_ids *made,
                            he_status status, he_error *err)
{
    if (status == HE_OK && made != NULL) {
        status = he_ids_reserve(made, need.vertices, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    /* Nothing below can fail. */
    for (size_t i = 0; status == HE_OK && i < ties->count; i++) {
        commit(m, (he_vertex){ties->ids[i]}, made);
    }
    he_ids_clear(ties);
    return status;
}

he_status he_vertex_separate(he_mesh *m, const uint32_t *vertices, size_t count, he_ids *made,
                             he_error *err)
{
    he_reservation need = {0};
    he_ids ties = {0};
    he_status status = he_list_require(m, HE_VERTEX, vertices, count, HE_REPEATED_ELEMENT, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        status = plan(m, (he_vertex){vertices[i]}, &need, &ties, err);
    }
    return take_apart(m, &ties, need, made, status, err);
}

he_status he_separate_bowties(he_mesh *m, he_ids *made, he_error *err)
{
    he_reservation need = {0};
    he_ids ties = {0};
    he_status status = he_progress_phase(m->progress, "finding bow-ties", 1, err);
    uint32_t issued = he_mesh_issued(m, HE_VERTEX);
    for (uint32_t v = 0; status == HE_OK && v < issued; v++) {
        status = he_progress_at(m->progress, v, issued, err);
        if (status == HE_OK && he_vertex_is_live(m, (he_vertex){v})) {
            status = plan(m, (he_vertex){v}, &need, &ties, err);
        }
    }
    return take_apart(m, &ties, need, made, status, err);
}
