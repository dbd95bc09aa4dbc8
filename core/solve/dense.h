/* dense.h - products and factors of dense matrices, which are stored column by column: entry (i, j)
 * of a matrix with lines of `a_step` numbers between two columns is a[i + j * a_step]. */
#ifndef HE_SOLVE_DENSE_H
#define HE_SOLVE_DENSE_H

#include "base/status.h"

#include <stddef.h>

/* A dense matrix in a larger one. */
typedef struct he_panel {
    double *at;
    size_t rows, columns;
    size_t step; /* numbers from one column to the next */
} he_panel;

/* Subtracts A B' from C: C has as many rows as A and as many columns as B has rows; A and B have
 * the same number of columns. */
void he_dense_subtract(he_panel a, he_panel b, he_panel c);

/* Factors the upper part of a matrix, the square of its first `columns` rows, into L L', of which
 * the lower triangle is given and is replaced by L; divides the rows below by L'. Returns the
 * column of the first pivot that is not a positive number, or `columns` if there is none. */
size_t he_dense_factor(he_panel a);

#endif
