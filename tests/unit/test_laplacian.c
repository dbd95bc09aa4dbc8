/* Intrinsic Delaunay triangulations, Laplacians and harmonic functions: known values, properties of
 * random and of degenerate surfaces, and allocations that fail. */
#include "tests/failing.h"
#include "tests/model/random.h"
#include "tests/seed.h"
#include "unit/fixture.h"

#include "geometry/vec3.h"
#include "solve/harmonic.h"

#include <math.h>

enum { SIDE = 12, POINTS = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

/* A sheet of SIDE by SIDE vertices. */
typedef struct sheet {
    he_vec3 points[POINTS];
    uint32_t corners[3 * TRIANGLES];
} sheet;

static he_surface surface_of(const sheet *s)
{
    return (he_surface){POINTS, TRIANGLES, s->corners, s->points};
}

static sheet flat_sheet(void)
{
    sheet s;
    uint32_t c = 0;
    for (uint32_t v = 0; v < POINTS; v++) {
        const uint32_t row = v / SIDE;
        s.points[v] = (he_vec3){v % SIDE, row, 0};
    }
    for (uint32_t y = 0; y + 1 < SIDE; y++) {
        for (uint32_t x = 0; x + 1 < SIDE; x++) {
            const uint32_t a = y * SIDE + x,
                           quad[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
            for (int k = 0; k < 6; k++) {
                s.corners[c++] = quad[k];
            }
        }
    }
    return s;
}

/* Moves the vertices at random, in space or, without folds, in the plane; `thin` squeezes the
 * sheet. */
static sheet random_sheet(md_random *r, bool planar, double thin)
{
    sheet s = flat_sheet();
    for (uint32_t v = 0; v < POINTS; v++) {
        const double most = planar ? 2500 : 1100;
        s.points[v].x += (md_below(r, 1000) - 500.0) / most;
        s.points[v].y = thin * (s.points[v].y + (md_below(r, 1000) - 500.0) / most);
        s.points[v].z = planar ? 0 : (double)md_below(r, 1000) / 300;
    }
    return s;
}

static double entry(const he_sparse *m, uint32_t row, uint32_t column)
{
    for (size_t i = m->starts[column]; i < m->starts[column + 1]; i++) {
        if (m->rows[i] == row) {
            return m->values[i];
        }
    }
    return 0;
}

static void a_grid_has_the_five_point_operator(void **state)
{
    (void)state;
    const sheet s = flat_sheet();
    const he_surface surface = surface_of(&s);
    const uint32_t v = 5 * SIDE + 5;
    he_laplacian l;
    assert_int_equal(he_laplacian_make(&surface, NULL, &l, NULL), HE_OK);
    assert_true(fabs(entry(&l.matrix, v, v) - 4) < 1e-12);
    const uint32_t beside[] = {v - 1, v + 1, v - SIDE, v + SIDE};
    for (int i = 0; i < 4; i++) {
        assert_true(fabs(entry(&l.matrix, v, beside[i]) + 1) < 1e-12);
    }
    assert_true(fabs(entry(&l.matrix, v, v + SIDE + 1)) < 1e-12);
    assert_true(fabs(entry(&l.matrix, 5, 6) + 0.5) < 1e-12); /* an edge of the boundary */
    assert_true(fabs(l.masses[v] - 1) < 1e-12);
    assert_true(fabs(l.masses[0] - 1.0 / 3) < 1e-12);
    he_laplacian_clear(&l);
}

static double area_of(const he_intrinsic *t)
{
    double sum = 0;
    for (uint32_t i = 0; i < t->triangles; i++) {
        sum += he_intrinsic_area(t, i) * t->unit * t->unit;
    }
    return sum;
}

/* Adds up the angles at each vertex. */
static void angles_of(const he_intrinsic *t, double angles[POINTS])
{
    memset(angles, 0, POINTS * sizeof *angles);
    for (uint32_t s = 0; s < 3 * t->triangles; s++) {
        /* the angle opposite to side s is at the corner where the side before it begins */
        angles[t->corners[s % 3 == 0 ? s + 2 : s - 1]] += atan2(1, t->cotangents[s]);
    }
}

static void flips_keep_the_surface_and_make_it_delaunay(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    uint64_t flips = 0;
    for (int round = 0; round < 100; round++) {
        const sheet s = random_sheet(&r, round % 3 == 0, round % 2 ? 1 : 0.05);
        const he_surface surface = surface_of(&s);
        he_intrinsic t;
        double before[POINTS], after[POINTS];
        assert_int_equal(he_intrinsic_make(&surface, &t, NULL), HE_OK);
        const double area = area_of(&t);
        angles_of(&t, before);
        assert_int_equal(he_intrinsic_flip(&t, NULL, NULL), HE_OK);
        angles_of(&t, after);
        assert_true(fabs(area_of(&t) - area) <= 1e-9 * area);
        for (uint32_t v = 0; v < POINTS; v++) {
            assert_true(fabs(before[v] - after[v]) < 1e-6);
        }
        for (uint32_t side = 0; side < 3 * t.triangles; side++) {
            const uint32_t twin = t.twins[side];
            if (twin == UINT32_MAX) {
                continue;
            }
            assert_int_equal(t.twins[twin], side);
            assert_true(t.lengths[twin] == t.lengths[side]);
            assert_int_equal(t.corners[twin], t.corners[side % 3 == 2 ? side - 2 : side + 1]);
            assert_true(t.cotangents[side] + t.cotangents[twin] > -1e-6);
        }
        flips += t.flips;
        he_intrinsic_clear(&t);
    }
    print_message("note: %llu flips\n", (unsigned long long)flips);
    assert_true(flips > 1000);
}

/* Returns true if no point lies inside the circle of three points that turn counterclockwise. */
static bool is_delaunay(const he_vec3 *points, uint32_t i, uint32_t j, uint32_t k)
{
    const he_vec3 a = points[i], b = points[j], c = points[k];
    if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 1e-9) {
        return false;
    }
    for (uint32_t v = 0; v < POINTS; v++) {
        const double ax = a.x - points[v].x, ay = a.y - points[v].y;
        const double bx = b.x - points[v].x, by = b.y - points[v].y;
        const double cx = c.x - points[v].x, cy = c.y - points[v].y;
        const double inside = (ax * ax + ay * ay) * (bx * cy - by * cx) -
                              (bx * bx + by * by) * (ax * cy - ay * cx) +
                              (cx * cx + cy * cy) * (ax * by - ay * bx);
        if (v != i && v != j && v != k && inside > 0) {
            return false;
        }
    }
    return true;
}

/* A sheet of which the vertices inside are moved, so that its outline stays a square. */
static sheet square_sheet(md_random *r)
{
    sheet s = flat_sheet(), moved = random_sheet(r, true, 1);
    for (uint32_t v = 0; v < POINTS; v++) {
        const uint32_t x = v % SIDE, y = v / SIDE;
        if (x > 0 && y > 0 && x + 1 < SIDE && y + 1 < SIDE) {
            s.points[v] = moved.points[v];
        }
    }
    return s;
}

static void flips_make_the_delaunay_triangulation_of_a_plane(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (int round = 0; round < 5; round++) {
        const sheet s = square_sheet(&r);
        const he_surface surface = surface_of(&s);
        uint32_t found = 0;
        he_intrinsic t;
        assert_int_equal(he_intrinsic_make(&surface, &t, NULL), HE_OK);
        assert_int_equal(he_intrinsic_flip(&t, NULL, NULL), HE_OK);
        for (uint32_t i = 0; i < t.triangles; i++) {
            const uint32_t *c = t.corners + 3 * (size_t)i;
            assert_true(is_delaunay(s.points, c[0], c[1], c[2]));
        }
        /* every triangle with an empty circle is there, because there are as many */
        for (uint32_t i = 0; i < POINTS; i++) {
            for (uint32_t j = i + 1; j < POINTS; j++) {
                for (uint32_t k = i + 1; k < POINTS; k++) {
                    found += is_delaunay(s.points, i, j, k);
                }
            }
        }
        assert_int_equal(found, t.triangles);
        he_intrinsic_clear(&t);
    }
}

/* A disc of very many triangles around vertex 0, in random order. */
static void sides_around_a_hub_are_paired(void **state)
{
    (void)state;
    enum { RIM = 200000 };
    md_random r = {seed_of_run()};
    uint32_t *corners = calloc((size_t)3 * RIM, sizeof *corners);
    he_vec3 *points = calloc(RIM + 1, sizeof *points);
    assert_true(corners != NULL && points != NULL);
    for (uint32_t i = 0; i < RIM; i++) {
        const double angle = 6.283185307179586 * i / RIM;
        points[i + 1] = (he_vec3){cos(angle), sin(angle), 0};
        const uint32_t k = md_below(&r, i + 1);
        memcpy(corners + 3 * (size_t)i, corners + 3 * (size_t)k, 3 * sizeof *corners);
        corners[3 * (size_t)k + 1] = i + 1;
        corners[3 * (size_t)k + 2] = (i + 1) % RIM + 1;
    }
    const he_surface surface = {RIM + 1, RIM, corners, points};
    uint32_t borders = 0;
    he_intrinsic t;
    assert_int_equal(he_intrinsic_make(&surface, &t, NULL), HE_OK);
    for (uint32_t s = 0; s < 3 * t.triangles; s++) {
        borders += t.twins[s] == UINT32_MAX;
    }
    assert_int_equal(borders, RIM);
    he_intrinsic_clear(&t);
    free(corners);
    free(points);
}

static void assert_sound(const he_surface *surface)
{
    he_laplacian l;
    he_error err = {0};
    if (he_laplacian_make(surface, NULL, &l, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    for (uint32_t j = 0; j < l.matrix.n; j++) {
        double sum = 0, size = 0;
        for (size_t i = l.matrix.starts[j]; i < l.matrix.starts[j + 1]; i++) {
            assert_true(isfinite(l.matrix.values[i]));
            sum += l.matrix.values[i];
            size += fabs(l.matrix.values[i]);
        }
        assert_true(fabs(sum) <= 1e-12 * size);
        assert_true(isfinite(l.masses[j]) && l.masses[j] >= 0);
    }
    he_laplacian_clear(&l);
}

static void slivers_and_far_places_make_no_nan(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (int round = 0; round < 60; round++) {
        sheet s = random_sheet(&r, round % 2 == 0, round % 3 == 0 ? 0 : 1);
        for (uint32_t v = 0; v < POINTS; v++) {
            if (round % 4 == 1 && md_chance(&r, 30)) {
                s.points[v] = s.points[md_below(&r, POINTS)]; /* edges without length */
            }
        }
        for (uint32_t v = 0; v < POINTS; v++) {
            if (round % 5 == 2) {
                s.points[v].x += 1e9;
            }
            if (round % 5 == 3) {
                s.points[v] = he_vec3_scale(s.points[v], 1e150);
            }
            if (round % 5 == 4) {
                s.points[v] = he_vec3_scale(s.points[v], 1e-150);
            }
        }
        const he_surface surface = surface_of(&s);
        assert_sound(&surface);
    }
    /* all vertices at one place */
    sheet point = flat_sheet();
    memset(point.points, 0, sizeof point.points);
    const he_surface surface = surface_of(&point);
    assert_sound(&surface);
    /* two triangles with two common edges, an edge of three triangles, a vertex without any */
    static const uint32_t corners[] = {0, 1, 2, 0, 2, 1, 0, 1, 3};
    static const he_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 9, 9}};
    const he_surface odd = {5, 3, corners, points};
    assert_sound(&odd);
    const he_surface none = {0, 0, corners, points};
    assert_sound(&none);
}

static void what_is_wrong_is_refused(void **state)
{
    (void)state;
    static const he_vec3 far[] = {{-1e308, 0, 0}, {1e308, 0, 0}, {0, 1, 0}};
    const he_surface wide = {3, 1, (const uint32_t[]){0, 1, 2}, far};
    static const he_vec3 large[] = {{-1e200, 0, 0}, {1e200, 0, 0}, {0, 1e200, 0}};
    const he_surface heavy = {3, 1, (const uint32_t[]){0, 1, 2}, large};
    const he_surface wrong = {3, 1, (const uint32_t[]){0, 1, 3}, far};
    he_laplacian l;
    assert_int_equal(he_laplacian_make(&wide, NULL, &l, NULL), HE_NOT_FINITE);
    assert_int_equal(he_laplacian_make(&heavy, NULL, &l, NULL), HE_NOT_FINITE);
    assert_int_equal(he_laplacian_make(&wrong, NULL, &l, NULL), HE_BAD_INDEX);
}

/* Two sheets, of which only the first has fixed vertices. */
static void a_component_without_fixed_vertices_is_refused(void **state)
{
    (void)state;
    const sheet s = flat_sheet();
    static he_vec3 points[2 * POINTS];
    static uint32_t corners[6 * TRIANGLES];
    for (uint32_t v = 0; v < 2 * POINTS; v++) {
        points[v] = s.points[v % POINTS];
    }
    for (uint32_t c = 0; c < 6 * TRIANGLES; c++) {
        corners[c] = s.corners[c % (3 * TRIANGLES)] + (c < 3 * TRIANGLES ? 0 : POINTS);
    }
    const he_surface surface = {2 * POINTS, 2 * TRIANGLES, corners, points};
    uint64_t fixed[(2 * POINTS + 63) / 64] = {0};
    he_laplacian l;
    he_error err;
    he_harmonic *h = NULL;
    assert_int_equal(he_laplacian_make(&surface, NULL, &l, NULL), HE_OK);
    for (unsigned k = 1; k <= 3; k++) {
        fixed[0] = 0;
        assert_int_equal(he_harmonic_make(&l, k, fixed, NULL, &h, &err), HE_BAD_VALUE);
        assert_true(err.kind == HE_VERTEX && err.id == 0);
        fixed[0] = 1;
        assert_int_equal(he_harmonic_make(&l, k, fixed, NULL, &h, &err), HE_BAD_VALUE);
        assert_true(err.kind == HE_VERTEX && err.id == POINTS);
    }
    he_laplacian_clear(&l);
}

/* Fixes `rings` rings of vertices at the outline of the sheet. */
static void fix_outline(uint64_t *fixed, uint32_t rings)
{
    memset(fixed, 0, (POINTS + 63) / 64 * sizeof *fixed);
    for (uint32_t v = 0; v < POINTS; v++) {
        const uint32_t x = v % SIDE, y = v / SIDE;
        if (x < rings || y < rings || x + rings >= SIDE || y + rings >= SIDE) {
            he_bits_set(fixed, v);
        }
    }
}

static void linear_functions_are_harmonic_in_a_plane(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (unsigned k = 1; k <= 3; k++) {
        const sheet s = random_sheet(&r, true, 1);
        const he_surface surface = surface_of(&s);
        uint64_t fixed[(POINTS + 63) / 64];
        double values[2 * POINTS], residual;
        he_laplacian l;
        he_harmonic *h = NULL;
        fix_outline(fixed, k);
        assert_int_equal(he_laplacian_make(&surface, NULL, &l, NULL), HE_OK);
        assert_int_equal(he_harmonic_make(&l, k, fixed, NULL, &h, NULL), HE_OK);
        assert_true(he_harmonic_bytes(h) > POINTS * sizeof(double));
        for (uint32_t v = 0; v < POINTS; v++) {
            const bool known = he_bits_get(fixed, v);
            values[v] = known ? 3 * s.points[v].x - s.points[v].y + 7 : 1e30;
            values[POINTS + v] = known ? s.points[v].y : NAN;
        }
        assert_int_equal(he_harmonic_solve(h, values, 2, false, &residual, NULL), HE_OK);
        assert_true(residual < 1e-12);
        for (uint32_t v = 0; v < POINTS; v++) {
            assert_true(fabs(values[v] - (3 * s.points[v].x - s.points[v].y + 7)) < 1e-8);
            assert_true(fabs(values[POINTS + v] - s.points[v].y) < 1e-8);
        }
        he_harmonic_free(h);
        he_laplacian_clear(&l);
    }
}

static he_status all(const he_surface *surface, const uint64_t *fixed)
{
    double values[POINTS] = {0};
    he_laplacian l;
    he_sparse step = {0};
    he_harmonic *h = NULL;
    he_status status = he_laplacian_make(surface, NULL, &l, NULL);
    if (status != HE_OK) {
        return status;
    }
    status = he_laplacian_step(&l, 0.5, &step, NULL);
    if (status == HE_OK) {
        assert_true(entry(&step, 0, 0) == 0.5 * entry(&l.matrix, 0, 0) + l.masses[0]);
        assert_true(entry(&step, 0, 1) == 0.5 * entry(&l.matrix, 0, 1));
        status = he_harmonic_make(&l, 3, fixed, NULL, &h, NULL);
    }
    if (status == HE_OK) {
        status = he_harmonic_solve(h, values, 1, false, NULL, NULL);
    }
    he_harmonic_free(h);
    he_sparse_clear(&step);
    he_laplacian_clear(&l);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    const sheet s = flat_sheet();
    const he_surface surface = surface_of(&s);
    uint64_t fixed[(POINTS + 63) / 64];
    fix_outline(fixed, 3);
    failing f = {0};
    while (failing_next(&f)) {
        (void)failing_status(&f, all(&surface, fixed));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_has_the_five_point_operator),
        cmocka_unit_test(flips_keep_the_surface_and_make_it_delaunay),
        cmocka_unit_test(flips_make_the_delaunay_triangulation_of_a_plane),
        cmocka_unit_test(sides_around_a_hub_are_paired),
        cmocka_unit_test(slivers_and_far_places_make_no_nan),
        cmocka_unit_test(what_is_wrong_is_refused),
        cmocka_unit_test(a_component_without_fixed_vertices_is_refused),
        cmocka_unit_test(linear_functions_are_harmonic_in_a_plane),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("laplacian", tests, NULL, NULL);
}
