#include "solve/laplacian.h"

#include <math.h>

void he_laplacian_clear(he_laplacian *l)
{
    he_sparse_clear(&l->matrix);
    he_mem_free(l->masses);
    *l = (he_laplacian){0};
}

/* Adds the weight of each edge to the diagonal, and writes its entry. Returns how many there are.
 */
static size_t put_edges(const he_intrinsic *t, double *diagonal, he_entry *entries)
{
    size_t count = 0;
    for (uint32_t s = 0; s < 3 * t->triangles; s++) {
        const uint32_t twin = t->twins[s], next = s % 3 == 2 ? s - 2 : s + 1;
        const uint32_t a = t->corners[s], b = t->corners[next];
        if (a == b || (twin != UINT32_MAX && twin < s)) {
            continue; /* a loop, or the edge was written for its other side */
        }
        double weight = t->cotangents[s] / 2;
        if (twin != UINT32_MAX) {
            /* Less than 0 is a rounding error here, which beside masses of almost 0 would leave a
             * matrix that is not positive definite. */
            weight = fmax(weight + t->cotangents[twin] / 2, 0);
        }
        diagonal[a] += weight;
        diagonal[b] += weight;
        entries[count++] = (he_entry){a, b, -weight};
    }
    return count;
}

static void put_masses(const he_intrinsic *t, double *masses)
{
    const double scale = t->unit * t->unit / 3;
    for (uint32_t i = 0; i < t->triangles; i++) {
        const double third = he_intrinsic_area(t, i) * scale;
        for (uint32_t k = 0; k < 3; k++) {
            masses[t->corners[3 * (size_t)i + k]] += third;
        }
    }
}

static he_status check_masses(const double *masses, uint32_t vertices, he_error *err)
{
    for (uint32_t v = 0; v < vertices; v++) {
        if (!isfinite(masses[v])) {
            return he_fail(err, HE_NOT_FINITE, HE_VERTEX, v,
                           "the area around vertex %u is too large for a number", v);
        }
    }
    return HE_OK;
}

static he_status assemble(const he_surface *surface, const he_intrinsic *t, he_laplacian *out,
                          he_error *err)
{
    const size_t rows = surface->vertices;
    he_entry *entries = he_mem_array(NULL, rows + 3 * (size_t)t->triangles + 1, sizeof *entries);
    double *masses = he_mem_zero(rows + 1, sizeof *masses);
    double *diagonal = he_mem_zero(rows + 1, sizeof *diagonal);
    he_status status = HE_OK;
    if (entries == NULL || masses == NULL || diagonal == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the Laplacian of %u vertices",
                               surface->vertices);
    } else {
        const size_t count = rows + put_edges(t, diagonal, entries + rows);
        for (uint32_t v = 0; v < surface->vertices; v++) {
            entries[v] = (he_entry){v, v, diagonal[v]};
        }
        put_masses(t, masses);
        status = check_masses(masses, surface->vertices, err);
        if (status == HE_OK) {
            status = he_sparse_make(surface->vertices, entries, count, &out->matrix, err);
        }
    }
    he_mem_free(entries);
    he_mem_free(diagonal);
    if (status != HE_OK) {
        he_mem_free(masses);
        return status;
    }
    out->masses = masses;
    out->flips = t->flips;
    return HE_OK;
}

he_status he_laplacian_make(const he_surface *surface, he_progress *progress, he_laplacian *out,
                            he_error *err)
{
    he_intrinsic t;
    he_status status = he_intrinsic_make(surface, &t, err);
    if (status != HE_OK) {
        return status;
    }
    status = he_intrinsic_flip(&t, progress, err);
    if (status == HE_OK) {
        status = assemble(surface, &t, out, err);
    }
    he_intrinsic_clear(&t);
    return status;
}

he_status he_laplacian_step(const he_laplacian *l, double amount, he_sparse *out, he_error *err)
{
    he_sparse m;
    he_status status = he_sparse_copy(&l->matrix, &m, err);
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t j = 0; j < m.n; j++) {
        for (size_t i = m.starts[j]; i < m.starts[j + 1]; i++) {
            m.values[i] = amount * m.values[i] + (m.rows[i] == j ? l->masses[j] : 0);
        }
    }
    *out = m;
    return HE_OK;
}
