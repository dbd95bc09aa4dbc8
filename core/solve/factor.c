#include "solve/factor.h"

#include "solve/factor_values.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A pivot that is smaller than this part of the matrix's diagonal entry is rounding alone: the
 * matrix is then singular as far as doubles can tell. */
static const double LEAST_PIVOT = 16 * DBL_EPSILON;

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
    uint32_t *used;   /* rows below a supernode that earlier supernodes of its lists have had */
    double *diagonal; /* of the matrix, for the columns of the present supernode */
    double *product;
    size_t room; /* of product */
    /* the multiplications of matrices since progress was reported, one for two entries that are
     * multiplied */
    uint64_t work;
} scratch;

static void clear_scratch(scratch *w)
{
    he_mem_free(w->place);
    he_mem_free(w->head);
    he_mem_free(w->next);
    he_mem_free(w->used);
    he_mem_free(w->diagonal);
    he_mem_free(w->product);
}

static he_status make_scratch(const he_pattern *s, scratch *w, he_error *err)
{
    const size_t room = (size_t)s->n + 1;
    *w = (scratch){.place = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .head = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .next = he_mem_array(NULL, room, sizeof(uint32_t)),
                   .used = he_mem_zero(room, sizeof(uint32_t)),
                   .diagonal = he_mem_array(NULL, room, sizeof(double))};
    if (w->place == NULL || w->head == NULL || w->next == NULL || w->used == NULL ||
        w->diagonal == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to factor a matrix of %u rows", s->n);
    }
    memset(w->head, 0xFF, room * sizeof *w->head);
    return HE_OK;
}

/* Writes the entries of the matrix into the dense matrix of supernode s, and notes the place of
 * each of its rows. */
static void fill(const he_sparse *a, he_factor *f, uint32_t s, scratch *w)
{
    const he_pattern *pattern = &f->pattern;
    const uint32_t begin = pattern->begins[s], end = pattern->begins[s + 1];
    const uint32_t *below = pattern->below + pattern->starts[s];
    const he_panel d = he_factor_dense(f, s);
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
        w->diagonal[j - begin] = d.at[(j - begin) * (d.step + 1)];
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
    const he_panel d = he_factor_dense(f, s), source = he_factor_dense(f, from);
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
    w->work += (uint64_t)need * source.columns;
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

/* Reports progress once after so much work: a supernode may take seconds. */
static he_status tell(const he_factor *f, uint32_t s, scratch *w, he_progress *progress,
                      he_error *err)
{
    static const uint64_t OFTEN = 1 << 24;
    if (w->work < OFTEN) {
        return HE_OK;
    }
    w->work = 0;
    return he_progress_step(progress, f->pattern.values[s],
                            f->pattern.values[f->pattern.supernodes], err);
}

static he_status factor_supernode(const he_sparse *a, he_factor *f, uint32_t s, scratch *w,
                                  he_progress *progress, he_error *err)
{
    fill(a, f, s, w);
    for (uint32_t from = w->head[s], next; from != UINT32_MAX; from = next) {
        next = w->next[from];
        he_status status = subtract(f, s, from, w, err);
        if (status == HE_OK) {
            status = tell(f, s, w, progress, err);
        }
        if (status != HE_OK) {
            return status;
        }
        enlist(&f->pattern, from, w);
    }
    const he_panel d = he_factor_dense(f, s);
    size_t bad = he_dense_factor(d);
    for (size_t j = 0; j < bad; j++) {
        const double root = d.at[j * (d.step + 1)];
        bad = root * root > LEAST_PIVOT * w->diagonal[j] ? bad : j;
    }
    if (bad < d.columns) {
        return he_fail_plain(err, HE_BAD_VALUE, "the matrix is not positive definite at row %u",
                             f->pattern.order[f->pattern.begins[s] + bad]);
    }
    enlist(&f->pattern, s, w);
    w->work += (uint64_t)d.rows * d.columns * d.columns;
    return tell(f, s, w, progress, err);
}

static he_status compute(const he_sparse *a, he_factor *f, he_progress *progress, he_error *err)
{
    const he_pattern *pattern = &f->pattern;
    scratch w;
    he_status status = make_scratch(pattern, &w, err);
    for (uint32_t s = 0; s < pattern->supernodes && status == HE_OK; s++) {
        const size_t below = he_pattern_below(pattern, s);
        f->most_below = below > f->most_below ? below : f->most_below;
        status = factor_supernode(a, f, s, &w, progress, err);
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
