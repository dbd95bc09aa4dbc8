#include "solve/sparse.h"

#include <math.h>
#include <string.h>

void he_sparse_clear(he_sparse *matrix)
{
    he_mem_free(matrix->starts);
    he_mem_free(matrix->rows);
    he_mem_free(matrix->values);
    *matrix = (he_sparse){0};
}

/* Allocates a matrix with room for `entries` entries; the starts are zero. */
static he_status allocate(uint32_t n, size_t entries, he_sparse *out, he_error *err)
{
    he_sparse m = {.n = n};
    if (n > HE_SPARSE_ROWS || entries > HE_SPARSE_ENTRIES) {
        return he_fail_plain(err, HE_LIMIT, "a matrix of %u rows and %zu entries is too large", n,
                             entries);
    }
    m.starts = he_mem_zero((size_t)n + 1, sizeof *m.starts);
    m.rows = he_mem_array(NULL, entries > 0 ? entries : 1, sizeof *m.rows);
    m.values = he_mem_array(NULL, entries > 0 ? entries : 1, sizeof *m.values);
    if (m.starts == NULL || m.rows == NULL || m.values == NULL) {
        he_sparse_clear(&m);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a matrix of %u rows", n);
    }
    *out = m;
    return HE_OK;
}

/* Turns the counts of the columns in starts[1] ... starts[n] into the positions at which the
 * columns begin, shifted by one place: starts[j + 1] is where column j begins. Appending an entry
 * to column j advances starts[j + 1], which ends where column j + 1 begins. */
static void begin_columns(he_sparse *m)
{
    size_t sum = 0;
    for (uint32_t j = 0; j < m->n; j++) {
        const size_t count = m->starts[j + 1];
        m->starts[j + 1] = sum;
        sum += count;
    }
}

static void append(he_sparse *m, uint32_t column, uint32_t row, double value)
{
    const size_t at = m->starts[column + 1]++;
    m->rows[at] = row;
    m->values[at] = value;
}

/* Makes the transpose of `from`, whose columns need not be sorted. The columns of the transpose are
 * sorted, and equal entries keep their order. */
static he_status transpose(const he_sparse *from, he_sparse *out, he_error *err)
{
    const size_t entries = from->starts[from->n];
    he_status status = allocate(from->n, entries, out, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < entries; i++) {
        out->starts[from->rows[i] + 1]++;
    }
    begin_columns(out);
    for (uint32_t j = 0; j < from->n; j++) {
        for (size_t i = from->starts[j]; i < from->starts[j + 1]; i++) {
            append(out, from->rows[i], j, from->values[i]);
        }
    }
    return HE_OK;
}

/* Adds up neighbouring entries of sorted columns that are at the same place. */
static void merge(he_sparse *m)
{
    size_t to = 0, from = 0;
    for (uint32_t j = 0; j < m->n; j++) {
        const size_t begin = to, end = m->starts[j + 1];
        for (; from < end; from++) {
            if (to > begin && m->rows[to - 1] == m->rows[from]) {
                m->values[to - 1] += m->values[from];
            } else {
                m->rows[to] = m->rows[from];
                m->values[to] = m->values[from];
                to++;
            }
        }
        m->starts[j] = begin;
        m->starts[j + 1] = end;
    }
    m->starts[m->n] = to;
}

static he_status check_entries(uint32_t n, const he_entry *entries, size_t count, he_error *err)
{
    for (size_t i = 0; i < count; i++) {
        if (entries[i].row >= n || entries[i].column >= n) {
            return he_fail_plain(err, HE_BAD_INDEX,
                                 "entry %zu is at row %u and column %u of a matrix of %u rows", i,
                                 entries[i].row, entries[i].column, n);
        }
        if (!isfinite(entries[i].value)) {
            return he_fail_plain(err, HE_NOT_FINITE,
                                 "the entry at row %u and column %u is not finite", entries[i].row,
                                 entries[i].column);
        }
    }
    return HE_OK;
}

he_status he_sparse_make(uint32_t n, const he_entry *entries, size_t count, he_sparse *out,
                         he_error *err)
{
    he_sparse unsorted = {0}, sorted;
    he_status status = check_entries(n, entries, count, err);
    if (status == HE_OK) {
        status = allocate(n, 2 * count, &unsorted, err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < count; i++) {
        unsorted.starts[entries[i].column + 1]++;
        if (entries[i].row != entries[i].column) {
            unsorted.starts[entries[i].row + 1]++;
        }
    }
    begin_columns(&unsorted);
    for (size_t i = 0; i < count; i++) {
        const he_entry e = entries[i];
        append(&unsorted, e.column, e.row, e.value);
        if (e.row != e.column) {
            append(&unsorted, e.row, e.column, e.value);
        }
    }
    status = transpose(&unsorted, &sorted, err);
    he_sparse_clear(&unsorted);
    if (status == HE_OK) {
        merge(&sorted);
        *out = sorted;
    }
    return status;
}

he_status he_sparse_copy(const he_sparse *a, he_sparse *out, he_error *err)
{
    const size_t entries = a->starts[a->n];
    he_status status = allocate(a->n, entries, out, err);
    if (status == HE_OK) {
        memcpy(out->starts, a->starts, ((size_t)a->n + 1) * sizeof *a->starts);
        memcpy(out->rows, a->rows, entries * sizeof *a->rows);
        memcpy(out->values, a->values, entries * sizeof *a->values);
    }
    return status;
}

void he_sparse_multiply(const he_sparse *a, const double *x, double *y)
{
    for (uint32_t j = 0; j < a->n; j++) {
        double sum = 0;
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            sum += a->values[i] * x[a->rows[i]];
        }
        y[j] = sum;
    }
}

double he_sparse_norm(const he_sparse *a)
{
    double largest = 0;
    for (uint32_t j = 0; j < a->n; j++) {
        double sum = 0;
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            sum += fabs(a->values[i]);
        }
        largest = fmax(largest, sum);
    }
    return largest;
}

/* --- products --- */

/* Scratch memory for one column of a product. */
typedef struct column {
    double *sums;   /* one for each row; only those of listed rows have a meaning */
    uint32_t *seen; /* the number of the last column, plus 1, that has an entry in a row */
    uint32_t *rows; /* the rows of the column's entries */
    uint32_t count;
} column;

static void clear_column(column *c)
{
    he_mem_free(c->sums);
    he_mem_free(c->seen);
    he_mem_free(c->rows);
}

static bool make_column(uint32_t n, column *c)
{
    const size_t room = n > 0 ? n : 1;
    *c = (column){.sums = he_mem_array(NULL, room, sizeof *c->sums),
                  .seen = he_mem_zero(room, sizeof *c->seen),
                  .rows = he_mem_array(NULL, room, sizeof *c->rows)};
    return c->sums != NULL && c->seen != NULL && c->rows != NULL;
}

/* Computes column j of A D B. */
static void multiply_column(const he_sparse *a, const double *d, const he_sparse *b, uint32_t j,
                            column *c)
{
    c->count = 0;
    for (size_t i = b->starts[j]; i < b->starts[j + 1]; i++) {
        const uint32_t k = b->rows[i];
        const double factor = b->values[i] * d[k];
        for (size_t p = a->starts[k]; p < a->starts[k + 1]; p++) {
            const uint32_t row = a->rows[p];
            if (c->seen[row] != j + 1) {
                c->seen[row] = j + 1;
                c->rows[c->count++] = row;
                c->sums[row] = 0;
            }
            c->sums[row] += factor * a->values[p];
        }
    }
}

/* Appends the column that was computed to the matrix, whose arrays grow. */
static he_status take_column(he_sparse *m, size_t *capacity, uint32_t j, const column *c,
                             he_error *err)
{
    const size_t used = m->starts[j], need = used + c->count;
    if (need > HE_SPARSE_ENTRIES) {
        return he_fail_plain(err, HE_LIMIT, "a product of matrices would have more than %d entries",
                             (int)HE_SPARSE_ENTRIES);
    }
    if (need > *capacity) {
        const size_t grown = he_mem_grown(*capacity, need);
        uint32_t *rows = he_mem_array(m->rows, grown, sizeof *rows);
        m->rows = rows != NULL ? rows : m->rows;
        double *values = rows == NULL ? NULL : he_mem_array(m->values, grown, sizeof *values);
        if (values == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for a product of matrices");
        }
        m->values = values;
        *capacity = grown;
    }
    for (uint32_t i = 0; i < c->count; i++) {
        m->rows[used + i] = c->rows[i];
        m->values[used + i] = c->sums[c->rows[i]];
    }
    m->starts[j + 1] = need;
    return HE_OK;
}

he_status he_sparse_columns(const he_product *product, he_sparse *out, he_progress *progress,
                            he_error *err)
{
    const he_sparse *a = product->a, *b = product->b;
    size_t capacity = 4 * a->starts[a->n];
    he_sparse m = {0};
    column c;
    if (!make_column(a->n, &c)) {
        clear_column(&c);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a product of matrices");
    }
    capacity = capacity < HE_SPARSE_ENTRIES ? capacity : HE_SPARSE_ENTRIES;
    he_status status = allocate(a->n, capacity, &m, err);
    for (uint32_t j = 0; j < a->n && status == HE_OK; j++) {
        status = he_progress_at(progress, j, a->n, err);
        if (status == HE_OK && product->skipped != NULL && he_bits_get(product->skipped, j)) {
            m.starts[j + 1] = m.starts[j];
        } else if (status == HE_OK) {
            multiply_column(a, product->d, b, j, &c);
            status = take_column(&m, &capacity, j, &c, err);
        }
    }
    clear_column(&c);
    if (status == HE_OK) {
        *out = m;
    } else {
        he_sparse_clear(&m);
    }
    return status;
}

he_status he_sparse_product(const he_sparse *a, const double *d, const he_sparse *b, he_sparse *out,
                            he_progress *progress, he_error *err)
{
    const he_product product = {.a = a, .d = d, .b = b};
    he_sparse unsorted, sorted;
    he_status status = he_sparse_columns(&product, &unsorted, progress, err);
    if (status != HE_OK) {
        return status;
    }
    /* The product is symmetric, so its transpose is the product with sorted columns. */
    status = transpose(&unsorted, &sorted, err);
    he_sparse_clear(&unsorted);
    if (status == HE_OK) {
        *out = sorted;
    }
    return status;
}

/* --- parts --- */

/* Counts the entries that the columns of a part will have, and returns their sum. */
static size_t count_part(const he_sparse *a, const uint32_t *numbers, size_t *counts)
{
    size_t sum = 0;
    for (uint32_t j = 0; j < a->n; j++) {
        size_t count = 0;
        for (size_t i = a->starts[j]; i < a->starts[j + 1] && numbers[j] != UINT32_MAX; i++) {
            count += numbers[a->rows[i]] != UINT32_MAX;
        }
        if (numbers[j] != UINT32_MAX && counts != NULL) {
            counts[numbers[j]] = count;
        }
        sum += count;
    }
    return sum;
}

he_status he_sparse_part(const he_sparse *a, const uint32_t *numbers, uint32_t n, he_sparse *out,
                         he_error *err)
{
    he_sparse unsorted, sorted;
    he_status status = allocate(n, count_part(a, numbers, NULL), &unsorted, err);
    if (status != HE_OK) {
        return status;
    }
    (void)count_part(a, numbers, unsorted.starts + 1);
    begin_columns(&unsorted);
    for (uint32_t j = 0; j < a->n; j++) {
        const uint32_t number = numbers[j];
        for (size_t i = a->starts[j]; i < a->starts[j + 1] && number != UINT32_MAX; i++) {
            const uint32_t row = numbers[a->rows[i]];
            if (row != UINT32_MAX) {
                append(&unsorted, number, row, a->values[i]);
            }
        }
    }
    status = transpose(&unsorted, &sorted, err);
    he_sparse_clear(&unsorted);
    if (status == HE_OK) {
        *out = sorted;
    }
    return status;
}
