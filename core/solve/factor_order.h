/* factor_order.h - an order of the rows of a matrix in which its factor has few entries. */
#ifndef HE_SOLVE_FACTOR_ORDER_H
#define HE_SOLVE_FACTOR_ORDER_H

#include "solve/sparse.h"

/* Writes the row that comes first, second, ... to `order`, which has a->n entries: the approximate
 * minimum degree order of SuiteSparse's AMD, whose memory this function allocates.
 * Returns HE_LIMIT if the matrix is too large, and HE_NO_MEMORY. */
HE_NODISCARD he_status he_order_rows(const he_sparse *a, uint32_t *order, he_error *err);

#endif
