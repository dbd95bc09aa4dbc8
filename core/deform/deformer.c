/* deformer.c - makes the system of equations of a deformer. */
#include "deform/deformer.h"

#include "edit/piece/list.h"
#include "solve/laplacian.h"

void he_deformer_free(he_deformer *d)
{
    if (d != NULL) {
        he_mem_free(d->ids);
        he_mem_free(d->handle);
        he_mem_free(d->part);
        he_mem_free(d->points);
        he_mem_free(d->at);
        he_sparse_clear(&d->matrix);
        he_sparse_clear(&d->system);
        he_factor_free(d->factor);
        he_mem_free(d->fields);
        he_mem_free(d);
    }
}

static size_t bytes_of(const he_sparse *a)
{
    return a->starts == NULL ? 0
                             : a->starts[a->n] * (sizeof *a->rows + sizeof *a->values) +
                                   ((size_t)a->n + 1) * sizeof *a->starts;
}

size_t he_deformer_bytes(const he_deformer *d)
{
    const size_t vertex =
        sizeof *d->ids + sizeof *d->handle + sizeof *d->part + sizeof *d->points + sizeof *d->at;
    return sizeof *d + d->vertices * vertex + bytes_of(&d->matrix) + bytes_of(&d->system) +
           (d->factor == NULL ? 0 : he_factor_bytes(d->factor)) + he_deformer_field_bytes(d);
}

const uint32_t *he_deformer_vertices(const he_deformer *d, uint32_t *count)
{
    *count = d->free;
    return d->ids;
}

/* --- the lists --- */

he_status he_deform_check(const he_mesh *m, const he_deform_sets *sets, he_error *err)
{
    if (sets->method >= HE_DEFORM_METHODS || sets->handle_count == 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "no vertex is given that moves");
    }
    he_status status =
        he_list_require(m, HE_VERTEX, sets->handles, sets->handle_count, HE_REPEATED_ELEMENT, err);
    if (status == HE_OK) {
        status =
            he_list_require(m, HE_VERTEX, sets->fixed, sets->fixed_count, HE_REPEATED_ELEMENT, err);
    }
    if (status != HE_OK) {
        return status;
    }
    uint64_t *is_handle = he_bits_new((size_t)he_mesh_issued(m, HE_VERTEX) + 1);
    if (is_handle == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices",
                             he_mesh_issued(m, HE_VERTEX));
    }
    for (size_t i = 0; i < sets->handle_count && status == HE_OK; i++) {
        he_bits_set(is_handle, sets->handles[i]);
    }
    for (size_t i = 0; i < sets->fixed_count && status == HE_OK; i++) {
        const uint32_t v = sets->fixed[i];
        if (he_bits_get(is_handle, v)) {
            status = he_fail(err, HE_REPEATED_ELEMENT, HE_VERTEX, v,
                             "vertex %u is given as one that moves and as one that is fixed", v);
        }
    }
    he_mem_free(is_handle);
    return status;
}

/* --- the system --- */

/* Refuses a vertex of so many neighbours that the product would be too large. */
static he_status require_few_neighbours(const he_deformer *d, const he_sparse *l, he_error *err)
{
    for (uint32_t v = 0; v < d->vertices; v++) {
        const size_t neighbours = l->starts[v + 1] - l->starts[v] - 1;
        if (neighbours > HE_DEFORM_NEIGHBOURS) {
            return he_fail(err, HE_LIMIT, HE_VERTEX, d->ids[v],
                           "vertex %u has %zu neighbours; biharmonic takes at most %d, arap any "
                           "number",
                           d->ids[v], neighbours, (int)HE_DEFORM_NEIGHBOURS);
        }
    }
    return HE_OK;
}

/* Makes L (1/m) L. Masses far below the mean one, of thin triangles, are raised, so that no entry
 * is far above all others. */
static he_status square(he_deformer *d, he_laplacian *l, he_progress *progress, he_error *err)
{
    static const double LEAST = 1e-10; /* part of the mean mass */
    double sum = 0;
    for (uint32_t v = 0; v < d->vertices; v++) {
        sum += l->masses[v];
    }
    for (uint32_t v = 0; v < d->vertices; v++) {
        const double least = LEAST * sum / d->vertices;
        l->masses[v] = sum / (l->masses[v] > least ? l->masses[v] : least);
    }
    return he_sparse_product(&l->matrix, l->masses, &l->matrix, &d->matrix, progress, err);
}

static he_status take_free(he_deformer *d, he_error *err)
{
    uint32_t *numbers = he_mem_array(NULL, (size_t)d->vertices + 1, sizeof *numbers);
    if (numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform %u vertices", d->vertices);
    }
    for (uint32_t v = 0; v < d->vertices; v++) {
        numbers[v] = v < d->free ? v : UINT32_MAX;
    }
    he_status status = he_sparse_part(&d->matrix, numbers, d->free, &d->system, err);
    he_mem_free(numbers);
    return status;
}

/* Multiplies the diagonal of the system by `by`. */
static void raise_diagonal(he_sparse *a, double by)
{
    for (uint32_t j = 0; j < a->n; j++) {
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            a->values[i] *= a->rows[i] == j ? by : 1;
        }
    }
}

/* Factors the system. Beside very thin triangles it may be singular up to rounding. Then its
 * diagonal is raised, which pulls each vertex a little to where the motion of its whole part would
 * take it. */
static he_status factor(he_deformer *d, he_progress *progress, he_error *err)
{
    static const double LEAST = 1e-14, MOST = 1e-3, TIMES = 100;
    he_status status = he_factor_make(&d->system, progress, &d->factor, err);
    if (status == HE_OK) {
        return he_deformer_make_fields(d, err);
    }
    for (double by = LEAST; status == HE_BAD_VALUE && by <= MOST; by *= TIMES) {
        raise_diagonal(&d->system, 1 + by);
        status = he_factor_make(&d->system, progress, &d->factor, err);
    }
    if (status == HE_BAD_VALUE) {
        return he_fail(err, HE_BAD_VALUE, HE_VERTEX, d->ids[0],
                       "the triangles around vertex %u, or others that would follow, are too thin "
                       "to compute with",
                       d->ids[0]);
    }
    return status;
}

/* Replaces the sentence of a refusal, which is about matrices, by one about the mesh. */
static he_status named(const he_deformer *d, he_status status, he_error *err)
{
    return status != HE_LIMIT
               ? status
               : he_fail(err, HE_LIMIT, HE_VERTEX, d->ids[0],
                         "the surface that would follow, %u vertices around vertex %u, is too "
                         "large for one system of equations; fix vertices around a smaller part",
                         d->free, d->ids[0]);
}

static he_status make_system(he_deformer *d, const he_deform_triangles *t, he_progress *progress,
                             he_error *err)
{
    const he_surface surface = {d->vertices, t->count, t->corners, d->points};
    he_laplacian l = {0};
    he_status status = named(d, he_laplacian_make(&surface, progress, &l, err), err);
    if (status == HE_OK && d->method == HE_DEFORM_BIHARMONIC) {
        status = require_few_neighbours(d, &l.matrix, err);
    }
    if (status == HE_OK && d->method == HE_DEFORM_BIHARMONIC) {
        status = named(d, square(d, &l, progress, err), err);
    }
    if (status == HE_OK && d->method == HE_DEFORM_ARAP) {
        d->matrix = l.matrix;
        l.matrix = (he_sparse){0};
    }
    he_laplacian_clear(&l);
    if (status == HE_OK) {
        status = take_free(d, err);
    }
    return status == HE_OK ? named(d, factor(d, progress, err), err) : status;
}

he_status he_deformer_make(const he_mesh *m, const he_deform_sets *sets, he_progress *progress,
                           he_deformer **out, he_error *err)
{
    he_deform_triangles triangles = {0};
    he_deformer *d = he_mem_zero(1, sizeof *d);
    if (d == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to deform a mesh");
    }
    d->method = sets->method;
    he_status status = he_deformer_find_patch(d, m, sets, &triangles, progress, err);
    if (status == HE_OK && d->free > 0) {
        status = make_system(d, &triangles, progress, err);
    }
    he_mem_free(triangles.corners);
    if (status != HE_OK) {
        he_deformer_free(d);
        return status;
    }
    *out = d;
    return HE_OK;
}
