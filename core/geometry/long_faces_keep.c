#include "geometry/long_faces_keep.h"

#include "geometry/triangulation.h"
#include "mesh/long_faces.h"
#include "mesh/walk.h"

static bool is_long(const he_mesh *m, uint32_t f)
{
    if (!he_face_is_live(m, (he_face){f})) {
        return false;
    }
    he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
    uint32_t n = 0;
    do {
        h = he_next(m, h);
    } while (++n <= HE_EXACT_CORNERS && h.i != first.i);
    return n > HE_EXACT_CORNERS;
}

static he_status count_long(const he_mesh *m, size_t *out, uint64_t *corners, he_progress *progress,
                            he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        if (is_long(m, f)) {
            ++*out;
            *corners += he_face_degree(m, (he_face){f});
        }
        status = he_progress_at(progress, f, m->c.faces.issued, err);
    }
    return status;
}

static he_status cut_long(const he_mesh *m, he_long_faces *all, uint64_t corners,
                          he_progress *progress, he_error *err)
{
    he_triangulation_work work = {.progress = progress, .of = corners};
    he_status status = HE_OK;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        if (!is_long(m, f)) {
            continue;
        }
        he_triangulation t;
        status = he_triangulation_make(m, he_face_halfedge(m, (he_face){f}), HE_ANY_DIAGONALS,
                                       &work, &t, err);
        if (status == HE_OK) {
            all->face[all->count++] = (he_long_face){f, t.flat.n, t.degenerate, t.corners};
            work.done += t.flat.n;
            t.corners = NULL;
            he_triangulation_clear(&t);
        }
    }
    he_triangulation_work_clear(&work);
    return status;
}

he_status he_long_faces_keep(const he_mesh *m, he_progress *progress, he_error *err)
{
    if (!he_long_faces_are_wanted(m)) {
        return HE_OK;
    }
    size_t count = 0;
    uint64_t corners = 0;
    he_status status = he_progress_phase(progress, "triangulating", 0.5, err);
    if (status == HE_OK) {
        status = count_long(m, &count, &corners, progress, err);
    }
    if (status != HE_OK) {
        return status;
    }
    he_long_faces *all = he_mem_zero(1, sizeof *all + count * sizeof *all->face);
    if (all == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY,
                             "no memory for a list of %zu faces that have many corners", count);
    }
    status = cut_long(m, all, corners, progress, err);
    if (status == HE_OK) {
        he_long_faces_put(m, all);
    } else {
        he_long_faces_free(all);
    }
    return status;
}
