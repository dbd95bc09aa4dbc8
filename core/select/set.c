#include "select/set.h"

he_status he_set_new(const he_mesh *m, he_kind kind, he_set *out, he_error *err)
{
    uint32_t issued = he_mesh_issued(m, kind);
    uint64_t *bits = he_bits_new((size_t)issued + 1);
    if (bits == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a set of %s", he_kind_plural(kind));
    }
    *out = (he_set){kind, issued, bits};
    return HE_OK;
}

void he_set_clear(he_set *set)
{
    he_mem_free(set->bits);
    set->bits = NULL;
}

void he_set_invert(const he_mesh *m, he_set *set)
{
    for (uint32_t id = 0; id < set->issued; id++) {
        const uint64_t bit = (uint64_t)1 << (id & 63);
        if (he_mesh_is_live(m, set->kind, id)) {
            set->bits[id >> 6] ^= bit;
        }
    }
}

he_status he_set_of_faces(const he_mesh *m, const he_set *faces, he_set *out, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t f = 0; f < faces->issued && status == HE_OK; f++) {
        status = he_progress_at(m->progress, f, faces->issued, err);
        if (!he_set_has(faces, f)) {
            continue;
        }
        if (out->kind == HE_FACE) {
            he_set_add(out, f);
            continue;
        }
        he_halfedge first = he_face_halfedge(m, (he_face){f}), h = first;
        do {
            he_set_add(out, out->kind == HE_EDGE ? he_edge_of(h).i : he_origin(m, h).i);
            h = he_next(m, h);
        } while (h.i != first.i);
    }
    return status;
}

/* Returns whether the corners of a face are in the set, as many as `which` demands. */
static bool face_counts(const he_mesh *m, const he_set *vertices, he_corner_rule which, he_face f)
{
    he_halfedge first = he_face_halfedge(m, f), h = first;
    do {
        bool in = he_set_has(vertices, he_origin(m, h).i);
        if (in == (which == HE_ANY_CORNER)) {
            return in;
        }
        h = he_next(m, h);
    } while (h.i != first.i);
    return which == HE_ALL_CORNERS;
}

static bool counts(const he_mesh *m, const he_set *vertices, he_corner_rule which, he_kind kind,
                   uint32_t id)
{
    if (kind == HE_VERTEX) {
        return he_set_has(vertices, id);
    }
    if (kind == HE_FACE) {
        return face_counts(m, vertices, which, (he_face){id});
    }
    const bool a = he_set_has(vertices, m->c.origin[2u * id]);
    const bool b = he_set_has(vertices, m->c.origin[2u * id + 1u]);
    return which == HE_ALL_CORNERS ? a && b : a || b;
}

he_status he_set_of_vertices(const he_mesh *m, const he_set *vertices, he_corner_rule which,
                             he_set *out, he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t id = 0; id < out->issued && status == HE_OK; id++) {
        status = he_progress_at(m->progress, id, out->issued, err);
        if (he_mesh_is_live(m, out->kind, id) && counts(m, vertices, which, out->kind, id)) {
            he_set_add(out, id);
        }
    }
    return status;
}
