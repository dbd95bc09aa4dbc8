/* values.c - the attributes of the vertices that fill a hole. */
#include "fill/patch.h"

#include "mesh/layout.h"
#include "mesh/marks.h"
#include "solve/harmonic.h"

#include <string.h>

void he_patch_values_clear(he_patch_values *values)
{
    for (size_t i = 0; i < values->count; i++) {
        he_mem_free(values->columns[i]);
    }
    he_mem_free(values->columns);
    *values = (he_patch_values){.columns = NULL};
}

/* Returns true if new vertices get values in this column from the corners of the hole. */
static bool is_carried(const he_column *column)
{
    return column != NULL && column->domain == HE_VERTEX && column->rule != HE_DEFAULT &&
           !he_is_mark(column, "locked");
}

static uint32_t corner_id(const he_patch *p, uint32_t v)
{
    return he_origin(p->mesh, (he_halfedge){p->loop[v]}).i;
}

/* Prepares the equations whose solutions are harmonic functions on the patch. Sets *out to NULL if
 * they have no solution. */
static he_status prepare(const he_patch *p, he_harmonic **out, he_error *err)
{
    const he_surface surface = {p->vertices, p->triangles, p->corners, p->at};
    he_laplacian l = {.masses = NULL};
    uint64_t *fixed = he_bits_new(p->vertices);
    if (fixed == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %u vertices", p->vertices);
    }
    for (uint32_t v = 0; v < p->rim; v++) {
        he_bits_set(fixed, v);
    }
    he_error why = {.status = HE_OK};
    he_status status = he_laplacian_make(&surface, p->mesh->progress, &l, &why);
    if (status == HE_OK) {
        status = he_harmonic_make(&l, 1, fixed, p->mesh->progress, out, &why);
    }
    he_laplacian_clear(&l);
    he_mem_free(fixed);
    return he_patch_must_stop(status, &why, err) ? status : HE_OK;
}

/* Writes harmonic values of one column. */
static he_status interpolate(const he_patch *p, const he_column *column, const he_harmonic *system,
                             unsigned char *out, he_error *err)
{
    double *values = he_mem_array(NULL, p->vertices, sizeof *values);
    he_status status = values == NULL ? he_fail_plain(err, HE_NO_MEMORY,
                                                      "no memory for values of %s", column->name)
                                      : HE_OK;
    for (uint32_t k = 0; k < column->components && status == HE_OK; k++) {
        for (uint32_t v = 0; v < p->vertices; v++) {
            values[v] = v < p->rim ? he_column_number(column, corner_id(p, v), k) : 0;
        }
        he_error why = {.status = HE_OK};
        status = he_harmonic_solve(system, values, 1, false, NULL, &why);
        const bool solved = status == HE_OK; /* else this component is that of a near corner */
        status = he_patch_must_stop(status, &why, err) ? status : HE_OK;
        for (uint32_t v = p->rim; v < p->vertices && solved; v++) {
            if (isfinite(values[v])) {
                he_column_put_number(column, k, values[v],
                                     out + (size_t)(v - p->rim) * column->row_bytes);
            }
        }
    }
    he_mem_free(values);
    return status;
}

static he_status find_column(const he_patch *p, const he_column *column, unsigned char **out,
                             he_error *err)
{
    *out = he_mem_array(NULL, p->vertices - p->rim, column->row_bytes);
    if (*out == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for values of %s", column->name);
    }
    for (uint32_t v = p->rim; v < p->vertices; v++) {
        memcpy(*out + (size_t)(v - p->rim) * column->row_bytes,
               he_column_value(column, corner_id(p, p->corner[v])), column->row_bytes);
    }
    return HE_OK;
}

static he_status find_all(const he_patch *p, const he_harmonic *system, he_patch_values *out,
                          he_error *err)
{
    const he_content *c = &p->mesh->c;
    he_status status = HE_OK;
    for (size_t i = 0; i < c->column_count && status == HE_OK; i++) {
        const he_column *column = c->columns[i];
        if (!is_carried(column)) {
            continue;
        }
        status = find_column(p, column, &out->columns[i], err);
        if (status == HE_OK && column->rule == HE_INTERPOLATE && system != NULL) {
            status = interpolate(p, column, system, out->columns[i], err);
        }
    }
    return status;
}

he_status he_patch_values_find(const he_patch *p, he_patch_values *out, he_error *err)
{
    const he_content *c = &p->mesh->c;
    bool any = false, interpolated = false;
    for (size_t i = 0; i < c->column_count; i++) {
        any = any || is_carried(c->columns[i]);
        interpolated =
            interpolated || (is_carried(c->columns[i]) && c->columns[i]->rule == HE_INTERPOLATE);
    }
    *out = (he_patch_values){.columns = NULL};
    if (!any || p->vertices == p->rim) {
        return HE_OK;
    }
    he_harmonic *system = NULL;
    out->columns = he_mem_zero(c->column_count, sizeof *out->columns);
    out->count = out->columns == NULL ? 0 : c->column_count;
    he_status status =
        out->columns == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory for attributes") : HE_OK;
    if (status == HE_OK && interpolated) {
        status = prepare(p, &system, err);
    }
    if (status == HE_OK) {
        status = find_all(p, system, out, err);
    }
    he_harmonic_free(system);
    return status;
}
