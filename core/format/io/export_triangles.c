#include "format/io/export_triangles.h"

void he_export_triangles_clear(he_export_triangles *triangles)
{
    he_ids_clear(&triangles->corners);
}

uint64_t he_export_triangles_count(const he_export_triangles *triangles)
{
    const he_content *c = &triangles->mesh->c;
    return 2 * (uint64_t)c->edges.live - c->boundary_halfedges - 2 * (uint64_t)c->faces.live;
}

static he_status cut_face(he_export_triangles *triangles, he_halfedge first,
                          he_triangulation_work *work, he_error *err)
{
    he_triangulation cut;
    const he_mesh *m = triangles->mesh;
    he_ids *ids = &triangles->corners;
    size_t corners = 3 * ((size_t)he_loop_length(m, first) - 2);
    he_status status = he_ids_reserve(ids, corners, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_triangulation_make(m, first, HE_ANY_DIAGONALS | HE_AVOID_EDGES, work, &cut, err);
    if (status == HE_DOUBLED_EDGE) {
        status = he_triangulation_make(m, first, HE_ANY_DIAGONALS, work, &cut, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < corners; i++) {
        he_halfedge h = {cut.flat.halfedge[cut.corners[i]]};
        ids->ids[ids->count++] = he_origin(m, h).i;
    }
    triangles->turned += cut.degenerate;
    he_triangulation_clear(&cut);
    return HE_OK;
}

he_status he_export_triangles_make(const he_mesh *mesh, he_progress *progress,
                                   he_export_triangles *out, he_error *err)
{
    he_export_triangles made = {.mesh = mesh};
    he_triangulation_work work = {0};
    he_error reason = {0};
    he_status status = HE_OK;
    for (uint32_t f = 0; f < mesh->c.faces.issued && status == HE_OK; f++) {
        status = he_progress_at(progress, f, mesh->c.faces.issued, &reason);
        if (status == HE_OK && he_face_is_live(mesh, (he_face){f}) &&
            he_face_degree(mesh, (he_face){f}) != 3) {
            made.polygons++;
            status = cut_face(&made, he_face_halfedge(mesh, (he_face){f}), &work, &reason);
        }
    }
    made.steps = work.steps;
    he_triangulation_work_clear(&work);
    if (status != HE_OK) {
        he_export_triangles_clear(&made);
        if (err != NULL) {
            *err = reason;
        }
        return status;
    }
    *out = made;
    return HE_OK;
}

bool he_export_triangles_next(const he_export_triangles *triangles, he_export_triangle_walk *walk,
                              uint32_t vertices[3])
{
    const he_mesh *m = triangles->mesh;
    while (walk->face < m->c.faces.issued && !he_face_is_live(m, (he_face){walk->face})) {
        walk->face++;
    }
    if (walk->face == m->c.faces.issued) {
        return false;
    }
    he_halfedge h = he_face_halfedge(m, (he_face){walk->face});
    if (walk->left == 0) {
        walk->left = he_loop_length(m, h) - 2;
        walk->is_cut = walk->left > 1;
    }
    for (unsigned i = 0; i < 3; i++, h = he_next(m, h)) {
        vertices[i] = walk->is_cut ? triangles->corners.ids[walk->corner++] : he_origin(m, h).i;
    }
    walk->left--;
    walk->face += walk->left == 0;
    return true;
}

void he_export_triangles_skip(const he_export_triangles *triangles, he_export_triangle_walk *walk,
                              uint32_t face)
{
    const he_mesh *m = triangles->mesh;
    for (; walk->face < face; walk->face++) {
        he_face f = {walk->face};
        uint32_t degree = he_face_is_live(m, f) ? he_face_degree(m, f) : 3;
        walk->corner += degree > 3 ? 3 * ((size_t)degree - 2) : 0;
    }
}
