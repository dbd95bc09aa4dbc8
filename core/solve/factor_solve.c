/* factor_solve.c - solutions of linear systems by a factor. */
#include "solve/factor_values.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#define ALWAYS_INLINE inline __attribute__((always_inline))

/* A pass over the factor takes as long as reading it from memory, so up to TOGETHER right sides are
 * solved in one pass: their numbers of a row follow each other. Each side is computed by the same
 * sums in the same order, whether it is alone or together with others, so its solution has the same
 * bits. Functions with a parameter `width` are compiled for each of its constant values. */
enum { TOGETHER = 4, COLUMNS = 4 };

static const double MOST_ERROR = 64 * DBL_EPSILON;

/* Adds the four columns of a matrix, times one number for each column and side, to sums. */
static ALWAYS_INLINE void add_four(he_panel a, const double *values, double *sums, size_t width)
{
    const double *first = a.at, *second = first + a.step, *third = second + a.step;
    const double *fourth = third + a.step;
    for (size_t i = 0; i < a.rows; i++) {
        for (size_t c = 0; c < width; c++) {
            sums[i * width + c] +=
                (first[i] * values[c] + second[i] * values[width + c]) +
                (third[i] * values[2 * width + c] + fourth[i] * values[3 * width + c]);
        }
    }
}

static ALWAYS_INLINE void add_one(he_panel a, const double *values, double *sums, size_t width)
{
    for (size_t i = 0; i < a.rows; i++) {
        for (size_t c = 0; c < width; c++) {
            sums[i * width + c] += a.at[i] * values[c];
        }
    }
}

/* Returns `columns` columns, from column j on, of the rows below a supernode. */
static ALWAYS_INLINE he_panel below_of(he_panel d, size_t j, size_t columns)
{
    return (he_panel){d.at + j * d.step + d.columns, d.rows - d.columns, columns, d.step};
}

/* Replaces x, in the new numbering, by the solution of L y = x. `sums` has room for the rows below
 * a supernode. */
static ALWAYS_INLINE void solve_down(const he_factor *f, double *x, double *sums, size_t width)
{
    const he_pattern *pattern = &f->pattern;
    for (uint32_t s = 0; s < pattern->supernodes; s++) {
        const he_panel d = he_factor_dense(f, s);
        const uint32_t *below = pattern->below + pattern->starts[s];
        double *own = x + pattern->begins[s] * width;
        const size_t count = d.rows - d.columns, four = d.columns - d.columns % COLUMNS;
        for (size_t j = 0; j < d.columns; j++) {
            const double *column = d.at + j * d.step;
            for (size_t c = 0; c < width; c++) {
                own[j * width + c] /= column[j];
            }
            for (size_t i = j + 1; i < d.columns; i++) {
                for (size_t c = 0; c < width; c++) {
                    own[i * width + c] -= column[i] * own[j * width + c];
                }
            }
        }
        memset(sums, 0, count * width * sizeof *sums);
        for (size_t j = 0; j < four; j += COLUMNS) {
            add_four(below_of(d, j, COLUMNS), own + j * width, sums, width);
        }
        for (size_t j = four; j < d.columns; j++) {
            add_one(below_of(d, j, 1), own + j * width, sums, width);
        }
        for (size_t i = 0; i < count; i++) {
            for (size_t c = 0; c < width; c++) {
                x[below[i] * width + c] -= sums[i * width + c];
            }
        }
    }
}

/* Subtracts from one number for each column of a matrix and each side the sum of the column's
 * numbers times those of `rest`. */
static ALWAYS_INLINE void subtract_sums(he_panel a, const double *rest, double *values,
                                        size_t width)
{
    double sums[COLUMNS * TOGETHER] = {0};
    for (size_t i = 0; i < a.rows; i++) {
        for (size_t k = 0; k < a.columns; k++) {
            for (size_t c = 0; c < width; c++) {
                sums[k * width + c] += a.at[k * a.step + i] * rest[i * width + c];
            }
        }
    }
    for (size_t k = 0; k < a.columns * width; k++) {
        values[k] -= sums[k];
    }
}

/* Replaces x by the solution of L' y = x. */
static ALWAYS_INLINE void solve_up(const he_factor *f, double *x, double *rest, size_t width)
{
    const he_pattern *pattern = &f->pattern;
    for (uint32_t s = pattern->supernodes; s-- > 0;) {
        const he_panel d = he_factor_dense(f, s);
        const uint32_t *below = pattern->below + pattern->starts[s];
        double *own = x + pattern->begins[s] * width;
        const size_t count = d.rows - d.columns, four = d.columns - d.columns % COLUMNS;
        for (size_t i = 0; i < count; i++) {
            for (size_t c = 0; c < width; c++) {
                rest[i * width + c] = x[below[i] * width + c];
            }
        }
        for (size_t j = 0; j < four; j += COLUMNS) {
            subtract_sums(below_of(d, j, COLUMNS), rest, own + j * width, width);
        }
        for (size_t j = four; j < d.columns; j++) {
            subtract_sums(below_of(d, j, 1), rest, own + j * width, width);
        }
        for (size_t j = d.columns; j-- > 0;) {
            double *column = d.at + j * d.step;
            const he_panel later = {column + j + 1, d.columns - j - 1, 1, d.step};
            subtract_sums(later, own + (j + 1) * width, own + j * width, width);
            for (size_t c = 0; c < width; c++) {
                own[j * width + c] /= column[j];
            }
        }
    }
}

/* Right sides that are solved together. The arrays have `width` numbers for each row; `permuted` is
 * in the new numbering. */
typedef struct block {
    size_t width;
    double *right, *solution, *permuted;
    double *rows; /* scratch memory for the rows below a supernode */
} block;

static void clear_block(block *b)
{
    he_mem_free(b->right);
    he_mem_free(b->solution);
    he_mem_free(b->permuted);
    he_mem_free(b->rows);
}

static he_status make_block(const he_factor *f, size_t width, block *b, he_error *err)
{
    const size_t room = ((size_t)f->pattern.n + 1) * width;
    *b = (block){.width = width,
                 .right = he_mem_array(NULL, room, sizeof(double)),
                 .solution = he_mem_array(NULL, room, sizeof(double)),
                 .permuted = he_mem_array(NULL, room, sizeof(double)),
                 .rows = he_mem_array(NULL, (f->most_below + 1) * width, sizeof(double))};
    if (b->right == NULL || b->solution == NULL || b->permuted == NULL || b->rows == NULL) {
        clear_block(b);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to solve for %u numbers", f->pattern.n);
    }
    return HE_OK;
}

/* Copies `count` of the right sides, from the side `first` on; further sides are 0. */
static void take_sides(const he_factor *f, he_right_sides sides, uint32_t first, uint32_t count,
                       block *b)
{
    const size_t n = f->pattern.n;
    memset(b->right, 0, n * b->width * sizeof *b->right);
    memset(b->solution, 0, n * b->width * sizeof *b->solution);
    for (uint32_t c = 0; c < count; c++) {
        const double *right = sides.right + (first + c) * n;
        for (size_t i = 0; i < n; i++) {
            b->right[i * b->width + c] = right[i];
        }
    }
}

/* Sets b->permuted to what the solution leaves over: the right side minus A x. Sets `error`, for
 * each side, to the largest quotient of that and the sum of the sizes of all terms of the row
 * (Oettli and Prager 1964): the relative change of A and b for which x is the exact solution. */
static ALWAYS_INLINE void leave(const he_factor *f, const he_sparse *a, block *b, double *error,
                                size_t width)
{
    for (size_t c = 0; c < width; c++) {
        error[c] = 0;
    }
    for (uint32_t j = 0; j < a->n; j++) {
        double sums[TOGETHER] = {0}, sizes[TOGETHER] = {0};
        for (size_t i = a->starts[j]; i < a->starts[j + 1]; i++) {
            for (size_t c = 0; c < width; c++) {
                const double term = a->values[i] * b->solution[a->rows[i] * width + c];
                sums[c] += term;
                sizes[c] += fabs(term);
            }
        }
        double *to = b->permuted + f->pattern.number[j] * width;
        for (size_t c = 0; c < width; c++) {
            const double right = b->right[j * width + c], size = sizes[c] + fabs(right);
            to[c] = right - sums[c];
            error[c] = fabs(to[c]) > error[c] * size ? fabs(to[c]) / size : error[c];
        }
    }
}

/* Replaces the numbers of b->permuted, which are right sides, by their solutions, and adds those of
 * the chosen sides to the solution. */
static ALWAYS_INLINE void improve(const he_factor *f, block *b, const bool *chosen, size_t width)
{
    solve_down(f, b->permuted, b->rows, width);
    solve_up(f, b->permuted, b->rows, width);
    for (uint32_t i = 0; i < f->pattern.n; i++) {
        double *to = b->solution + f->pattern.order[i] * width;
        for (size_t c = 0; c < width; c++) {
            to[c] += chosen[c] ? b->permuted[i * width + c] : 0;
        }
    }
}

/* Solves for all sides of the block. Unless `once` is true, each side is improved once, by a
 * solution for what it leaves over, if its error is larger than a few roundings. */
static ALWAYS_INLINE void solve_block(const he_factor *f, const he_sparse *a, block *b, bool once,
                                      size_t width)
{
    bool chosen[TOGETHER], any = false;
    double error[TOGETHER];
    for (size_t c = 0; c < width; c++) {
        chosen[c] = true;
    }
    for (uint32_t j = 0; j < f->pattern.n; j++) {
        memcpy(b->permuted + f->pattern.number[j] * width, b->right + j * width,
               width * sizeof *b->right);
    }
    improve(f, b, chosen, width);
    if (once) {
        return;
    }
    leave(f, a, b, error, width);
    for (size_t c = 0; c < width; c++) {
        chosen[c] = error[c] > MOST_ERROR;
        any |= chosen[c];
    }
    if (any) {
        improve(f, b, chosen, width);
        leave(f, a, b, error, width);
    }
}

/* Returns the largest absolute value of side c of an array of the block. */
static double largest(const block *b, const double *x, uint32_t n, size_t c)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        const double size = fabs(x[i * b->width + c]);
        most = size > most ? size : most;
    }
    return most;
}

/* Copies the solution of side c of the block. */
static he_status give_side(const block *b, uint32_t n, size_t c, double *solution, he_error *err)
{
    for (uint32_t i = 0; i < n; i++) {
        solution[i] = b->solution[i * b->width + c];
        if (!isfinite(solution[i])) {
            return he_fail_plain(err, HE_NOT_FINITE, "the solution is not finite at row %u", i);
        }
    }
    return HE_OK;
}

he_status he_factor_solve(const he_factor *factor, const he_sparse *a, he_right_sides sides,
                          double *residual, he_error *err)
{
    const uint32_t n = factor->pattern.n;
    block b;
    assert(!sides.once || residual == NULL); /* `once` leaves no residual to look at */
    he_status status = make_block(factor, sides.count == 1 ? 1 : TOGETHER, &b, err);
    if (status != HE_OK) {
        return status;
    }
    const double norm = residual == NULL ? 0 : he_sparse_norm(a);
    double worst = 0;
    for (uint32_t first = 0, count; first < sides.count && status == HE_OK; first += count) {
        count = sides.count - first < b.width ? sides.count - first : (uint32_t)b.width;
        take_sides(factor, sides, first, count, &b);
        if (b.width == 1) {
            solve_block(factor, a, &b, sides.once, 1);
        } else {
            solve_block(factor, a, &b, sides.once, TOGETHER);
        }
        for (uint32_t c = 0; c < count && status == HE_OK; c++) {
            status = give_side(&b, n, c, sides.solution + (size_t)(first + c) * n, err);
            if (residual != NULL) {
                const double scale =
                    norm * largest(&b, b.solution, n, c) + largest(&b, b.right, n, c);
                worst = scale > 0 ? fmax(worst, largest(&b, b.permuted, n, c) / scale) : worst;
            }
        }
    }
    if (residual != NULL) {
        *residual = worst;
    }
    clear_block(&b);
    return status;
}
