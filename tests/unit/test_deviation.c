/* The operation deviation: signed distances of vertices from another surface. The environment
 * variable SEED repeats the random points. */
#include "tests/unit/dense.h"
#include "tests/unit/random_meshes.h"

#include "compare/deviation.h"
#include "compare/feature_normals.h"
#include "geometry/geometry.h"
#include "mesh/write.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <math.h>

static void require_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) {
        fail_msg("%.17g is not %.17g", value, wanted);
    }
}

static void move(he_mesh *m, double scale, he_vec3 by)
{
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        he_set_position(m, (he_vertex){v}, he_vec3_add(he_vec3_scale(p, scale), by));
    }
}

static double value_of(const he_mesh *m, const char *name, uint32_t v)
{
    const he_column *column = he_mesh_find_column(m, HE_VERTEX, name);
    assert_non_null(column);
    return he_column_number(column, v, 0);
}

static he_deviated deviate(he_mesh *m, const he_mesh *with)
{
    he_deviated done;
    he_error err = {0};
    if (he_deviation(m, with, "deviation", &done, &err) != HE_OK) {
        fail_msg("%s", err.text);
    }
    fixture_check(m);
    return done;
}

/* Returns the signed distance of a point from a cube around the origin with sides of 2 * half. */
static double from_cube(he_vec3 p, double half)
{
    const he_vec3 beyond = {fabs(p.x) - half, fabs(p.y) - half, fabs(p.z) - half};
    const he_vec3 out = {fmax(beyond.x, 0), fmax(beyond.y, 0), fmax(beyond.z, 0)};
    const double inside = fmax(beyond.x, fmax(beyond.y, beyond.z));
    return inside < 0 ? inside : he_vec3_length(out);
}

/* The vertices are isolated points around a cube: beside its sides, edges and corners, and in it.
 */
static void points_have_the_signed_distance_from_a_cube(void **state)
{
    (void)state;
    enum { POINTS = 5000 };
    md_random r = {seed_of_run()};
    he_mesh *cube = dense_cube(3);
    he_box box;
    assert_true(he_mesh_box(cube, &box));
    const double half = (box.max.x - box.min.x) / 2;
    move(cube, 1, he_vec3_scale(he_vec3_add(box.min, box.max), -0.5));
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (int i = 0; i < POINTS; i++) {
        const double far = 4 * half;
        (void)dense_add_vertex(&soup, far * (md_unit(&r) - 0.5), far * (md_unit(&r) - 0.5),
                               far * (md_unit(&r) - 0.5));
    }
    he_mesh *m = dense_built(&soup);
    const he_deviated done = deviate(m, cube);
    double least = INFINITY, largest = -INFINITY, sum = 0;
    for (uint32_t v = 0; v < POINTS; v++) {
        const double wanted = from_cube(he_position(m, (he_vertex){v}), half);
        require_near(value_of(m, "deviation", v), wanted, 1e-6 * half);
        least = fmin(least, wanted);
        largest = fmax(largest, wanted);
        sum += wanted;
    }
    require_near(done.least, least, 1e-12 * half);
    require_near(done.largest, largest, 1e-12 * half);
    require_near(done.mean, sum / POINTS, 1e-10 * half);
    assert_true(done.rms >= fabs(done.mean) && done.least < 0 && done.largest > 0);
    he_mesh_free(m);
    he_mesh_free(cube);
}

/* An orange of which a slice was cut out: two poles with very many triangles are joined by the edge
 * at the bottom of the cut. Points in the orange opposite the cut are nearest to this edge. */
static void beside_an_edge_of_two_hubs_the_sign_is_right(void **state)
{
    (void)state;
    enum { AROUND = 200, POINTS = 9 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    const uint32_t south = dense_add_vertex(&soup, 0, 0, -1);
    const uint32_t north = dense_add_vertex(&soup, 0, 0, 1);
    for (int i = 0; i <= AROUND; i++) {
        const double angle = 0.5 + (2 * 3.14159265358979323846 - 1) * i / AROUND;
        (void)dense_add_vertex(&soup, cos(angle), sin(angle), 0);
    }
    for (uint32_t i = 0; i < AROUND; i++) {
        dense_add_triangle(&soup, north, 2 + i, 3 + i);
        dense_add_triangle(&soup, south, 3 + i, 2 + i);
    }
    dense_add_triangle(&soup, south, 2, north);
    dense_add_triangle(&soup, north, 2 + AROUND, south);
    he_mesh *orange = dense_built(&soup);
    he_soup_init(&soup, NULL);
    for (int i = 0; i < POINTS; i++) {
        const int above = i - POINTS / 2;
        (void)dense_add_vertex(&soup, -0.02 * (i + 1), 0, 0.05 * above);
    }
    he_mesh *m = dense_built(&soup);
    (void)deviate(m, orange);
    for (uint32_t v = 0; v < POINTS; v++) {
        require_near(value_of(m, "deviation", v), -0.02 * (v + 1), 1e-7);
    }
    /* Lists of the triangles and of the edges between hubs are charged, too. */
    he_bvh *tree;
    he_feature_normals normals = {.mesh = NULL};
    he_budget budget = {.left = UINT64_MAX};
    assert_int_equal(he_bvh_new(orange, NULL, &tree, NULL), HE_OK);
    assert_int_equal(he_feature_normals_make(orange, tree, &budget, &normals, NULL), HE_OK);
    assert_true(normals.hub_edge_count > 0);
    assert_true(UINT64_MAX - budget.left > (HE_BVH_LOOK + 4) * (uint64_t)tree->count);
    he_feature_normals_clear(&normals);
    he_bvh_free(tree);
    he_mesh_free(m);
    he_mesh_free(orange);
}

static void the_sides_of_an_open_surface_have_signs(void **state)
{
    (void)state;
    he_mesh *sheet = dense_grid(4, NULL, 1);
    for (int side = -1; side <= 1; side += 2) {
        he_mesh *m = dense_copy(sheet);
        move(m, 1, (he_vec3){0.3, 0.2, 0.5 * side});
        const bool up = dense_area(sheet, 0).z > 0;
        const he_deviated done = deviate(m, sheet);
        assert_true((done.least > 0) == (up == (side > 0)));
        assert_true((done.largest < 0) == (up != (side > 0)));
        he_mesh_free(m);
    }
    he_mesh_free(sheet);
}

static void a_deviation_is_one_step_of_undo(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(12), *with = dense_copy(m);
    move(m, 1.1, (he_vec3){0, 0, 0});
    (void)deviate(m, with);
    move(m, 1.1, (he_vec3){0, 0, 0});
    he_mesh *before = dense_copy(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    (void)deviate(m, with);
    he_mesh_record(m, NULL);
    assert_false(he_mesh_equal_live(m, before));
    he_mesh *after = dense_copy(m);
    he_delta_undo(delta, m);
    assert_true(he_mesh_equal_live(m, before));
    he_delta_redo(delta, m);
    assert_true(he_mesh_equal(m, after));
    he_delta_free(delta);
    he_mesh_free(after);
    he_mesh_free(before);
    he_mesh_free(with);
    he_mesh_free(m);
}

static void every_allocation_of_a_deviation_may_fail(void **state)
{
    (void)state;
    he_mesh *with = dense_torus(8);
    failing f = {.may_succeed = true}; /* a tree keeps its block if that cannot be made smaller */
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = dense_torus(6), *before = dense_copy(m);
        failing_resume();
        if (!failing_status(&f, he_deviation(m, with, "deviation", NULL, NULL))) {
            assert_true(he_mesh_equal(m, before));
        }
        he_mesh_free(before);
        he_mesh_free(m);
    }
    he_mesh_free(with);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_have_the_signed_distance_from_a_cube),
        cmocka_unit_test(beside_an_edge_of_two_hubs_the_sign_is_right),
        cmocka_unit_test(the_sides_of_an_open_surface_have_signs),
        cmocka_unit_test(a_deviation_is_one_step_of_undo),
        cmocka_unit_test(every_allocation_of_a_deviation_may_fail),
    };
    return cmocka_run_group_tests_name("deviation", tests, NULL, NULL);
}
