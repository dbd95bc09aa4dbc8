/* Sparse systems against dense ones: matrices and their products, factors and solutions, refusals,
 * cancellation and allocations that fail. */
#include "tests/failing.h"
#include "tests/model/random.h"
#include "tests/seed.h"
#include "unit/fixture.h"

#include "solve/conjugate.h"
#include "solve/factor.h"

#include <math.h>
#include <string.h>

enum { MOST = 48 };

typedef struct dense {
    uint32_t n;
    double at[MOST][MOST];
} dense;

static double uniform(md_random *r)
{
    return (double)md_below(r, 20001) / 10000 - 1;
}

/* Makes a random matrix that is positive definite, because each diagonal entry is larger than the
 * sum of the others of its row; entries at the same place are split into two. */
static size_t random_entries(md_random *r, uint32_t n, he_entry *entries, dense *d)
{
    size_t count = 0;
    *d = (dense){.n = n};
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < i; j++) {
            if (md_chance(r, 15)) {
                const double value = uniform(r), part = uniform(r);
                entries[count++] = (he_entry){i, j, value - part};
                entries[count++] = (he_entry){j, i, part};
                d->at[i][j] = d->at[j][i] = value - part + part;
            }
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        double sum = 0.5;
        for (uint32_t j = 0; j < n; j++) {
            sum += fabs(d->at[i][j]);
        }
        d->at[i][i] = sum;
        entries[count++] = (he_entry){i, i, sum};
    }
    return count;
}

static void assert_equals(const he_sparse *m, const dense *d, double tolerance)
{
    assert_int_equal(m->n, d->n);
    for (uint32_t j = 0; j < m->n; j++) {
        double column[MOST] = {0};
        for (size_t i = m->starts[j]; i < m->starts[j + 1]; i++) {
            assert_true(i == m->starts[j] || m->rows[i - 1] < m->rows[i]);
            column[m->rows[i]] = m->values[i];
        }
        for (uint32_t i = 0; i < m->n; i++) {
            assert_true(fabs(column[i] - d->at[i][j]) <= tolerance);
        }
    }
}

/* Solves by Gaussian elimination; the matrix needs no pivots. */
static void eliminate(const dense *d, const double *b, double *x)
{
    long double a[MOST][MOST + 1];
    for (uint32_t i = 0; i < d->n; i++) {
        for (uint32_t j = 0; j < d->n; j++) {
            a[i][j] = d->at[i][j];
        }
        a[i][d->n] = b[i];
    }
    for (uint32_t k = 0; k < d->n; k++) {
        for (uint32_t i = k + 1; i < d->n; i++) {
            const long double factor = a[i][k] / a[k][k];
            for (uint32_t j = k; j <= d->n; j++) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    for (uint32_t i = d->n; i-- > 0;) {
        long double sum = a[i][d->n];
        for (uint32_t j = i + 1; j < d->n; j++) {
            sum -= a[i][j] * x[j];
        }
        x[i] = (double)(sum / a[i][i]);
    }
}

static void solutions_equal_those_of_elimination(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    static he_entry entries[MOST * MOST * 2];
    double worst = 0;
    for (int round = 0; round < 400; round++) {
        dense d;
        he_sparse a;
        he_factor *f = NULL;
        const uint32_t n = 1 + md_below(&r, MOST);
        const size_t count = random_entries(&r, n, entries, &d);
        double b[3 * MOST], x[3 * MOST], expected[MOST], residual;
        assert_int_equal(he_sparse_make(n, entries, count, &a, NULL), HE_OK);
        assert_equals(&a, &d, 0);
        for (uint32_t i = 0; i < 3 * n; i++) {
            x[i] = b[i] = uniform(&r);
        }
        assert_int_equal(he_factor_make(&a, NULL, &f, NULL), HE_OK);
        assert_int_equal(he_factor_rows(f), n);
        assert_true(he_factor_bytes(f) > n * sizeof(double));
        /* the solutions may take the place of the right sides */
        assert_int_equal(he_factor_solve(f, &a, (he_right_sides){x, x, 3, false}, &residual, NULL),
                         HE_OK);
        assert_true(residual <= 1e-12);
        for (uint32_t side = 0; side < 3; side++) {
            eliminate(&d, b + side * n, expected);
            for (uint32_t i = 0; i < n; i++) {
                worst = fmax(worst, fabs(x[side * n + i] - expected[i]));
            }
        }
        he_factor_free(f);
        he_sparse_clear(&a);
    }
    print_message("note: solutions differ by at most %g\n", worst);
    assert_true(worst < 1e-12);
}

/* --- conjugate gradients --- */

enum { WIDE = 40 };

/* Makes the matrix of a step of the heat equation on a square of WIDE by WIDE vertices, with random
 * weights: each diagonal entry is the sum of the others of its row and of `mass`. */
static void make_step(md_random *r, double mass, he_sparse *out)
{
    static he_entry entries[7 * WIDE * WIDE];
    size_t count = 0;
    for (uint32_t i = 0; i < WIDE * WIDE; i++) {
        const uint32_t beside[2] = {i % WIDE + 1 < WIDE ? i + 1 : i, i + WIDE};
        entries[count++] = (he_entry){i, i, mass};
        for (int k = 0; k < 2; k++) {
            if (beside[k] != i && beside[k] < WIDE * WIDE) {
                const double weight = 1.5 + uniform(r);
                entries[count++] = (he_entry){i, beside[k], -weight};
                entries[count++] = (he_entry){i, i, weight};
                entries[count++] = (he_entry){beside[k], beside[k], weight};
            }
        }
    }
    assert_true(count <= sizeof entries / sizeof *entries);
    assert_int_equal(he_sparse_make(WIDE * WIDE, entries, count, out, NULL), HE_OK);
}

static void conjugate_gradients_solve_what_a_factor_solves(void **state)
{
    (void)state;
    enum { N = WIDE * WIDE };
    static double b[3 * N], x[3 * N], alone[N], exact[3 * N];
    md_random r = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        he_sparse a;
        he_factor *f = NULL;
        bool solved = false;
        make_step(&r, 1 + uniform(&r) / 2, &a);
        for (uint32_t i = 0; i < 3 * N; i++) {
            b[i] = i < 2 * N ? uniform(&r) : 0;
        }
        assert_int_equal(
            he_conjugate_solve(&a, (he_right_sides){b, x, 3, false}, NULL, &solved, NULL), HE_OK);
        assert_true(solved);
        assert_int_equal(he_factor_make(&a, NULL, &f, NULL), HE_OK);
        assert_int_equal(he_factor_solve(f, &a, (he_right_sides){b, exact, 3, false}, NULL, NULL),
                         HE_OK);
        for (uint32_t i = 0; i < 3 * N; i++) {
            assert_true(fabs(x[i] - exact[i]) <= 1e-13);
        }
        /* A side has the same bits alone, and the solution may take its place. */
        memcpy(alone, b + N, sizeof alone);
        assert_int_equal(
            he_conjugate_solve(&a, (he_right_sides){alone, alone, 1, false}, NULL, &solved, NULL),
            HE_OK);
        assert_true(solved);
        assert_memory_equal(alone, x + N, sizeof alone);
        he_factor_free(f);
        he_sparse_clear(&a);
    }
}

static void systems_with_a_light_diagonal_are_left_to_a_factor(void **state)
{
    (void)state;
    enum { N = WIDE * WIDE };
    static double b[N], x[N], before[N];
    md_random r = {seed_of_run()};
    static const double masses[] = {0, 1e-6, 1e-3, -3};
    for (uint32_t i = 0; i < N; i++) {
        b[i] = uniform(&r);
        before[i] = x[i] = uniform(&r);
    }
    for (size_t i = 0; i < sizeof masses / sizeof *masses; i++) {
        he_sparse a;
        bool solved = true;
        make_step(&r, masses[i], &a);
        assert_int_equal(
            he_conjugate_solve(&a, (he_right_sides){b, x, 1, false}, NULL, &solved, NULL), HE_OK);
        assert_false(solved);
        assert_memory_equal(x, before, sizeof x);
        he_sparse_clear(&a);
    }
}

static void products_and_parts_equal_dense_ones(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    static he_entry entries[MOST * MOST * 2];
    for (int round = 0; round < 100; round++) {
        static dense d, square, cube, part;
        static dense square_part;
        he_sparse a, a2, a3, p, columns, p2;
        uint32_t numbers[MOST], kept = 0;
        uint64_t skipped[(MOST + 63) / 64] = {0};
        double weights[MOST], y[MOST], x[MOST];
        const uint32_t n = 1 + md_below(&r, MOST);
        const size_t count = random_entries(&r, n, entries, &d);
        assert_int_equal(he_sparse_make(n, entries, count, &a, NULL), HE_OK);
        square = cube = part = square_part = (dense){.n = n};
        for (uint32_t i = 0; i < n; i++) {
            weights[i] = 0.5 + fabs(uniform(&r));
            x[i] = uniform(&r);
            numbers[i] = md_chance(&r, 60) ? kept++ : UINT32_MAX;
            if (numbers[i] == UINT32_MAX) {
                he_bits_set(skipped, i);
            }
        }
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t j = 0; j < n; j++) {
                for (uint32_t k = 0; k < n; k++) {
                    square.at[i][j] += d.at[i][k] * weights[k] * d.at[k][j];
                }
                if (numbers[i] != UINT32_MAX && numbers[j] != UINT32_MAX) {
                    part.at[numbers[i]][numbers[j]] = d.at[i][j];
                    square_part.at[numbers[i]][numbers[j]] = square.at[i][j];
                }
            }
        }
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t j = 0; j < n; j++) {
                for (uint32_t k = 0; k < n; k++) {
                    cube.at[i][j] += d.at[i][k] * weights[k] * square.at[k][j];
                }
            }
        }
        part.n = square_part.n = kept;
        assert_int_equal(he_sparse_product(&a, weights, &a, &a2, NULL, NULL), HE_OK);
        assert_equals(&a2, &square, 1e-10);
        assert_int_equal(he_sparse_product(&a, weights, &a2, &a3, NULL, NULL), HE_OK);
        assert_equals(&a3, &cube, 1e-8);
        assert_int_equal(he_sparse_part(&a, numbers, kept, &p, NULL), HE_OK);
        assert_equals(&p, &part, 0);
        const he_product product = {&a, &a, weights, skipped};
        assert_int_equal(he_sparse_columns(&product, &columns, NULL, NULL), HE_OK);
        for (uint32_t i = 0; i < n; i++) {
            assert_true(numbers[i] != UINT32_MAX || columns.starts[i] == columns.starts[i + 1]);
        }
        assert_int_equal(he_sparse_part(&columns, numbers, kept, &p2, NULL), HE_OK);
        assert_equals(&p2, &square_part, 1e-10);
        he_sparse_multiply(&a, x, y);
        for (uint32_t i = 0; i < n; i++) {
            double sum = 0;
            for (uint32_t j = 0; j < n; j++) {
                sum += d.at[i][j] * x[j];
            }
            assert_true(fabs(sum - y[i]) < 1e-12);
        }
        he_sparse_clear(&a);
        he_sparse_clear(&a2);
        he_sparse_clear(&a3);
        he_sparse_clear(&p);
        he_sparse_clear(&columns);
        he_sparse_clear(&p2);
    }
}

/* The five-point operator of a square of `side` points, which has large supernodes. */
static he_sparse square_of(uint32_t side, double shift)
{
    he_sparse a;
    he_entry *entries = calloc((size_t)side * side * 3, sizeof *entries);
    size_t count = 0;
    assert_non_null(entries);
    for (uint32_t i = 0; i < side * side; i++) {
        entries[count++] = (he_entry){i, i, 4 + shift};
        if (i % side + 1 < side) {
            entries[count++] = (he_entry){i, i + 1, -1};
        }
        if (i + side < side * side) {
            entries[count++] = (he_entry){i, i + side, -1};
        }
    }
    assert_int_equal(he_sparse_make(side * side, entries, count, &a, NULL), HE_OK);
    free(entries);
    return a;
}

static void a_large_system_leaves_nothing_over(void **state)
{
    (void)state;
    enum { SIDE = 150, N = SIDE * SIDE };
    static double b[N], x[N];
    he_sparse a = square_of(SIDE, 0);
    he_factor *f = NULL;
    double residual, worst = 0;
    for (uint32_t i = 0; i < N; i++) {
        x[i] = sin(i);
    }
    he_sparse_multiply(&a, x, b);
    assert_int_equal(he_factor_make(&a, NULL, &f, NULL), HE_OK);
    assert_int_equal(he_factor_solve(f, &a, (he_right_sides){b, b, 1, false}, &residual, NULL),
                     HE_OK);
    for (uint32_t i = 0; i < N; i++) {
        worst = fmax(worst, fabs(x[i] - b[i]));
    }
    print_message("note: residual %g, error %g\n", residual, worst);
    assert_true(residual < 1e-14 && worst < 1e-11);
    he_factor_free(f);
    he_sparse_clear(&a);
}

/* Right sides are solved four at a time; rows of very different sizes and a matrix that is nearly
 * singular make some solutions need an improvement. */
static void a_solution_does_not_depend_on_the_other_sides(void **state)
{
    (void)state;
    enum { SIDE = 60, N = SIDE * SIDE, SIDES = 6 };
    static double b[SIDES * N], x[SIDES * N], alone[N], ones[N];
    md_random r = {seed_of_run()};
    for (int round = 0; round < 4; round++) {
        he_sparse a = square_of(SIDE, 0), hard;
        he_factor *f = NULL;
        double residual;
        for (uint32_t i = 0; i < N; i++) {
            ones[i] = round % 2 == 0 ? 1 : exp2(md_below(&r, 40) - 20.0);
        }
        assert_int_equal(he_sparse_product(&a, ones, &a, &hard, NULL, NULL), HE_OK);
        for (uint32_t i = 0; i < SIDES * N; i++) {
            b[i] = round < 2 ? uniform(&r) : i % N == i / N;
        }
        assert_int_equal(he_factor_make(&hard, NULL, &f, NULL), HE_OK);
        assert_int_equal(
            he_factor_solve(f, &hard, (he_right_sides){b, x, SIDES, false}, &residual, NULL),
            HE_OK);
        assert_true(residual <= 1e-12);
        for (size_t side = 0; side < SIDES; side++) {
            assert_int_equal(he_factor_solve(f, &hard,
                                             (he_right_sides){b + side * N, alone, 1, false}, NULL,
                                             NULL),
                             HE_OK);
            assert_memory_equal(alone, x + side * N, sizeof alone);
        }
        he_factor_free(f);
        he_sparse_clear(&hard);
        he_sparse_clear(&a);
    }
}

/* The Laplacian of a path with random weights maps constants to 0. Rounding leaves something of its
 * last pivot, and hardly ever so much that the matrix seems to be regular. */
static void a_matrix_that_is_singular_up_to_rounding_is_refused(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    unsigned refused = 0;
    for (int round = 0; round < 200; round++) {
        static he_entry entries[MOST * 3];
        size_t count = 0;
        he_sparse a;
        he_factor *f = NULL;
        for (uint32_t i = 0; i + 1 < MOST; i++) {
            const double weight = 1.5 + uniform(&r);
            entries[count++] = (he_entry){i, i, weight};
            entries[count++] = (he_entry){i + 1, i + 1, weight};
            entries[count++] = (he_entry){i, i + 1, -weight};
        }
        assert_int_equal(he_sparse_make(MOST, entries, count, &a, NULL), HE_OK);
        const he_status status = he_factor_make(&a, NULL, &f, NULL);
        assert_true(status == HE_OK || status == HE_BAD_VALUE);
        refused += status == HE_BAD_VALUE;
        he_factor_free(f);
        he_sparse_clear(&a);
    }
    print_message("note: %u of 200 refused\n", refused);
    assert_in_range(refused, 180, 200);
}

static void what_is_wrong_is_refused(void **state)
{
    (void)state;
    he_sparse a;
    he_factor *f = NULL;
    he_error err;
    assert_int_equal(he_sparse_make(2, (he_entry[]){{2, 0, 1}}, 1, &a, &err), HE_BAD_INDEX);
    assert_int_equal(he_sparse_make(2, (he_entry[]){{0, 1, NAN}}, 1, &a, &err), HE_NOT_FINITE);
    assert_int_equal(he_sparse_make(HE_SPARSE_ROWS + 1, NULL, 0, &a, &err), HE_LIMIT);
    static const he_entry bad[][3] = {
        {{0, 0, 1}, {1, 1, 1}, {0, 1, 2}},  /* indefinite */
        {{0, 0, 1}, {1, 1, 1}, {0, 1, -1}}, /* singular */
        {{0, 0, 0}, {1, 1, 1}, {0, 1, 0}},
        {{0, 0, 1}, {1, 1, -1}, {0, 1, 0}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(he_sparse_make(2, bad[i], 3, &a, NULL), HE_OK);
        assert_int_equal(he_factor_make(&a, NULL, &f, &err), HE_BAD_VALUE);
        assert_non_null(strstr(err.text, "not positive definite"));
        he_sparse_clear(&a);
    }
    /* a solution beyond the largest double */
    assert_int_equal(he_sparse_make(1, (he_entry[]){{0, 0, 1e-200}}, 1, &a, NULL), HE_OK);
    assert_int_equal(he_factor_make(&a, NULL, &f, NULL), HE_OK);
    double x = 1e200;
    assert_int_equal(he_factor_solve(f, &a, (he_right_sides){&x, &x, 1, false}, NULL, &err),
                     HE_NOT_FINITE);
    he_factor_free(f);
    he_sparse_clear(&a);
    /* the matrix without rows */
    assert_int_equal(he_sparse_make(0, NULL, 0, &a, NULL), HE_OK);
    assert_int_equal(he_factor_make(&a, NULL, &f, NULL), HE_OK);
    assert_int_equal(he_factor_solve(f, &a, (he_right_sides){&x, &x, 1, false}, NULL, NULL), HE_OK);
    he_factor_free(f);
    he_sparse_clear(&a);
}

static he_status all(const he_entry *entries, size_t count)
{
    const double weights[] = {1, 2, 3, 4};
    double x[] = {1, 2, 3, 4};
    he_sparse a = {0}, b = {0};
    he_factor *f = NULL;
    he_status status = he_sparse_make(4, entries, count, &a, NULL);
    if (status == HE_OK) {
        status = he_sparse_product(&a, weights, &a, &b, NULL, NULL);
    }
    if (status == HE_OK) {
        status = he_factor_make(&b, NULL, &f, NULL);
    }
    if (status == HE_OK) {
        status = he_factor_solve(f, &b, (he_right_sides){x, x, 1, false}, NULL, NULL);
    }
    bool solved = true;
    if (status == HE_OK) {
        status = he_conjugate_solve(&a, (he_right_sides){x, x, 1, false}, NULL, &solved, NULL);
    }
    assert_true(solved);
    he_factor_free(f);
    he_sparse_clear(&a);
    he_sparse_clear(&b);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const he_entry entries[] = {{0, 0, 3}, {1, 1, 3}, {2, 2, 3}, {3, 3, 3},
                                       {0, 1, 1}, {1, 2, 1}, {2, 3, 1}};
    failing f = {0};
    while (failing_next(&f)) {
        (void)failing_status(&f, all(entries, sizeof entries / sizeof *entries));
    }
}

static bool tell_until(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    int *left = context;
    return --*left > 0;
}

static void conjugate_gradients_can_be_cancelled(void **state)
{
    (void)state;
    static double b[WIDE * WIDE], x[WIDE * WIDE];
    md_random r = {seed_of_run()};
    he_sparse a;
    int steps = 1;
    make_step(&r, 1, &a);
    for (uint32_t i = 0; i < WIDE * WIDE; i++) {
        b[i] = uniform(&r);
    }
    for (he_status status = HE_CANCELLED; status != HE_OK; steps++) {
        int left = steps;
        bool solved;
        he_progress progress;
        he_progress_init(&progress, tell_until, &left);
        status = he_conjugate_solve(&a, (he_right_sides){b, x, 1, false}, &progress, &solved, NULL);
        assert_true(status == HE_OK || (status == HE_CANCELLED && x[0] == 0));
    }
    he_sparse_clear(&a);
    assert_in_range(steps, 5, 70);
}

static void work_can_be_cancelled_at_any_step(void **state)
{
    (void)state;
    he_sparse a = square_of(120, 0.1);
    unsigned cancelled = 0;
    for (int steps = 1; steps < 1000; steps++) {
        int left = steps;
        he_progress progress;
        he_factor *f = NULL;
        he_progress_init(&progress, tell_until, &left);
        he_status status = he_factor_make(&a, &progress, &f, NULL);
        if (status == HE_OK) {
            he_factor_free(f);
            break;
        }
        assert_int_equal(status, HE_CANCELLED);
        cancelled++;
    }
    he_sparse_clear(&a);
    assert_in_range(cancelled, 5, 998);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_equal_those_of_elimination),
        cmocka_unit_test(conjugate_gradients_solve_what_a_factor_solves),
        cmocka_unit_test(systems_with_a_light_diagonal_are_left_to_a_factor),
        cmocka_unit_test(conjugate_gradients_can_be_cancelled),
        cmocka_unit_test(products_and_parts_equal_dense_ones),
        cmocka_unit_test(a_large_system_leaves_nothing_over),
        cmocka_unit_test(a_solution_does_not_depend_on_the_other_sides),
        cmocka_unit_test(a_matrix_that_is_singular_up_to_rounding_is_refused),
        cmocka_unit_test(what_is_wrong_is_refused),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(work_can_be_cancelled_at_any_step),
    };
    return cmocka_run_group_tests_name("solve", tests, NULL, NULL);
}
