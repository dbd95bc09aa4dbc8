/* Decimation: what it preserves exactly, how far the result is from the original surface, and when
 * the decimation stops. */
#include "tests/unit/dense.h"

#include "algo/decimation.h"
#include "geometry/vec3.h"
#include "mesh/write.h"

#include <float.h>
#include <math.h>

static const he_decimate_options all = {0, INFINITY, 100};

static bool is_in(const double *values, size_t count, double value)
{
    size_t i = 0;
    while (i < count && values[i] != value) {
        i++;
    }
    return i < count;
}

static double volume_of(const he_mesh *m)
{
    double sum = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        if (he_mesh_is_live(m, HE_FACE, f)) {
            sum += he_vec3_dot(dense_corner(m, f, 0),
                               he_vec3_cross(dense_corner(m, f, 1), dense_corner(m, f, 2))) /
                   6;
        }
    }
    return sum;
}

/* --- exact results --- */

static void a_flat_grid_becomes_two_triangles(void **state)
{
    (void)state;
    static const uint32_t sides[] = {1, 2, 3, 8, 20};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        double side = sides[i];
        he_mesh *m = dense_grid(sides[i], NULL, 1);
        he_decimated done = dense_decimate(m, 0, 0);
        assert_int_equal(done.stop, HE_STOP_ERROR);
        assert_true(done.error == 0);
        fixture_counts(m, 4, 5, 2);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_vec3 p = he_position(m, (he_vertex){v});
            if (he_mesh_is_live(m, HE_VERTEX, v)) {
                assert_true((p.x == 0 || p.x == side) && (p.y == 0 || p.y == side) && p.z == 0);
            }
        }
        he_mesh_free(m);
    }
}

static void a_cube_keeps_its_corners_and_its_volume(void **state)
{
    (void)state;
    he_mesh *m = dense_cube(10);
    fixture_check(m);
    assert_true(fabs(volume_of(m) - 1000) < 1e-9);
    he_decimated done = dense_decimate(m, 0, 1e-9);
    assert_int_equal(done.stop, HE_STOP_ERROR);
    assert_true(done.error == 0);
    fixture_counts(m, 8, 18, 12);
    assert_true(fabs(volume_of(m) - 1000) < 1e-9);
    static const double ends[2] = {0, 10};
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            assert_true(is_in(ends, 2, p.x) && is_in(ends, 2, p.y) && is_in(ends, 2, p.z));
        }
    }
    he_mesh_free(m);
}

static void nothing_happens_where_there_are_few_enough(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(10), *before = dense_copy(m);
    he_decimated done = dense_decimate(m, 200, INFINITY);
    assert_int_equal(done.stop, HE_STOP_FACES);
    assert_true(done.error == 0);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

/* --- distance --- */

static void more_faces_less_error(void **state)
{
    (void)state;
    double last = 0, last_error = 0;
    he_mesh *sphere = dense_shape("icosphere", "subdivisions", 4);
    for (uint32_t part = 2; part <= 64; part *= 2) {
        he_mesh *m = dense_copy(sphere);
        uint32_t faces = he_mesh_faces(sphere) / part;
        he_decimated done = dense_decimate(m, faces, INFINITY);
        assert_int_equal(done.stop, HE_STOP_FACES);
        assert_in_range(he_mesh_faces(m), faces - 1, faces);
        dense_apart there = dense_measure(m, sphere), back = dense_measure(sphere, m);
        double farthest = fmax(there.farthest, back.farthest);
        assert_true(farthest > last && done.error > last_error);
        /* On a smooth closed surface, the largest distance between the decimated and the original
         * surface must be of the same order as the error that the decimation estimates. */
        assert_true(farthest < 4 * done.error);
        assert_true(there.root_mean_square < 2 * done.error);
        assert_int_equal(there.turned + back.turned, 0);
        last = farthest;
        last_error = done.error;
        he_mesh_free(m);
    }
    he_mesh_free(sphere);
}

static void no_face_is_turned_over(void **state)
{
    (void)state;
    he_mesh *meshes[] = {dense_torus(40), dense_grid(40, dense_waves, 1),
                         dense_shape("icosphere", "subdivisions", 4)};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        he_mesh *m = dense_copy(meshes[i]);
        dense_decimate(m, he_mesh_faces(m) / 8, INFINITY);
        assert_int_equal(dense_measure(m, meshes[i]).turned, 0);
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            assert_true(!he_mesh_is_live(m, HE_FACE, f) || he_vec3_length(dense_area(m, f)) > 1e-9);
        }
        he_mesh_free(m);
        he_mesh_free(meshes[i]);
    }
}

/* Returns a pseudo-random number from 0 to 1. */
static double draw(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-53;
}

/* Each edge collapse may turn a face a little, and many collapses may turn it over. The surface is
 * rough, but all its faces look up at first; after the decimation, only a few may look down. */
static void few_faces_of_a_rough_surface_are_turned(void **state)
{
    (void)state;
    enum { SIDE = 50, SEEDS = 8 };
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        he_mesh *m = dense_grid(SIDE, NULL, 1);
        uint64_t random = seed;
        assert_int_equal(he_reserve(m, (he_reservation){.positions = he_mesh_vertices(m)}, NULL),
                         HE_OK);
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            he_vec3 p = he_position(m, (he_vertex){v});
            p.x += 0.6 * (draw(&random) - 0.5);
            p.y += 0.6 * (draw(&random) - 0.5);
            p.z += 0.6 * (draw(&random) - 0.5);
            he_set_position(m, (he_vertex){v}, p);
        }
        uint32_t down = 0;
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            assert_true(dense_area(m, f).z > 0);
        }
        dense_decimate(m, he_mesh_faces(m) / 2, INFINITY);
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            down += he_mesh_is_live(m, HE_FACE, f) && dense_area(m, f).z < 0;
        }
        assert_in_range(down, 0, he_mesh_faces(m) / 200);
        he_mesh_free(m);
    }
}

static void the_error_stays_below_its_limit(void **state)
{
    (void)state;
    he_mesh *first = dense_grid(40, dense_waves, 1);
    uint32_t last = he_mesh_faces(first);
    for (double most = 0.001; most < 1; most *= 4) {
        he_mesh *m = dense_copy(first);
        he_decimated done = dense_decimate(m, 0, most);
        assert_int_equal(done.stop, HE_STOP_ERROR);
        assert_true(done.error <= most && done.error > most / 4);
        assert_true(he_mesh_faces(m) < last);
        /* The estimated error also counts distances from the planes that keep the boundary in
         * place, so it may differ slightly from the measured distance of the surfaces. */
        assert_true(dense_measure(m, first).root_mean_square <= 1.5 * most);
        assert_true(dense_measure(first, m).root_mean_square <= 1.5 * most);
        last = he_mesh_faces(m);
        he_mesh_free(m);
    }
    he_mesh_free(first);
}

/* At the end, the collapse of each remaining edge must either have an error above the limit or be
 * refused. The error of an edge is a mean over an area and can fall during the decimation: an edge
 * that once was above the limit must have been tried again. */
static void no_edge_is_left_within_the_limit(void **state)
{
    (void)state;
    for (double most = 0.001; most < 1; most *= 4) {
        he_mesh *m = dense_grid(40, dense_waves, 1);
        he_decimation d = {.mesh = m};
        const he_decimate_options options = {0, most, 100};
        assert_int_equal(he_decimation_begin(&d, &options, NULL), HE_OK);
        assert_int_equal(he_decimation_go(&d, 0, NULL), HE_OK);
        uint32_t dear = 0;
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            he_candidate what;
            if (!he_mesh_is_live(m, HE_EDGE, e) || !he_decimation_cost(&d, (he_edge){e}, &what)) {
                continue;
            }
            dear += what.error > d.most;
            assert_true(what.error > d.most || he_decimation_collapse(&d, &what) != HE_OK);
        }
        assert_true(dear > 0);
        he_decimation_end(&d);
        he_mesh_free(m);
    }
}

/* --- ends --- */

static void what_cannot_be_collapsed_is_left(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(12);
    he_decimated done = dense_decimate(m, 0, INFINITY);
    assert_int_equal(done.stop, HE_STOP_EXHAUSTED);
    /* No torus of triangles has fewer than 7 vertices and 14 faces. How close to these numbers the
     * decimation comes depends on the shape. */
    assert_true(he_mesh_faces(m) >= 14 && he_mesh_faces(m) < 100);
    assert_int_equal(he_mesh_vertices(m) + he_mesh_faces(m), he_mesh_edges(m));
    he_decimated again = dense_decimate(m, 0, INFINITY);
    assert_int_equal(again.stop, HE_STOP_EXHAUSTED);
    he_mesh_free(m);
}

static void a_face_of_more_corners_is_refused(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,0234"), *before = dense_copy(m);
    he_error err = {0};
    assert_int_equal(he_decimate(m, &all, NULL, &err), HE_NOT_TRIANGLE);
    assert_int_equal(err.kind, HE_FACE);
    assert_int_equal(err.id, 1);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
    he_mesh_free(m);
}

static void options_outside_their_range_are_refused(void **state)
{
    (void)state;
    static const he_decimate_options bad[] = {{0, -1, 1},  {0, NAN, 1},      {0, 1, -1},
                                              {0, 1, NAN}, {0, 1, INFINITY}, {0, 1, 2e9}};
    he_mesh *m = fixture_mesh("012");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(he_decimate(m, &bad[i], NULL, NULL), HE_BAD_VALUE);
    }
    he_mesh_free(m);
}

/* A mesh scaled by a power of two must give the same result, to the last bit. */
static void size_and_place_do_not_matter(void **state)
{
    (void)state;
    static const int exponents[] = {-900, -40, 40, 900, 1015};
    he_mesh *first = dense_grid(12, dense_waves, 1);
    dense_decimate(first, 60, INFINITY);
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        he_mesh *m = dense_grid(12, dense_waves, ldexp(1, exponents[i]));
        dense_decimate(m, 60, INFINITY);
        assert_int_equal(he_mesh_vertices(m), he_mesh_vertices(first));
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            he_vec3 p = he_position(m, (he_vertex){v}), q = he_position(first, (he_vertex){v});
            assert_int_equal(he_mesh_is_live(m, HE_VERTEX, v),
                             he_mesh_is_live(first, HE_VERTEX, v));
            assert_true(ldexp(p.x, -exponents[i]) == q.x && ldexp(p.z, -exponents[i]) == q.z);
        }
        he_mesh_free(m);
    }
    he_mesh_free(first);
}

static void points_in_one_place_are_no_harm(void **state)
{
    (void)state;
    static const double scales[] = {0, DBL_TRUE_MIN, 1e-320, DBL_MAX / 64};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        he_mesh *m = dense_grid(6, NULL, scales[i]);
        dense_decimate(m, 10, INFINITY);
        he_mesh_free(m);
    }
}

/* A vertex has 200,000 edges: a collapse at this vertex must not visit all of them, or the
 * decimation would take quadratic time. */
static void a_hub_of_many_edges_is_no_work(void **state)
{
    (void)state;
    enum { SPOKES = 200000 };
    for (unsigned closed = 0; closed < 2; closed++) {
        he_soup soup;
        he_soup_init(&soup, NULL);
        uint32_t top = dense_add_vertex(&soup, 0, 0, 1), bottom = dense_add_vertex(&soup, 0, 0, -1);
        for (uint32_t i = 0; i < SPOKES; i++) {
            double angle = 6.283185307179586 * i / SPOKES;
            (void)dense_add_vertex(&soup, cos(angle), sin(angle), 0);
        }
        for (uint32_t i = 0; i < SPOKES; i++) {
            uint32_t a = 2 + i, b = 2 + (i + 1) % SPOKES;
            dense_add_triangle(&soup, top, a, b);
            if (closed != 0) {
                dense_add_triangle(&soup, bottom, b, a);
            }
        }
        he_mesh *m = dense_built(&soup);
        dense_decimate(m, SPOKES / 10, INFINITY);
        assert_in_range(he_mesh_faces(m), SPOKES / 10 - 1, SPOKES / 10);
        he_mesh_free(m);
    }
}

/* Makes `count` separate stars of 256 points; each star consists of triangles around its own
 * hub. */
static he_mesh *stars(uint32_t count, double (*height)(double x, double y))
{
    enum { POINTS = 256 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (uint32_t s = 0; s < count; s++) {
        uint32_t hub = dense_add_vertex(&soup, 4 * s, 0, height == NULL ? 0 : height(0, 0));
        for (uint32_t i = 0; i < POINTS; i++) {
            double angle = 6.283185307179586 * i / POINTS, radius = i % 2 == 0 ? 1 : 1.5;
            double x = radius * cos(angle), y = radius * sin(angle);
            (void)dense_add_vertex(&soup, 4 * s + x, y, height == NULL ? 0 : height(x, y));
        }
        for (uint32_t i = 0; i < POINTS; i++) {
            dense_add_triangle(&soup, hub, hub + 1 + i, hub + 1 + (i + 1) % POINTS);
        }
    }
    return dense_built(&soup);
}

/* Each collapse at the rim of a star changes faces around the star's hub, and so the errors of the
 * hub's edges. It would take too long to try all 256 edges of the hub again after each collapse,
 * but each of them must be tried again before the decimation ends. */
static void edges_of_a_star_are_tried_again_but_not_each_time(void **state)
{
    (void)state;
    double (*const heights[])(double x, double y) = {NULL, dense_waves};
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        he_mesh *m = stars(40, heights[i]);
        he_decimation d = {.mesh = m};
        const he_decimate_options options = {0, INFINITY, 100};
        uint32_t faces = he_mesh_faces(m);
        assert_int_equal(he_decimation_begin(&d, &options, NULL), HE_OK);
        assert_int_equal(he_decimation_go(&d, 0, NULL), HE_OK);
        print_message("note: %.1f looks at edges a face of a star\n", (double)d.work / faces);
        assert_true(d.work < 150 * (uint64_t)faces);
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            he_candidate what;
            if (he_mesh_is_live(m, HE_EDGE, e) && he_decimation_cost(&d, (he_edge){e}, &what)) {
                assert_int_not_equal(he_decimation_collapse(&d, &what), HE_OK);
            }
        }
        he_decimation_end(&d);
        he_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_grid_becomes_two_triangles),
        cmocka_unit_test(a_cube_keeps_its_corners_and_its_volume),
        cmocka_unit_test(nothing_happens_where_there_are_few_enough),
        cmocka_unit_test(more_faces_less_error),
        cmocka_unit_test(no_face_is_turned_over),
        cmocka_unit_test(few_faces_of_a_rough_surface_are_turned),
        cmocka_unit_test(the_error_stays_below_its_limit),
        cmocka_unit_test(no_edge_is_left_within_the_limit),
        cmocka_unit_test(what_cannot_be_collapsed_is_left),
        cmocka_unit_test(a_face_of_more_corners_is_refused),
        cmocka_unit_test(options_outside_their_range_are_refused),
        cmocka_unit_test(size_and_place_do_not_matter),
        cmocka_unit_test(points_in_one_place_are_no_harm),
        cmocka_unit_test(a_hub_of_many_edges_is_no_work),
        cmocka_unit_test(edges_of_a_star_are_tried_again_but_not_each_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
