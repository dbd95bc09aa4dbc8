#include "edit/piece/keep.h"

#include "mesh/marks.h"

static bool is_value(const he_column *column)
{
    return column != NULL && column->domain == HE_VERTEX && !he_is_mark(column, "locked") &&
           !he_is_mark(column, "selected") && !he_is_mark(column, "feature");
}

static bool has_corners(const he_mesh *m, uint32_t v)
{
    return he_vertex_halfedge(m, (he_vertex){v}).i != HE_NONE;
}

/* Returns true if vertex `gone`, which is merged into vertex `into`, has a value of the attribute
 * that would be lost because `into` has a different value. If the attribute's rule is `default`, a
 * vertex with the default value has no value to lose. */
static bool differs(const he_column *column, uint32_t gone, uint32_t into)
{
    const unsigned char *value = he_column_value(column, gone);
    return memcmp(value, he_column_value(column, into), column->row_bytes) != 0 &&
           (column->rule != HE_DEFAULT || memcmp(value, column->fallback, column->row_bytes) != 0);
}

static uint64_t count_differing(const he_mesh *m, const he_column *column,
                                const he_keep_pairs *pairs)
{
    uint64_t count = 0;
    for (size_t i = 0; i < pairs->count; i++) {
        count += has_corners(m, pairs->gone[i]) && differs(column, pairs->gone[i], pairs->into[i]);
    }
    return count;
}

static uint64_t count_all(const he_mesh *m, const he_keep_pairs *pairs)
{
    uint64_t count = 0;
    for (size_t slot = 0; slot < m->c.column_count; slot++) {
        if (is_value(m->c.columns[slot])) {
            count += count_differing(m, m->c.columns[slot], pairs);
        }
    }
    return count;
}

/* Returns true if an isolated vertex has a value of the attribute that is not the default. */
static bool is_needed(const he_mesh *m, const he_column *column)
{
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v}) && !has_corners(m, v) &&
            memcmp(he_column_value(column, v), column->fallback, column->row_bytes) != 0) {
            return true;
        }
    }
    return false;
}

/* Returns true if each corner at vertex v has, in the attribute `corners`, the value that v has in
 * the attribute `column`. The value of v is then not lost when v is merged. */
static bool says_so(const he_mesh *m, const he_column *corners, const he_column *column, uint32_t v)
{
    he_halfedge first = he_vertex_halfedge(m, (he_vertex){v}), h = first;
    do {
        if (!he_is_boundary_halfedge(m, h) &&
            memcmp(he_column_value(corners, h.i), he_column_value(column, v), column->row_bytes) !=
                0) {
            return false;
        }
        h = he_swing_ccw(m, h);
    } while (h.i != first.i);
    return true;
}

static bool is_kept(const he_mesh *m, const he_column *corners, const he_column *column,
                    const he_keep_pairs *pairs)
{
    if (!he_column_same_values(corners, column)) {
        return false;
    }
    for (size_t i = 0; i < pairs->count; i++) {
        uint32_t v = pairs->gone[i];
        if (has_corners(m, v) && differs(column, v, pairs->into[i]) &&
            !says_so(m, corners, column, v)) {
            return false;
        }
    }
    return true;
}

static he_status add_corners(he_mesh *m, const he_column *column, const char *name, he_error *err)
{
    uint32_t halfedges = he_mesh_issued(m, HE_HALFEDGE);
    he_column *made = NULL;
    he_status status = he_column_for_corners(column, name, halfedges, &made, err);
    for (uint32_t h = 0; h < halfedges && status == HE_OK; h++) {
        if (m->c.face[h] < HE_DEAD) {
            memcpy(he_column_row(made, h), he_column_value(column, m->c.origin[h]),
                   column->row_bytes);
        }
        status = he_progress_at(m->progress, h, halfedges, err);
    }
    if (status == HE_OK) {
        status = he_mesh_add_column(m, made, err);
    }
    if (status != HE_OK) {
        he_column_free(made);
    }
    return status;
}

static size_t slot_of(const he_mesh *m, const he_column *column)
{
    size_t slot = 0;
    while (m->c.columns[slot] != column) {
        slot++;
    }
    return slot;
}

static he_status keep_column(he_mesh *m, const he_column *column, const he_keep_pairs *pairs,
                             he_error *err)
{
    char name[HE_COLUMN_NAME];
    const he_column *corners;
    unsigned number = 1;
    do {
        he_column_number_name(column->name, number++, name);
        corners = he_mesh_find_column(m, HE_HALFEDGE, name);
        if (corners != NULL && is_kept(m, corners, column, pairs)) {
            return HE_OK;
        }
    } while (corners != NULL);
    he_status status = add_corners(m, column, name, err);
    return status == HE_OK && !is_needed(m, column)
               ? he_mesh_drop_column(m, slot_of(m, column), err)
               : status;
}

static he_status keep_values(he_mesh *m, const he_keep_pairs *pairs, he_error *err)
{
    he_status status = HE_OK;
    /* keep_column() may add columns to the array that this loop walks through. The new columns are
     * attributes of corners, which is_value() rejects, so the loop skips them. */
    for (size_t slot = 0; slot < m->c.column_count && status == HE_OK; slot++) {
        const he_column *column = m->c.columns[slot];
        if (is_value(column) && count_differing(m, column, pairs) > 0) {
            status = keep_column(m, column, pairs, err);
        }
    }
    return status;
}

he_status he_keep_begin(he_mesh *m, const he_keep_pairs *pairs, he_keeping *out, he_error *err)
{
    out->count = count_all(m, pairs);
    if (out->count == 0) {
        return HE_OK;
    }
    he_status status = he_edit_begin(m, &out->bracket, err);
    if (status == HE_OK) {
        status = keep_values(m, pairs, err);
        if (status != HE_OK) {
            he_edit_end(m, &out->bracket, status);
        }
    }
    return status;
}

he_status he_keep_end(he_mesh *m, he_keeping *kept, he_status status, uint64_t *moved)
{
    if (status == HE_OK && moved != NULL) {
        *moved = kept->count;
    }
    return kept->count > 0 ? he_edit_end(m, &kept->bracket, status) : status;
}
