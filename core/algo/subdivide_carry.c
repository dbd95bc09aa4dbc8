/* subdivide_carry.c - computes the attributes of a subdivided mesh by the rules in subdivide.h. */
#include "algo/subdivide_step.h"

#include "mesh/marks.h"

#include <string.h>

static bool has_columns(const he_content *c, he_kind domain)
{
    for (size_t i = 0; i < c->column_count; i++) {
        if (c->columns[i] != NULL && c->columns[i]->domain == domain) {
            return true;
        }
    }
    return false;
}

/* If the mesh has attributes of this domain (kind of element), makes an array of `count` ids that
 * are all HE_NONE. */
static bool reserve(const he_content *c, he_kind domain, uint32_t count, uint32_t **out)
{
    if (!has_columns(c, domain)) {
        return true;
    }
    *out = he_mem_array(NULL, count, sizeof **out);
    if (*out != NULL) {
        memset(*out, 0xFF, count * sizeof **out);
    }
    return *out != NULL;
}

he_status he_subdivide_reserve_parents(he_subdivide_step *s, he_error *err)
{
    const he_content *from = s->from, *to = s->to;
    bool done =
        reserve(from, HE_VERTEX, to->vertices.issued - from->vertices.issued, &s->vertex_from) &&
        reserve(from, HE_EDGE, to->edges.issued - from->edges.issued, &s->edge_from) &&
        reserve(from, HE_FACE, to->faces.issued - from->faces.issued, &s->face_from);
    if (done && has_columns(from, HE_HALFEDGE)) {
        s->corner_from = he_mem_zero(2 * (size_t)to->edges.issued, sizeof *s->corner_from);
        done = s->corner_from != NULL;
    }
    return done
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory for the attributes of the finer mesh");
}

/* --- vertices --- */

/* Computes the values of a vertex attribute in the finer mesh by the rules for positions, three
 * components at a time. */
static he_status smooth_column(const he_subdivide_step *s, const he_column *from, he_column *to,
                               he_error *err)
{
    uint32_t rows = s->from->vertices.issued, fine = s->to->vertices.issued;
    he_vec3 *before = he_mem_array(NULL, rows, sizeof *before);
    he_vec3 *after = he_mem_array(NULL, fine, sizeof *after);
    he_status status = HE_OK;
    if (before == NULL || after == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the values of attribute %s",
                               from->name);
    }
    for (uint32_t k = 0; k < from->components && status == HE_OK; k += 3) {
        uint32_t left = from->components - k;
        for (uint32_t v = 0; v < rows; v++) {
            before[v] = (he_vec3){he_column_number(from, v, k),
                                  left > 1 ? he_column_number(from, v, k + 1) : 0,
                                  left > 2 ? he_column_number(from, v, k + 2) : 0};
        }
        status = he_subdivide_place(s, before, after, err);
        for (uint32_t v = 0; v < fine && status == HE_OK; v++) {
            /* The values of deleted vertices stay the default of the attribute. */
            if (s->to->vertex_halfedge[v] == HE_DEAD) {
                continue;
            }
            he_column_put_number(to, k, after[v].x, he_column_row(to, v));
            if (left > 1) {
                he_column_put_number(to, k + 1, after[v].y, he_column_row(to, v));
            }
            if (left > 2) {
                he_column_put_number(to, k + 2, after[v].z, he_column_row(to, v));
            }
        }
    }
    he_mem_free(before);
    he_mem_free(after);
    return status;
}

/* --- corners --- */

static double mean_of_face(const he_subdivide_step *s, const he_column *from, uint32_t first,
                           uint32_t k)
{
    double total = 0, n = 0;
    uint32_t h = first;
    do {
        h = s->from->next[h];
        n++;
    } while (h != first);
    do {
        total += he_column_number(from, h, k) / n;
        h = s->from->next[h];
    } while (h != first);
    return total;
}

static double blended(const he_subdivide_step *s, const he_column *from,
                      const he_corner_source *source, uint32_t k)
{
    switch (source->how) {
    case HE_FROM_MIDDLE:
        return 0.5 * he_column_number(from, source->a, k) +
               0.5 * he_column_number(from, source->b, k);
    case HE_FROM_THIRD:
        return 2.0 / 3 * he_column_number(from, source->a, k) +
               1.0 / 3 * he_column_number(from, source->b, k);
    case HE_FROM_FACE:
        return mean_of_face(s, from, source->a, k);
    case HE_FROM_NOWHERE:
    case HE_FROM_ROW:
    case HE_FROM_NEW:
        break;
    }
    return he_column_number(from, source->a, k);
}

static void fill_corner(const he_subdivide_step *s, const he_column *from, he_column *to,
                        uint32_t h)
{
    const he_corner_source *source = &s->corner_from[h];
    const unsigned char *value = from->fallback;
    if (source->how == HE_FROM_NEW) {
        value = he_column_row(to, source->a);
    } else if (source->how == HE_FROM_ROW ||
               (source->how != HE_FROM_NOWHERE && from->rule == HE_COPY)) {
        value = he_column_value(from, source->a);
    } else if (source->how != HE_FROM_NOWHERE && from->rule == HE_INTERPOLATE) {
        for (uint32_t k = 0; k < from->components; k++) {
            he_column_put_number(to, k, blended(s, from, source, k), he_column_row(to, h));
        }
        return;
    }
    memcpy(he_column_row(to, h), value, from->row_bytes);
}

static he_status carry_corners(const he_subdivide_step *s, const he_column *from, he_column *to,
                               he_error *err)
{
    he_status status = HE_OK;
    /* A new corner may copy the value of another new corner. The copied corner always has the lower
     * id, so a single pass in the order of ids finds its value already computed. */
    for (uint32_t h = 0; h < 2 * s->to->edges.issued && status == HE_OK; h++) {
        status = he_progress_at(s->progress, h, 2 * (uint64_t)s->to->edges.issued, err);
        fill_corner(s, from, to, h);
    }
    return status;
}

/* --- columns --- */

static bool is_feature(const he_column *column)
{
    return column->domain == HE_EDGE && he_is_mark(column, "feature");
}

/* Computes a column of the finer mesh from a column of the coarser mesh. Old elements keep their
 * values. A new element gets the value of its parent, an element of the coarser mesh, unless it has
 * no parent or the attribute's rule is HE_DEFAULT. If `parents` is NULL, no new element has a
 * parent. */
static void carry_rows(const he_column *from, he_column *to, size_t issued, const uint32_t *parents)
{
    for (size_t row = 0; row < to->rows; row++) {
        const unsigned char *value = from->fallback;
        if (row < issued) {
            value = he_column_value(from, row);
        } else if (parents != NULL && parents[row - issued] != HE_NONE &&
                   (from->rule != HE_DEFAULT || is_feature(from))) {
            value = he_column_value(from, parents[row - issued]);
        }
        memcpy(he_column_row(to, row), value, from->row_bytes);
    }
}

static he_status fill(const he_subdivide_step *s, const he_column *from, he_column *to,
                      he_error *err)
{
    switch (from->domain) {
    case HE_VERTEX:
        if (he_is_mark(from, "locked")) {
            carry_rows(from, to, s->from->vertices.issued, NULL);
            return HE_OK;
        }
        if (from->rule == HE_INTERPOLATE) {
            return smooth_column(s, from, to, err);
        }
        carry_rows(from, to, s->from->vertices.issued, s->vertex_from);
        return HE_OK;
    case HE_EDGE:
        carry_rows(from, to, s->from->edges.issued, s->edge_from);
        return HE_OK;
    case HE_FACE:
        carry_rows(from, to, s->from->faces.issued, s->face_from);
        return HE_OK;
    case HE_HALFEDGE:
        return carry_corners(s, from, to, err);
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    memcpy(he_column_row(to, 0), he_column_value(from, 0), from->row_bytes);
    return HE_OK;
}

static he_status carry_column(const he_subdivide_step *s, const he_column *from, he_column **out,
                              he_error *err)
{
    he_column *to;
    he_status status = he_column_like(from, he_content_issued(s->to, from->domain), &to, err);
    if (status != HE_OK) {
        return status;
    }
    status = fill(s, from, to, err);
    if (status != HE_OK) {
        he_column_free(to);
        return status;
    }
    *out = to;
    return HE_OK;
}

he_status he_subdivide_attributes(const he_subdivide_step *s, he_error *err)
{
    const he_content *from = s->from;
    he_content *to = s->to;
    if (from->column_count == 0) {
        return HE_OK;
    }
    to->columns = he_mem_zero(from->column_count, sizeof *to->columns);
    if (to->columns == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the attributes");
    }
    /* Each column keeps its index (slot), because records of changes name columns by this index. */
    to->column_count = to->column_capacity = from->column_count;
    he_status status = HE_OK;
    for (size_t i = 0; i < from->column_count && status == HE_OK; i++) {
        if (from->columns[i] != NULL) {
            status = carry_column(s, from->columns[i], &to->columns[i], err);
        }
    }
    return status;
}
