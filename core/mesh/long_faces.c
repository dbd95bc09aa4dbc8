#include "mesh/long_faces.h"

#include "mesh/walk.h"

#include <stdatomic.h>

/* The cache of the triangulations of a mesh's long faces. The pointer is NULL until the first
 * thread that has made the triangulations sets it. */
struct he_kept {
    _Atomic(he_long_faces *) long_faces;
};

void he_long_faces_free(he_long_faces *all)
{
    for (size_t i = 0; all != NULL && i < all->count; i++) {
        he_mem_free(all->face[i].corners);
    }
    he_mem_free(all);
}

static he_long_faces *all_of(const he_mesh *m)
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
        he_long_faces_free(
            atomic_exchange_explicit(&m->kept->long_faces, NULL, memory_order_acq_rel));
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
    const he_long_faces *all = all_of(m);
    size_t bytes = m->kept == NULL ? 0 : sizeof *m->kept;
    for (size_t i = 0; all != NULL && i < all->count; i++) {
        bytes += sizeof all->face[i] + 3 * ((size_t)all->face[i].n - 2) * sizeof(uint32_t);
    }
    return bytes;
}

bool he_long_faces_are_wanted(const he_mesh *m)
{
    return m->kept != NULL && all_of(m) == NULL;
}

void he_long_faces_put(const he_mesh *m, he_long_faces *all)
{
    he_long_faces *none = NULL;
    if (!atomic_compare_exchange_strong_explicit(&m->kept->long_faces, &none, all,
                                                 memory_order_acq_rel, memory_order_acquire)) {
        he_long_faces_free(all);
    }
}

const he_long_face *he_long_faces_find(const he_mesh *m, he_halfedge first)
{
    const he_long_faces *all = all_of(m);
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
