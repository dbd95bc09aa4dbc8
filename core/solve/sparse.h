/* sparse.h - sparse symmetric matrices of doubles.
 *
 * A matrix has n rows and columns, which are numbered from 0. It is stored by columns, with the
 * entries of both triangles, so column j is also row j:
 *
 *     rows[starts[j]] ... rows[starts[j + 1] - 1]      the rows of the entries of column j,
 * ascending values[...]                                      their values
 *
 * The caller owns the arrays and frees them with he_sparse_clear. {0} is the matrix without rows.
 * Every function that allocates returns HE_NO_MEMORY if memory is out; outputs are then as they
 * were. */
#ifndef HE_SOLVE_SPARSE_H
#define HE_SOLVE_SPARSE_H

#include "base/mem.h"
#include "base/progress.h"

typedef struct he_sparse {
    uint32_t n;
    size_t *starts; /* n + 1 entries */
    uint32_t *rows;
    double *values;
} he_sparse;

/* One entry of a symmetric matrix. An entry outside the diagonal is given for one triangle only and
 * stands for its mirror image, too. */
typedef struct he_entry {
    uint32_t row, column;
    double value;
} he_entry;

/* The largest number of rows, and of stored entries, of a matrix. */
enum { HE_SPARSE_ROWS = 1 << 28, HE_SPARSE_ENTRIES = 1 << 27 };

/* Makes a matrix with `n` rows. Entries at the same place are added in their order. Entries with
 * the value 0 are stored, so that the pattern depends on the places alone.
 * Returns HE_BAD_INDEX if an entry is outside the matrix.
 * Returns HE_NOT_FINITE if a value is not finite.
 * Returns HE_LIMIT if there are more than HE_SPARSE_ROWS rows or HE_SPARSE_ENTRIES entries. */
HE_NODISCARD he_status he_sparse_make(uint32_t n, const he_entry *entries, size_t count,
                                      he_sparse *out, he_error *err);
void he_sparse_clear(he_sparse *matrix);
HE_NODISCARD he_status he_sparse_copy(const he_sparse *a, he_sparse *out, he_error *err);

/* Sets y to A x. Both have n numbers and may not overlap. */
void he_sparse_multiply(const he_sparse *a, const double *x, double *y);

/* Makes the product A D B of two symmetric matrices of equal size with a diagonal matrix between
 * them, which `d` lists. The product must be symmetric, as it is if A = B, or if B = A E A for a
 * diagonal matrix E.
 * Returns HE_LIMIT if the product would have more than HE_SPARSE_ENTRIES entries.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_sparse_product(const he_sparse *a, const double *d, const he_sparse *b,
                                         he_sparse *out, he_progress *progress, he_error *err);

/* The product A D B of two symmetric matrices of equal size with a diagonal matrix between them,
 * which `d` lists. */
typedef struct he_product {
    const he_sparse *a, *b;
    const double *d;
    const uint64_t *skipped; /* the columns that are not needed: a bit set; NULL: all are needed */
} he_product;

/* Makes the columns of a product; those that are not needed stay empty. The rows of a column are in
 * no order: only he_sparse_part and he_sparse_columns, as its `b`, take such a matrix.
 * Returns HE_LIMIT if the columns would have more than HE_SPARSE_ENTRIES entries.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_sparse_columns(const he_product *product, he_sparse *out,
                                         he_progress *progress, he_error *err);

/* Makes the matrix of some rows and the same columns: row i of `a` becomes row numbers[i], or is
 * left out if numbers[i] is UINT32_MAX. The numbers are 0 to n - 1, each used once. The rows of a
 * column of `a` may be in any order, and columns that are left out may be empty. */
HE_NODISCARD he_status he_sparse_part(const he_sparse *a, const uint32_t *numbers, uint32_t n,
                                      he_sparse *out, he_error *err);

/* Returns the largest sum of absolute values of a row, the infinity norm of the matrix. */
double he_sparse_norm(const he_sparse *a);

#endif
