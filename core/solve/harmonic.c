#include "solve/harmonic.h"

struct he_harmonic {
    he_sparse whole;   /* the operator of order k over all vertices; only columns of free vertices
                          are needed, and these are not sorted */
    he_sparse part;    /* its rows and columns of free vertices */
    uint32_t *numbers; /* the row of a vertex in `part`; UINT32_MAX: the vertex is fixed */
    uint32_t free;     /* number of free vertices */
    he_factor *factor;
};

void he_harmonic_free(he_harmonic *h)
{
    if (h != NULL) {
        he_sparse_clear(&h->whole);
        he_sparse_clear(&h->part);
        he_factor_free(h->factor);
        he_mem_free(h->numbers);
        he_mem_free(h);
    }
}

static size_t bytes_of(const he_sparse *m)
{
    return m->starts[m->n] * (sizeof *m->rows + sizeof *m->values) +
           ((size_t)m->n + 1) * sizeof *m->starts;
}

size_t he_harmonic_bytes(const he_harmonic *h)
{
    return sizeof *h + bytes_of(&h->whole) + bytes_of(&h->part) + he_factor_bytes(h->factor) +
           h->whole.n * sizeof *h->numbers;
}

/* Makes the columns of free vertices of L, L (1/m) L, or L (1/m) L (1/m) L. */
static he_status make_power(const he_laplacian *l, unsigned k, const uint64_t *fixed,
                            he_sparse *out, he_progress *progress, he_error *err)
{
    const he_sparse *base = &l->matrix;
    double *inverse = he_mem_array(NULL, (size_t)base->n + 1, sizeof *inverse);
    he_sparse power = {0};
    he_status status = HE_OK;
    if (inverse == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory for the Laplacian of %u vertices", base->n);
    }
    for (uint32_t v = 0; v < base->n && status == HE_OK; v++) {
        inverse[v] = l->masses[v] > 0 ? 1 / l->masses[v] : 0;
    }
    if (status == HE_OK && k == 1) {
        status = he_sparse_copy(base, &power, err);
    } else if (status == HE_OK) {
        const he_product square = {base, base, inverse, fixed};
        status = he_sparse_columns(&square, &power, progress, err);
    }
    if (status == HE_OK && k == 3) {
        const he_product product = {base, &power, inverse, fixed};
        he_sparse cube;
        status = he_sparse_columns(&product, &cube, progress, err);
        he_sparse_clear(&power);
        power = status == HE_OK ? cube : power;
    }
    he_mem_free(inverse);
    if (status == HE_OK) {
        *out = power;
    }
    return status;
}

static he_status number_free(he_harmonic *h, const uint64_t *fixed, he_error *err)
{
    h->numbers = he_mem_array(NULL, (size_t)h->whole.n + 1, sizeof *h->numbers);
    if (h->numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a system of %u vertices",
                             h->whole.n);
    }
    for (uint32_t v = 0; v < h->whole.n; v++) {
        h->numbers[v] = he_bits_get(fixed, v) ? UINT32_MAX : h->free++;
    }
    return HE_OK;
}

/* Puts the vertices that an entry of the operator joins to vertex v on the stack, unless they are
 * marked. */
static void reach_neighbours(const he_sparse *m, uint32_t v, uint64_t *marked, uint32_t *stack,
                             uint32_t *count)
{
    for (size_t i = m->starts[v]; i < m->starts[v + 1]; i++) {
        const uint32_t other = m->rows[i];
        if (m->values[i] != 0 && !he_bits_get(marked, other)) {
            he_bits_set(marked, other);
            stack[(*count)++] = other;
        }
    }
}

/* Checks that each free vertex is connected with a fixed one. */
static he_status check_components(const he_sparse *m, const uint64_t *fixed, he_error *err)
{
    uint64_t *marked = he_bits_new((size_t)m->n + 1);
    uint32_t *stack = he_mem_array(NULL, (size_t)m->n + 1, sizeof *stack), count = 0;
    he_status status = HE_OK;
    if (marked == NULL || stack == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a system of %u vertices", m->n);
    }
    for (uint32_t v = 0; v < m->n && status == HE_OK; v++) {
        if (he_bits_get(fixed, v) && !he_bits_get(marked, v)) {
            he_bits_set(marked, v);
            stack[count++] = v;
        }
        while (count > 0) {
            reach_neighbours(m, stack[--count], marked, stack, &count);
        }
    }
    for (uint32_t v = 0; v < m->n && status == HE_OK; v++) {
        if (!he_bits_get(marked, v)) {
            status = he_fail(err, HE_BAD_VALUE, HE_VERTEX, v,
                             "no vertex is fixed in the component of vertex %u", v);
        }
    }
    he_mem_free(marked);
    he_mem_free(stack);
    return status;
}

he_status he_harmonic_make(const he_laplacian *l, unsigned k, const uint64_t *fixed,
                           he_progress *progress, he_harmonic **out, he_error *err)
{
    he_harmonic *h = he_mem_zero(1, sizeof *h);
    if (h == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a system of equations");
    }
    he_status status = check_components(&l->matrix, fixed, err);
    if (status == HE_OK) {
        status = make_power(l, k, fixed, &h->whole, progress, err);
    }
    if (status == HE_OK) {
        status = number_free(h, fixed, err);
    }
    if (status == HE_OK) {
        status = he_sparse_part(&h->whole, h->numbers, h->free, &h->part, err);
    }
    if (status == HE_OK) {
        status = he_factor_make(&h->part, progress, &h->factor, err);
    }
    if (status != HE_OK) {
        he_harmonic_free(h);
        return status;
    }
    *out = h;
    return HE_OK;
}

/* Sets the right side of a free vertex to minus what the fixed ones contribute. */
static void move_fixed(const he_harmonic *h, const double *values, double *right)
{
    const he_sparse *m = &h->whole;
    for (uint32_t j = 0; j < m->n; j++) {
        double sum = 0;
        for (size_t i = m->starts[j]; i < m->starts[j + 1] && h->numbers[j] != UINT32_MAX; i++) {
            if (h->numbers[m->rows[i]] == UINT32_MAX) {
                sum += m->values[i] * values[m->rows[i]];
            }
        }
        if (h->numbers[j] != UINT32_MAX) {
            right[h->numbers[j]] = -sum;
        }
    }
}

he_status he_harmonic_solve(const he_harmonic *h, double *values, uint32_t sides, bool once,
                            double *residual, he_error *err)
{
    const size_t n = h->whole.n;
    double *right = he_mem_array(NULL, (size_t)h->free * sides + 1, sizeof *right);
    if (right == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to solve for %u numbers", h->free);
    }
    for (uint32_t side = 0; side < sides; side++) {
        move_fixed(h, values + side * n, right + (size_t)side * h->free);
    }
    he_status status = he_factor_solve(h->factor, &h->part,
                                       (he_right_sides){right, right, sides, once}, residual, err);
    for (uint32_t side = 0; side < sides && status == HE_OK; side++) {
        for (uint32_t v = 0; v < n; v++) {
            if (h->numbers[v] != UINT32_MAX) {
                values[side * n + v] = right[(size_t)side * h->free + h->numbers[v]];
            }
        }
    }
    he_mem_free(right);
    return status;
}
