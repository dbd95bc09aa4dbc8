#include "mesh/long_faces.h"

#include "mesh/walk.h"

#include <stdatomic.h>

/* In the order of faces. */
typedef struct faces {
    size_t count;
    he_long_face face[];
} faces;

/* Written once by whoever is first. */
struct he_kept {
    _Atomic(faces *) long_faces;
};

static void free_faces(faces *all)
{
    for (size_t i = 0; all != NULL && i < all->count; i++) {
        he_mem_free(all->face[i].corners);
    }
    he_mem_free(all);
}

static faces *all_of(const he_mesh *m)
{
    return m->kept == NULL ? NULL
                           : atomic_load_explicit(&m->kept->long_faces, memory_order_acquire);
}

he_status he_long_faces_allow(he_mesh *m, he_error *err)
{
    struct he_kept *kept = he_mem_alloc(sizeof *kept);
    if (kept == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a copy of the mesh");
    }
    atomic_init(&kept->long_faces, NULL);
    m->kept = kept;
    return HE_OK;
}

void he_long_faces_forget(he_mesh *m)
{
    if (m->kept != NULL) {
        free_faces(atomic_exchange_explicit(&m->kept->long_faces, NULL, memory_order_acq_rel));
    }
}

void he_long_faces_clear(he_mesh *m)
{
    he_long_faces_forget(m);
    he_mem_free(m->kept);
    m->kept = NULL;
}

size_t he_long_faces_bytes(const he_mesh *m)
{
    const faces *all = all_of(m);
    size_t bytes = m->kept == NULL ? 0 : sizeof *m->kept;
    for (size_t i = 0; all != NULL && i < all->count; i++) {
        bytes += sizeof all->face[i] + 3 * ((size_t)all->face[i].n - 2) * sizeof(uint32_t);
    }
    return bytes;
}

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

static he_status count_long(const he_mesh *m, size_t *out, uint64_t *corners, he_watch *watch,
                            he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t f = 0; f < m->c.faces.issued && status == HE_OK; f++) {
        if (is_long(m, f)) {
            ++*out;
            *corners += he_face_degree(m, (he_face){f});
        }
        status = he_watch_at(watch, f, m->c.faces.issued, err);
    }
    return status;
}

static he_status cut_long(const he_mesh *m, faces *all, uint64_t corners, he_watch *watch,
                          he_error *err)
{
    he_triangulation_work work = {.watch = watch, .of = corners};
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

he_status he_long_faces_keep(const he_mesh *m, he_watch *watch, he_error *err)
{
    if (m->kept == NULL || all_of(m) != NULL) {
        return HE_OK;
    }
    size_t count = 0;
    uint64_t corners = 0;
    he_status status = he_watch_phase(watch, "triangulating", 0.5, err);
    if (status == HE_OK) {
        status = count_long(m, &count, &corners, watch, err);
    }
    if (status != HE_OK) {
        return status;
    }
    faces *all = he_mem_zero(1, sizeof *all + count * sizeof *all->face), *none = NULL;
    if (all == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu long faces", count);
    }
    status = cut_long(m, all, corners, watch, err);
    if (status != HE_OK ||
        !atomic_compare_exchange_strong_explicit(&m->kept->long_faces, &none, all,
                                                 memory_order_acq_rel, memory_order_acquire)) {
        free_faces(all);
    }
    return status;
}

const he_long_face *he_long_faces_find(const he_mesh *m, he_halfedge first)
{
    const faces *all = all_of(m);
    he_face f = he_face_of(m, first);
    if (all == NULL || f.i == HE_NONE || he_face_halfedge(m, f).i != first.i) {
        return NULL;
    }
    size_t low = 0, high = all->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (all->face[middle].face < f.i) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < all->count && all->face[low].face == f.i ? &all->face[low] : NULL;
}
