/* Tests of the search for near points in a grid of cells: it must find the point with the lowest
 * number within the tolerance, wherever the points lie. The results are compared with a check of
 * all points. */
#include "unit/fixture.h"

#include "geometry/point_grid.h"
#include "tests/failing.h"

#include <math.h>

enum { POINTS = 600 };

static uint64_t state_of_random = 20261122;

static double random_unit(void)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return (double)(state_of_random >> 11) * 0x1p-53;
}

static double distance(he_vec3 a, he_vec3 b)
{
    return hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
}

/* Compares the search with a check of all points. The points are random in a box around `origin`;
 * the box is a few times as large as the tolerance. */
static void compare(double origin, double tolerance)
{
    static he_vec3 points[POINTS];
    static bool kept[POINTS];
    he_point_grid grid;
    uint32_t found_any = 0;
    for (uint32_t i = 0; i < POINTS; i++) {
        double at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = origin + (random_unit() * 16 - 8) * tolerance;
        }
        points[i] = (he_vec3){at[0], at[1], at[2]};
    }
    assert_int_equal(
        he_point_grid_make(&grid,
                           &(he_point_grid_points){.at = points, .tolerance = tolerance, .seed = 1},
                           POINTS, NULL, NULL),
        HE_OK);
    for (uint32_t i = 0; i < POINTS; i++) {
        uint32_t home, wanted = HE_NONE;
        /* whether no distance is so close to the tolerance that rounding decides the result */
        bool sure = true;
        for (uint32_t k = i; k-- > 0;) {
            double d = distance(points[i], points[k]);
            sure &= !kept[k] || d == 0 || fabs(d / tolerance - 1) > 1e-9;
            wanted = kept[k] && d <= tolerance ? k : wanted;
        }
        uint32_t found = he_point_grid_find(&grid, points[i], &home);
        assert_true(!sure || found == wanted);
        kept[i] = found == HE_NONE;
        found_any += found != HE_NONE;
        if (kept[i]) {
            he_point_grid_keep(&grid, home, i);
        }
    }
    assert_true(found_any > 0 && found_any < POINTS);
    he_point_grid_clear(&grid);
}

static void the_lowest_within_reach_is_found(void **state)
{
    (void)state;
    compare(0, 1);
    compare(0, 1e-300);
    compare(0, 1e300);
    compare(-1e6, 0.001);
    for (int exponent = 38; exponent < 52; exponent++) {
        compare(ldexp(1, exponent), 1);
        compare(-ldexp(1, exponent), 0.75);
    }
}

/* With a tolerance of 0, points are near only if they are equal. -0 and 0 are equal. */
static void without_a_tolerance_only_equal_points_are_near(void **state)
{
    (void)state;
    const he_vec3 points[] = {{0, 1e300, -0.0}, {5e-324, 1e300, 0}, {-0.0, 1e300, 0}};
    he_point_grid grid;
    uint32_t home;
    assert_int_equal(he_point_grid_make(&grid,
                                        &(he_point_grid_points){.at = points, .tolerance = 0}, 3,
                                        NULL, NULL),
                     HE_OK);
    assert_int_equal(he_point_grid_find(&grid, points[0], &home), HE_NONE);
    he_point_grid_keep(&grid, home, 0);
    assert_int_equal(he_point_grid_find(&grid, points[1], &home), HE_NONE);
    he_point_grid_keep(&grid, home, 1);
    assert_int_equal(he_point_grid_find(&grid, points[2], &home), 0);
    he_point_grid_clear(&grid);
    failing_at(1);
    assert_int_equal(he_point_grid_make(&grid,
                                        &(he_point_grid_points){.at = points, .tolerance = 0}, 3,
                                        NULL, NULL),
                     HE_NO_MEMORY);
    failing_off();
}

static bool give_up(void *context, const char *phase, double done)
{
    (void)context;
    (void)phase;
    (void)done;
    return false;
}

static void a_table_can_be_given_up(void **state)
{
    (void)state;
    const he_vec3 points[3] = {{0, 0, 0}};
    he_point_grid grid = {0};
    he_progress progress;
    he_progress_init(&progress, give_up, NULL);
    assert_int_equal(he_point_grid_make(&grid,
                                        &(he_point_grid_points){.at = points, .tolerance = 0}, 3,
                                        &progress, NULL),
                     HE_CANCELLED);
    assert_null(grid.slots);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_can_be_given_up),
        cmocka_unit_test(the_lowest_within_reach_is_found),
        cmocka_unit_test(without_a_tolerance_only_equal_points_are_near),
    };
    return cmocka_run_group_tests_name("near", tests, NULL, NULL);
}
