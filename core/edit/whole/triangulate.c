#include "edit/whole/triangulate.h"

#include "edit/piece/list.h"
#include "edit/piece/triangles.h"

static he_status room(he_ids *list, size_t extra, he_error *err)
{
    return list == NULL ? HE_OK : he_ids_reserve(list, extra, err);
}

/* Adds the diagonals of a triangulated face to `lookup`, because later triangulations must avoid
 * them. */
static void note_diagonals(const he_mesh *m, const he_triangulation *t, he_edge_lookup *lookup)
{
    for (uint32_t k = 0; lookup->rank != NULL && k + 3 < t->flat.n; k++) {
        const uint32_t *corners = t->corners + 3 * (size_t)k;
        he_edge_lookup_add(lookup, he_origin(m, (he_halfedge){t->flat.halfedge[corners[0]]}),
                           he_origin(m, (he_halfedge){t->flat.halfedge[corners[2]]}));
    }
}

static he_status triangulate_one(he_mesh *m, he_face f, he_ids *edges, he_ids *faces,
                                 he_ids *degenerate, he_triangulation_work *work, he_error *err)
{
    he_triangles plan;
    he_status status = he_triangles_plan(m, he_face_halfedge(m, f), work, &plan, err);
    if (status != HE_OK) {
        return status;
    }
    work->steps += plan.of.flat.n;
    he_reservation need = {0};
    he_triangles_reservation(&plan, true, &need);
    status = room(edges, need.edges, err);
    if (status == HE_OK) {
        status = room(faces, need.faces, err);
    }
    if (status == HE_OK) {
        status = room(degenerate, 1, err);
    }
    if (status == HE_OK) {
        status = he_edge_lookup_reserve(&work->own, plan.of.flat.n, err);
    }
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        /* Nothing below can fail. */
        if (plan.of.flat.n > 3) {
            he_triangles_commit(m, &plan, true, edges, faces);
            note_diagonals(m, &plan.of, &work->own);
        }
        if (plan.of.degenerate && degenerate != NULL) {
            degenerate->ids[degenerate->count++] = f.i;
        }
    }
    he_triangles_clear(&plan);
    return status;
}

he_status he_face_triangulate(he_mesh *m, const uint32_t *face_ids, size_t count, he_ids *edges,
                              he_ids *faces, he_ids *degenerate, he_error *err)
{
    he_status status = he_list_require(m, HE_FACE, face_ids, count, HE_REPEATED_ELEMENT, err);
    if (status != HE_OK) {
        return status;
    }
    /* Each face is checked immediately before it is triangulated, because the check must know the
     * diagonals of the faces that were triangulated earlier. */
    he_ids *const lists[3] = {edges, faces, degenerate};
    size_t before[3] = {0, 0, 0};
    for (unsigned i = 0; i < 3; i++) {
        before[i] = lists[i] == NULL ? 0 : lists[i]->count;
    }
    he_bracket bracket;
    status = he_edit_begin(m, &bracket, err);
    if (status != HE_OK) {
        return status;
    }
    he_triangulation_work work = {.progress = m->progress, .of = count};
    status = he_progress_phase(m->progress, "triangulating", 1, err);
    for (size_t i = 0; status == HE_OK && i < count; i++) {
        work.done = i;
        status = triangulate_one(m, (he_face){face_ids[i]}, edges, faces, degenerate, &work, err);
    }
    he_triangulation_work_clear(&work);
    for (unsigned i = 0; status != HE_OK && i < 3; i++) {
        if (lists[i] != NULL) {
            lists[i]->count = before[i];
        }
    }
    return he_edit_end(m, &bracket, status);
}

he_status he_triangulate(he_mesh *m, he_ids *edges, he_ids *faces, he_ids *degenerate,
                         he_error *err)
{
    he_ids polygons = {0};
    he_status status = he_progress_phase(m->progress, "triangulating", 1, err);
    for (uint32_t f = 0; status == HE_OK && f < m->c.faces.issued; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        if (he_next(m, he_next(m, h)).i != he_prev(m, h).i) {
            status = he_ids_add(&polygons, f, err);
        }
    }
    if (status == HE_OK && polygons.count > 0) {
        status =
            he_face_triangulate(m, polygons.ids, polygons.count, edges, faces, degenerate, err);
    }
    he_ids_clear(&polygons);
    return status;
}
