/* factor_values.h - what a factor consists of, for the sources that compute and use it. */
#ifndef HE_SOLVE_FACTOR_VALUES_H
#define HE_SOLVE_FACTOR_VALUES_H

#include "solve/dense.h"
#include "solve/factor.h"
#include "solve/factor_pattern.h"

struct he_factor {
    he_pattern pattern;
    double *values;
    size_t most_below; /* rows below a supernode */
};

/* Returns the dense matrix of supernode s. */
static inline he_panel he_factor_dense(const he_factor *f, uint32_t s)
{
    const size_t columns = he_pattern_columns(&f->pattern, s);
    const size_t rows = columns + he_pattern_below(&f->pattern, s);
    return (he_panel){f->values + f->pattern.values[s], rows, columns, rows};
}

#endif
