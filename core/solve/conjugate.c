#include "solve/conjugate.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* The right sides are solved together: their numbers of a row follow each other. Each is computed
 * by the same sums in the same order, whether it is alone or together with others. */
enum { TOGETHER = HE_CONJUGATE_SIDES };

/* A row is heavy if the sum of its entries, all but the diagonal made negative, is at least this
 * part of its diagonal entry. Among so many rows one may be lighter. */
static const double HEAVY = 1.0 / 64;
enum { ROWS_A_LIGHT_ONE = 1000 };

/* After so many steps a factor would have been quicker. */
enum { MOST_STEPS = 60 };

/* The steps end when the residual is so much smaller than the right side, in the length of all
 * numbers. */
static const double SMALL = 1e-16;

static const double MOST_ERROR = 64 * DBL_EPSILON;

/* The matrix with rows and columns divided by the square roots of the diagonal, which is then 1;
 * and, for each row and side, the numbers of the method. The matrix is I + L + L', and the method
 * works on (I + L)^-1 A (I + L')^-1. */
typedef struct conjugate {
    const he_sparse *a;
    double *values;
    double *root;      /* of each diagonal entry */
    size_t *diagonal;  /* where each diagonal entry is */
    double *x, *rest;  /* solution and residual of the preconditioned system */
    double *way;       /* the direction of the step */
    double *up, *down; /* (I + L')^-1 way; (I + L)^-1 (way - up) */
} conjugate;

static void clear(conjugate *c)
{
    he_mem_free(c->values);
    he_mem_free(c->root);
    he_mem_free(c->diagonal);
    he_mem_free(c->x);
    he_mem_free(c->rest);
    he_mem_free(c->way);
    he_mem_free(c->up);
    he_mem_free(c->down);
}

static he_status reserve(conjugate *c, he_error *err)
{
    const size_t n = (size_t)c->a->n + 1, room = TOGETHER * n;
    c->values = he_mem_array(NULL, c->a->starts[c->a->n] + 1, sizeof *c->values);
    c->root = he_mem_array(NULL, n, sizeof *c->root);
    c->diagonal = he_mem_array(NULL, n, sizeof *c->diagonal);
    c->x = he_mem_array(NULL, room, sizeof *c->x);
    c->rest = he_mem_array(NULL, room, sizeof *c->rest);
    c->way = he_mem_array(NULL, room, sizeof *c->way);
    c->up = he_mem_array(NULL, room, sizeof *c->up);
    c->down = he_mem_array(NULL, room, sizeof *c->down);
    return c->values != NULL && c->root != NULL && c->diagonal != NULL && c->x != NULL &&
                   c->rest != NULL && c->way != NULL && c->up != NULL && c->down != NULL
               ? HE_OK
               : he_fail_plain(err, HE_NO_MEMORY, "no memory to solve for %u numbers", c->a->n);
}

/* Returns true if nearly all rows are heavy, and all diagonal entries are positive and finite. */
static bool is_heavy(const he_sparse *a)
{
    uint32_t light = 0;
    for (uint32_t i = 0; i < a->n; i++) {
        double diagonal = 0, others = 0;
        for (size_t k = a->starts[i]; k < a->starts[i + 1]; k++) {
            if (a->rows[k] == i) {
                diagonal = a->values[k];
            } else {
                others += fabs(a->values[k]);
            }
        }
        if (!(diagonal >= DBL_MIN && diagonal <= DBL_MAX)) {
            return false;
        }
        light += !(diagonal - others >= HEAVY * diagonal);
    }
    return light <= a->n / ROWS_A_LIGHT_ONE;
}

static void scale(conjugate *c)
{
    const he_sparse *a = c->a;
    for (uint32_t i = 0; i < a->n; i++) {
        for (size_t k = a->starts[i]; k < a->starts[i + 1]; k++) {
            if (a->rows[k] == i) {
                c->diagonal[i] = k;
                c->root[i] = sqrt(a->values[k]);
            }
        }
    }
    for (uint32_t i = 0; i < a->n; i++) {
        for (size_t k = a->starts[i]; k < a->starts[i + 1]; k++) {
            c->values[k] = a->values[k] / c->root[i] / c->root[a->rows[k]];
        }
    }
}

/* Subtracts from the numbers of a row the entries `from` to `to` - 1 times the numbers of their
 * rows. */
static inline void subtract(const conjugate *c, size_t from, size_t to, const double *of,
                            double sums[TOGETHER])
{
    for (size_t k = from; k < to; k++) {
        const double *other = of + TOGETHER * (size_t)c->a->rows[k], value = c->values[k];
        for (size_t s = 0; s < TOGETHER; s++) {
            sums[s] -= value * other[s];
        }
    }
}

/* Sets `way` to the residual plus `again` times the last way, and `up` to the solution of
 * (I + L') up = way. */
static void sweep_up(conjugate *c, const double again[TOGETHER])
{
    for (uint32_t i = c->a->n; i-- > 0;) {
        double sums[TOGETHER];
        for (size_t s = 0; s < TOGETHER; s++) {
            const size_t at = TOGETHER * (size_t)i + s;
            sums[s] = c->way[at] = c->rest[at] + again[s] * c->way[at];
        }
        subtract(c, c->diagonal[i] + 1, c->a->starts[i + 1], c->up, sums);
        memcpy(c->up + TOGETHER * (size_t)i, sums, sizeof sums);
    }
}

/* Replaces `up` by the product of the preconditioned matrix and the way: up + (I + L)^-1 (way -
 * up). Sets `along` to the product of the way and that. */
static void sweep_down(conjugate *c, double along[TOGETHER])
{
    for (size_t s = 0; s < TOGETHER; s++) {
        along[s] = 0;
    }
    for (uint32_t i = 0; i < c->a->n; i++) {
        double sums[TOGETHER];
        const size_t at = TOGETHER * (size_t)i;
        for (size_t s = 0; s < TOGETHER; s++) {
            sums[s] = c->way[at + s] - c->up[at + s];
        }
        subtract(c, c->a->starts[i], c->diagonal[i], c->down, sums);
        memcpy(c->down + at, sums, sizeof sums);
        for (size_t s = 0; s < TOGETHER; s++) {
            c->up[at + s] += sums[s];
            along[s] += c->way[at + s] * c->up[at + s];
        }
    }
}

/* Does a step of the length `step` along the way, and returns the squared length of each residual
 * in `square`. */
static void advance(conjugate *c, const double step[TOGETHER], double square[TOGETHER])
{
    for (size_t s = 0; s < TOGETHER; s++) {
        square[s] = 0;
    }
    for (size_t i = 0; i < c->a->n; i++) {
        for (size_t s = 0; s < TOGETHER; s++) {
            const size_t at = TOGETHER * i + s;
            c->x[at] += step[s] * c->way[at];
            c->rest[at] -= step[s] * c->up[at];
            square[s] += c->rest[at] * c->rest[at];
        }
    }
}

/* Begins with the right sides (I + L)^-1 b and the solution 0. */
static void begin(conjugate *c, const double *right, uint32_t count, double square[TOGETHER])
{
    const size_t n = c->a->n;
    for (size_t s = 0; s < TOGETHER; s++) {
        square[s] = 0;
    }
    for (size_t i = 0; i < n; i++) {
        double sums[TOGETHER] = {0};
        for (size_t s = 0; s < count; s++) {
            sums[s] = right[s * n + i] / c->root[i];
        }
        subtract(c, c->a->starts[i], c->diagonal[i], c->rest, sums);
        memcpy(c->rest + TOGETHER * i, sums, sizeof sums);
        for (size_t s = 0; s < TOGETHER; s++) {
            c->x[TOGETHER * i + s] = c->way[TOGETHER * i + s] = 0;
            square[s] += sums[s] * sums[s];
        }
    }
}

/* Sets x to the solution D^-1/2 (I + L')^-1 x of the given system. */
static void end(conjugate *c)
{
    for (uint32_t i = c->a->n; i-- > 0;) {
        double sums[TOGETHER];
        const size_t at = TOGETHER * (size_t)i;
        memcpy(sums, c->x + at, sizeof sums);
        subtract(c, c->diagonal[i] + 1, c->a->starts[i + 1], c->up, sums);
        memcpy(c->up + at, sums, sizeof sums);
        for (size_t s = 0; s < TOGETHER; s++) {
            c->x[at + s] = sums[s] / c->root[i];
        }
    }
}

/* Returns true if the solution is exact up to a few roundings. */
static bool is_exact(const conjugate *c, const double *right, uint32_t count)
{
    const he_sparse *a = c->a;
    double most[TOGETHER] = {0};
    bool exact = true;
    for (size_t i = 0; i < a->n; i++) {
        for (size_t s = 0; s < count; s++) {
            most[s] = fmax(most[s], fabs(c->x[TOGETHER * i + s]));
        }
    }
    for (uint32_t i = 0; i < a->n; i++) {
        double left[TOGETHER] = {0};
        for (size_t s = 0; s < count; s++) {
            left[s] = right[s * a->n + i];
        }
        for (size_t k = a->starts[i]; k < a->starts[i + 1]; k++) {
            for (size_t s = 0; s < TOGETHER; s++) {
                left[s] -= a->values[k] * c->x[TOGETHER * (size_t)a->rows[k] + s];
            }
        }
        for (size_t s = 0; s < count; s++) {
            exact &= fabs(left[s]) <= MOST_ERROR * a->values[c->diagonal[i]] * most[s];
        }
    }
    return exact;
}

/* Takes steps until all residuals are small. Sets *solved to false if that takes too many. */
static he_status run(conjugate *c, double square[TOGETHER], he_progress *progress, bool *solved,
                     he_error *err)
{
    double goal[TOGETHER], again[TOGETHER] = {0}, along[TOGETHER], step[TOGETHER];
    he_status status = HE_OK;
    for (size_t s = 0; s < TOGETHER; s++) {
        goal[s] = SMALL * SMALL * square[s];
    }
    for (uint32_t i = 0; status == HE_OK; i++) {
        bool any = false;
        for (size_t s = 0; s < TOGETHER; s++) {
            any |= square[s] > goal[s];
        }
        if (!any || i == MOST_STEPS) {
            *solved = !any;
            return HE_OK;
        }
        double before[TOGETHER];
        memcpy(before, square, sizeof before);
        sweep_up(c, again);
        sweep_down(c, along);
        for (size_t s = 0; s < TOGETHER; s++) {
            step[s] = before[s] > goal[s] && along[s] > 0 ? before[s] / along[s] : 0;
        }
        advance(c, step, square);
        for (size_t s = 0; s < TOGETHER; s++) {
            again[s] = step[s] > 0 ? square[s] / before[s] : 0;
        }
        status = he_progress_step(progress, i + 1, MOST_STEPS, err);
    }
    return status;
}

he_status he_conjugate_solve(const he_sparse *a, he_right_sides sides, he_progress *progress,
                             bool *solved, he_error *err)
{
    conjugate c = {.a = a};
    double square[TOGETHER];
    assert(sides.count <= TOGETHER);
    *solved = is_heavy(a);
    if (!*solved) {
        return HE_OK;
    }
    he_status status = reserve(&c, err);
    if (status == HE_OK) {
        scale(&c);
        begin(&c, sides.right, sides.count, square);
        status = run(&c, square, progress, solved, err);
    }
    if (status == HE_OK && *solved) {
        end(&c);
        *solved = is_exact(&c, sides.right, sides.count);
    }
    for (size_t s = 0; status == HE_OK && *solved && s < sides.count; s++) {
        for (size_t i = 0; i < a->n; i++) {
            sides.solution[s * a->n + i] = c.x[TOGETHER * i + s];
        }
    }
    clear(&c);
    return status;
}
