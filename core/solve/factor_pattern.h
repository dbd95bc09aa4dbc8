/* factor_pattern.h - where the factor of a matrix has entries, which depends on the matrix's
 * pattern alone. */
#ifndef HE_SOLVE_FACTOR_PATTERN_H
#define HE_SOLVE_FACTOR_PATTERN_H

#include "solve/sparse.h"

/* The supernodes of a factor. Supernode s has the columns begins[s] ... begins[s + 1] - 1 in the
 * new numbering. Its columns have entries in its own rows, and in the rows below it that are
 * below[starts[s]] ... below[starts[s + 1] - 1], ascending. Its values are a dense matrix, stored
 * column by column, that begins at values[s] and has a line for each of these rows:
 *
 *              columns
 *            +---------+
 *            | \       |   own rows: the lower triangle is used
 *            |   \     |
 *            |     \   |
 *            +---------+
 *            |         |   rows below
 *            +---------+
 */
typedef struct he_pattern {
    uint32_t n, supernodes;
    uint32_t *order;        /* the old number of each new one */
    uint32_t *number;       /* the new number of each old one */
    uint32_t *begins;       /* supernodes + 1 entries */
    uint32_t *supernode_of; /* of each column */
    size_t *starts;         /* supernodes + 1 entries */
    uint32_t *below;
    size_t *values; /* supernodes + 1 entries; the last is the number of all values */
} he_pattern;

/* Finds an order of the rows that keeps the factor sparse, and the pattern of the factor.
 * Returns HE_LIMIT, HE_CANCELLED or HE_NO_MEMORY; *out is then empty. */
HE_NODISCARD he_status he_pattern_make(const he_sparse *a, he_progress *progress, he_pattern *out,
                                       he_error *err);
void he_pattern_clear(he_pattern *pattern);

static inline uint32_t he_pattern_columns(const he_pattern *pattern, uint32_t s)
{
    return pattern->begins[s + 1] - pattern->begins[s];
}
/* Returns the number of rows below supernode s. */
static inline uint32_t he_pattern_below(const he_pattern *pattern, uint32_t s)
{
    return (uint32_t)(pattern->starts[s + 1] - pattern->starts[s]);
}

#endif
