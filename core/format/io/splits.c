#include "format/io/splits.h"

void he_splits_clear(he_splits *splits)
{
    he_mem_free(splits->number);
    he_mem_free(splits->own);
    he_ids_clear(&splits->copies);
    *splits = (he_splits){0};
}

/* Gives each distinct combination of corner values the number of a vertex in the file, and
 * overwrites the half-edge in distinct->first with this number. */
static he_status number_vertices(const he_mesh *m, const uint32_t *numbers, he_distinct *distinct,
                                 he_splits *out, he_error *err)
{
    he_status status = HE_OK;
    uint32_t vertices = he_mesh_vertices(m);
    for (size_t i = 0; i < distinct->first.count && status == HE_OK; i++) {
        uint32_t h = distinct->first.ids[i], v = m->c.origin[h];
        if (out->own[v] == HE_NONE) {
            out->own[v] = h;
            distinct->first.ids[i] = numbers == NULL ? v : numbers[v];
        } else {
            distinct->first.ids[i] = vertices + (uint32_t)out->copies.count;
            status = he_ids_add(&out->copies, h, err);
        }
    }
    return status;
}

he_status he_splits_make(const he_mesh *m, const uint32_t *numbers, const he_column *const *columns,
                         size_t count, he_progress *progress, he_splits *out, he_error *err)
{
    he_distinct distinct = {0};
    he_splits made = {.own = he_mem_array(NULL, m->c.vertices.issued, sizeof *made.own)};
    if (made.own == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to split %u vertices",
                             m->c.vertices.issued);
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        made.own[v] = HE_NONE;
    }
    he_status status = he_distinct_make(m, columns, count, true, progress, &distinct, err);
    if (status == HE_OK) {
        status = number_vertices(m, numbers, &distinct, &made, err);
    }
    for (uint32_t h = 0; h < he_mesh_issued(m, HE_HALFEDGE) && status == HE_OK; h++) {
        if (m->c.face[h] < HE_DEAD) {
            distinct.number[h] = distinct.first.ids[distinct.number[h]];
        }
    }
    if (status == HE_OK) {
        made.number = distinct.number;
        distinct.number = NULL;
        *out = made;
        made = (he_splits){0};
    }
    he_distinct_clear(&distinct);
    he_splits_clear(&made);
    return status;
}
