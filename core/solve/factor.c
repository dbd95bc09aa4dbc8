#include "solve/factor.h"

#include "solve/dense.h"
#include "solve/factor_pattern.h"

#include <math.h>
#include <string.h>

struct he_factor {
    he_pattern pattern;
    double *values;
    size_t most_below; /* of a supernode */
};

void he_factor_free(he_factor *factor)
{
    if (factor != NULL) {
        he_pattern_clear(&factor->pattern);
        he_mem_free(factor->values);
        he_mem_free(factor);
    }
}

uint32_t he_factor_rows(const he_factor *factor)
{
    return factor->pattern.n;
}

size_t he_factor_bytes(const he_factor *factor)
{
    const he_pattern *s = &factor->pattern;
    return sizeof *factor + s->values[s->supernodes] * sizeof(double) +
           s->starts[s->supernodes] * sizeof(uint32_t) +
           ((size_t)s->n + 1) * (4 * sizeof(uint32_t) + 2 * sizeof(size_t));
}

/* --- numbers --- */

/* Scratch memory while the numbers of a factor are computed. The supernodes whose rows below reach
 * into a later supernode are in a list of that one. */
typedef struct scratch {
    uint32_t *place; /* of a row in the dense matrix of the present supernode */
    uint32_t *head;  /* the first supernode in the list of a supernode; UINT32_MAX: none */
    uint32_t *next;
    uint32_t *used; /* rows below a supernode that earlier supernodes of its lists have had */
    double *product;
    size_t room; /* of product */
} scratch;

static void clear_scratch(scratch *w)
{
    he_mem_free(w->place);
    he_mem_free(w->head);
    he_mem_free(w->next);
    he_mem_free(w->used);
    he_mem_free(w->product);
}

static he_status make_scratch(const he_pattern *s, scratch *w, he_error *err)
{
    const size_t room = (size_t)s->n + 1;
    *w = (scratch){.place = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .head = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .next = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .used = he_mem_zero(room, sizeof(uint32_t))};
    if (w->place == NULL || w->head == NULL || w->next == NULL || w->used == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix of %u rows", s->n);
    }
    memset(w->head, 0xFF, room * sizeof *w->head);
    return HE_OK;
}

static he_panel dense_of(const he_factor *f, uint32_t s)
{
    const size_t columns = he_pattern_columns(&f->pattern, s);
    const size_t rows = columns + he_pattern_below(&f->pattern, s);
    return (he_panel){f->values + f->pattern.values[s], rows, columns, rows};
}

/* Writes the entries of the matrix into the dense matrix of supernode s, and notes the place of
 * each of its rows. */
static void fill(const he_sparse *a, he_factor *f, uint32_t s, scratch *w)
{
    const he_pattern *pattern = &f->pattern;
    const uint32_t begin = pattern->begins[s], end = pattern->begins[s + 1];
    const uint32_t *below = pattern->below + pattern->starts[s];
    const he_panel d = dense_of(f, s);
    for (uint32_t j = begin; j < end; j++) {
        w->place[j] = j - begin;
    }
    for (uint32_t i = 0; i < he_pattern_below(pattern, s); i++) {
        w->place[below[i]] = end - begin + i;
    }
    for (uint32_t j = begin; j < end; j++) {
        const uint32_t old = pattern->order[j];
        for (size_t i = a->starts[old]; i < a->starts[old + 1]; i++) {
            const uint32_t row = pattern->number[a->rows[i]];
            if (row >= j) {
                d.at[w->place[row] + (j - begin) * d.step] = a->values[i];
            }
        }
    }
}

/* Subtracts from supernode s what the earlier supernode `from` contributes to it. Returns the
 * number of the rows of `from` that are columns of s. */
static he_status subtract(he_factor *f, uint32_t s, uint32_t from, scratch *w, he_error *err)
{
    const he_pattern *pattern = &f->pattern;
    const uint32_t begin = pattern->begins[s], end = pattern->begins[s + 1], used = w->used[from];
    const uint32_t *rows = pattern->below + pattern->starts[from] + used;
    const uint32_t count = he_pattern_below(pattern, from) - used;
    const he_panel d = dense_of(f, s), source = dense_of(f, from);
    uint32_t columns = 0;
    while (columns < count && rows[columns] < end) {
        columns++;
    }
    const size_t need = (size_t)count * columns;
    if (need > w->room || w->product == NULL) {
        double *product = he_mem_array(w->product, need, sizeof *product);
        if (product == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix of %u rows",
                                 pattern->n);
        }
        w->product = product;
        w->room = need;
    }
    memset(w->product, 0, need * sizeof *w->product);
    const he_panel left = {source.at + source.columns + used, count, source.columns, source.step};
    he_panel right = left;
    right.rows = columns;
    he_dense_subtract(left, right, (he_panel){w->product, count, columns, count});
    for (uint32_t j = 0; j < columns; j++) {
        double *column = d.at + (rows[j] - begin) * d.step;
        const double *product = w->product + (size_t)j * count;
        for (uint32_t i = j; i < count; i++) {
            column[w->place[rows[i]]] += product[i];
        }
    }
    w->used[from] = used + columns;
    return HE_OK;
}

/* Puts a supernode into the list of the supernode that has its first row below that is not used
 * yet. */
static void enlist(const he_pattern *pattern, uint32_t s, scratch *w)
{
    if (w->used[s] < he_pattern_below(pattern, s)) {
        const uint32_t row = pattern->below[pattern->starts[s] + w->used[s]];
        const uint32_t target = pattern->supernode_of[row];
        w->next[s] = w->head[target];
        w->head[target] = s;
    }
}

static he_status factor_supernode(const he_sparse *a, he_factor *f, uint32_t s, scratch *w,
                                  he_error *err)
{
    fill(a, f, s, w);
    for (uint32_t from = w->head[s], next; from != UINT32_MAX; from = next) {
        next = w->next[from];
        he_status status = subtract(f, s, from, w, err);
        if (status != HE_OK) {
            return status;
        }
        enlist(&f->pattern, from, w);
    }
    const he_panel d = dense_of(f, s);
    const size_t bad = he_dense_factor(d);
    if (bad < d.columns) {
        return he_fail_plain(err, HE_BAD_VALUE, "the matrix is not positive definite at row %u",
                             f->pattern.order[f->pattern.begins[s] + bad]);
    }
    enlist(&f->pattern, s, w);
    return HE_OK;
}

static he_status compute(const he_sparse *a, he_factor *f, he_progress *progress, he_error *err)
{
    const he_pattern *pattern = &f->pattern;
    const size_t all = pattern->values[pattern->supernodes];
    scratch w;
    he_status status = make_scratch(pattern, &w, err);
    size_t told = 0;
    for (uint32_t s = 0; s < pattern->supernodes && status == HE_OK; s++) {
        const size_t below = he_pattern_below(pattern, s);
        f->most_below = below > f->most_below ? below : f->most_below;
        status = factor_supernode(a, f, s, &w, err);
        if (status == HE_OK && pattern->values[s] - told >= 1 << 16) {
            told = pattern->values[s];
            status = he_progress_step(progress, told, all, err);
        }
    }
    clear_scratch(&w);
    return status;
}

he_status he_factor_make(const he_sparse *a, he_progress *progress, he_factor **out, he_error *err)
{
    he_factor *f = he_mem_zero(1, sizeof *f);
    if (f == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix");
    }
    he_status status = he_pattern_make(a, progress, &f->pattern, err);
    if (status == HE_OK) {
        f->values = he_mem_zero(f->pattern.values[f->pattern.supernodes] + 1, sizeof *f->values);
        status = f->values == NULL
                     ? he_fail_plain(err, HE_NO_MEMORY,
                                     "no memory for the factor of a matrix of %u rows", a->n)
                     : compute(a, f, progress, err);
    }
    if (status != HE_OK) {
        he_factor_free(f);
        return status;
    }
    *out = f;
    return HE_OK;
}

/* --- solutions --- */

/* Replaces x, in the new numbering, by the solution of L y = x. `sums` has room for the rows below
 * a supernode. */
static void solve_down(const he_factor *f, double *x, double *sums)
{
    const he_pattern *pattern = &f->pattern;
    for (uint32_t s = 0; s < pattern->supernodes; s++) {
        const he_panel d = dense_of(f, s);
        const uint32_t *below = pattern->below + pattern->starts[s];
        double *own = x + pattern->begins[s];
        const size_t count = d.rows - d.columns;
        memset(sums, 0, count * sizeof *sums);
        for (size_t j = 0; j < d.columns; j++) {
            const double *column = d.at + j * d.step;
            const double value = own[j] /= column[j];
            for (size_t i = j + 1; i < d.columns; i++) {
                own[i] -= column[i] * value;
            }
            for (size_t i = 0; i < count; i++) {
                sums[i] += column[d.columns + i] * value;
            }
        }
        for (size_t i = 0; i < count; i++) {
            x[below[i]] -= sums[i];
        }
    }
}

/* Replaces x by the solution of L' y = x. */
static void solve_up(const he_factor *f, double *x, double *rest)
{
    const he_pattern *pattern = &f->pattern;
    for (uint32_t s = pattern->supernodes; s-- > 0;) {
        const he_panel d = dense_of(f, s);
        const uint32_t *below = pattern->below + pattern->starts[s];
        double *own = x + pattern->begins[s];
        const size_t count = d.rows - d.columns;
        for (size_t i = 0; i < count; i++) {
            rest[i] = x[below[i]];
        }
        for (size_t j = d.columns; j-- > 0;) {
            const double *column = d.at + j * d.step;
            double value = own[j];
            for (size_t i = 0; i < count; i++) {
                value -= column[d.columns + i] * rest[i];
            }
            for (size_t i = j + 1; i < d.columns; i++) {
                value -= column[i] * own[i];
            }
            own[j] = value / column[j];
        }
    }
}

/* Scratch memory of a solution: two vectors, and the rows below a supernode. */
typedef struct vectors {
    double *permuted, *left, *rows;
} vectors;

static void clear_vectors(vectors *v)
{
    he_mem_free(v->permuted);
    he_mem_free(v->left);
    he_mem_free(v->rows);
}

static he_status make_vectors(const he_factor *f, vectors *v, he_error *err)
{
    const size_t room = (size_t)f->pattern.n + 1;
    *v = (vectors){.permuted = he_mem_array(NULL, room, sizeof(double)),
                   .left = he_mem_array(NULL, room, sizeof(double)),
                   .rows = he_mem_array(NULL, f->most_below + 1, sizeof(double))};
    if (v->permuted == NULL || v->left == NULL || v->rows == NULL) {
        clear_vectors(v);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to solve for %u numbers", f->pattern.n);
    }
    return HE_OK;
}

/* Sets v->permuted to the solution for the right side `b`. */
static void solve_one(const he_factor *f, const double *b, vectors *v)
{
    for (uint32_t i = 0; i < f->pattern.n; i++) {
        v->permuted[i] = b[f->pattern.order[i]];
    }
    solve_down(f, v->permuted, v->rows);
    solve_up(f, v->permuted, v->rows);
}

static double largest(const double *x, uint32_t n)
{
    double most = 0;
    for (uint32_t i = 0; i < n; i++) {
        most = fabs(x[i]) > most ? fabs(x[i]) : most;
    }
    return most;
}

/* Sets v->left to b - A x. */
static void leave(const he_sparse *a, const double *b, const double *x, double *left)
{
    he_sparse_multiply(a, x, left);
    for (uint32_t i = 0; i < a->n; i++) {
        left[i] = b[i] - left[i];
    }
}

he_status he_factor_solve(const he_factor *factor, const he_sparse *a, he_right_sides sides,
                          double *residual, he_error *err)
{
    const uint32_t n = factor->pattern.n;
    vectors v;
    he_status status = make_vectors(factor, &v, err);
    if (status != HE_OK) {
        return status;
    }
    double *copy = he_mem_array(NULL, (size_t)n + 1, sizeof *copy);
    if (copy == NULL) {
        clear_vectors(&v);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to solve for %u numbers", n);
    }
    const double norm = he_sparse_norm(a);
    double worst = 0;
    for (uint32_t side = 0; side < sides.count && status == HE_OK; side++) {
        double *solution = sides.solution + (size_t)side * n;
        memcpy(copy, sides.right + (size_t)side * n, n * sizeof *copy); /* may be the solution */
        solve_one(factor, copy, &v);
        for (uint32_t i = 0; i < n; i++) {
            solution[factor->pattern.order[i]] = v.permuted[i];
        }
        leave(a, copy, solution, v.left);
        solve_one(factor, v.left, &v);
        for (uint32_t i = 0; i < n; i++) {
            solution[factor->pattern.order[i]] += v.permuted[i];
        }
        leave(a, copy, solution, v.left);
        for (uint32_t i = 0; i < n && status == HE_OK; i++) {
            if (!isfinite(solution[i])) {
                status =
                    he_fail_plain(err, HE_NOT_FINITE, "the solution is not finite at row %u", i);
            }
        }
        const double scale = norm * largest(solution, n) + largest(copy, n);
        worst = scale > 0 ? fmax(worst, largest(v.left, n) / scale) : worst;
    }
    if (residual != NULL) {
        *residual = worst;
    }
    he_mem_free(copy);
    clear_vectors(&v);
    return status;
}
