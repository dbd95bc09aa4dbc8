/* factor.h - factors of sparse symmetric positive definite matrices, and solutions of linear
 * systems by them.
 *
 * A matrix A is factored into P A P' = L L', where P is a permutation that keeps L sparse
 * (Amestoy, Davis and Duff, An approximate minimum degree ordering algorithm, 1996; SuiteSparse's
 * AMD). The columns of L are kept in supernodes: runs of columns that have entries in the same
 * rows, which are computed as dense matrices (Ng and Peyton, Block sparse Cholesky algorithms on
 * advanced uniprocessor computers, 1993). The result has the same bits on every machine. */
#ifndef HE_SOLVE_FACTOR_H
#define HE_SOLVE_FACTOR_H

#include "solve/sparse.h"

typedef struct he_factor he_factor;

/* Factors a matrix. The caller owns the factor. Takes the time and the memory of the entries of L:
 * for the surface of a mesh of n vertices about 30 n log2(n) / 10 entries.
 * Returns HE_BAD_VALUE if the matrix is not positive definite, or singular up to rounding.
 * Returns HE_LIMIT if L would be too large for its indices.
 * Returns HE_CANCELLED if the work was cancelled, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_factor_make(const he_sparse *a, he_progress *progress, he_factor **out,
                                      he_error *err);
void he_factor_free(he_factor *factor);
/* Returns the bytes that a factor occupies. */
size_t he_factor_bytes(const he_factor *factor);
/* Returns the number of rows of the factored matrix. */
uint32_t he_factor_rows(const he_factor *factor);

/* Several right sides and their solutions. Both arrays have `count` columns of one number for each
 * row, column after column, and may be the same array. */
typedef struct he_right_sides {
    const double *right;
    double *solution;
    uint32_t count;
    /* Do not look at the errors of the solutions and improve them, which takes as long again: for
     * steps of a method whose next step starts from any approximation. `residual` must be NULL. */
    bool once;
} he_right_sides;

/* Solves A X = B. `a` is the matrix that was factored; a solution whose error is larger
 * than a few roundings is improved once, by solving for what it leaves over. Four sides take hardly
 * longer than one, and a solution has the same bits whatever the other sides are. If `residual` is
 * not NULL, it receives the largest of |A x - b| /
 * (|A| |x| + |b|) in the norm of the largest number. Returns HE_NOT_FINITE if a solution is not
 * finite; the solutions then have no meaning. Returns HE_NO_MEMORY. */
HE_NODISCARD he_status he_factor_solve(const he_factor *factor, const he_sparse *a,
                                       he_right_sides sides, double *residual, he_error *err);

#endif
