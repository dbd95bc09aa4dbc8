/* Remeshing: which shapes stay exactly as they are, how even the triangles become, and what is
 * refused. */
#include "tests/unit/dense.h"

#include "geometry/geometry.h"
#include "mesh/marks.h"
#include "op/op.h"
#include "tests/unit/remeshed.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

static he_remeshed remesh_evenly(he_mesh *m, double edge_length)
{
    he_remesh_options options = remesh_options(edge_length);
    return remesh_mesh(m, &options);
}

static double degrees(double radians)
{
    return radians * 180 / PI;
}

static void tell(const char *what, const he_remeshed *r)
{
    printf("note: %s: %u faces, edges %.3g %.3g %.3g, angles %.1f to %.1f, regular %.2f, %s\n",
           what, r->faces, r->shortest, r->mean, r->longest, degrees(r->smallest_angle),
           degrees(r->largest_angle), r->regular, he_remesh_stop_names[r->stop]);
}

static he_measures measure(const he_mesh *m)
{
    he_measures out;
    assert_int_equal(he_mesh_measure(m, &out, NULL), HE_OK);
    return out;
}

static void assert_near(double a, double b, double relative)
{
    if (!(fabs(a - b) <= relative * fabs(b))) {
        fail_msg("%.17g is not %.17g", a, b);
    }
}

/* --- exact shapes --- */

static void a_cube_keeps_its_edges_area_and_volume(void **state)
{
    (void)state;
    static const double lengths[] = {0.7, 1.3, 2.9, 4, 11, 30};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_cube(10);
        he_remeshed done = remesh_evenly(m, lengths[i]);
        he_measures after = measure(m);
        tell("cube", &done);
        assert_near(after.area, 600, 1e-12);
        assert_near(after.volume, 1000, 1e-12);
        double length = 0;
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            double angle;
            if (he_mesh_is_live(m, HE_EDGE, e) && he_edge_dihedral(m, (he_edge){e}, &angle) &&
                fabs(angle) > 0.1) {
                assert_near(angle, PI / 2, 1e-9);
                length += he_edge_length(m, (he_edge){e});
            }
        }
        assert_near(length, 120, 1e-12);
        he_mesh_free(m);
    }
}

static void triangles_of_a_plane_are_even(void **state)
{
    (void)state;
    static const double lengths[] = {0.21, 0.5, 0.8, 1, 1.3, 2, 3.1};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_grid(20, NULL, 1);
        he_remeshed done = remesh_evenly(m, lengths[i]);
        tell("plane", &done);
        assert_true(done.smallest_angle >= PI / 6 && done.largest_angle <= PI * 2 / 3);
        assert_near(done.mean, lengths[i], 0.15);
        assert_near(measure(m).area, 400, 1e-12);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            assert_true(he_position(m, (he_vertex){v}).z == 0);
        }
        he_mesh_free(m);
    }
}

/* A disc with a boundary of 40 straight parts. */
static he_mesh *make_disc(void)
{
    enum { ROUND = 40, RINGS = 8 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    (void)dense_add_vertex(&soup, 0, 0, 0);
    for (uint32_t i = 0; i < RINGS; i++) {
        for (uint32_t k = 0; k < ROUND; k++) {
            double a = 2 * PI * k / ROUND, r = (i + 1.0) / RINGS;
            (void)dense_add_vertex(&soup, r * cos(a), r * sin(a), 0);
        }
    }
    for (uint32_t k = 0; k < ROUND; k++) {
        uint32_t next = (k + 1) % ROUND;
        dense_add_triangle(&soup, 0, 1 + k, 1 + next);
        for (uint32_t i = 0; i + 1 < RINGS; i++) {
            uint32_t in = 1 + i * ROUND, out = in + ROUND;
            dense_add_triangle(&soup, in + k, out + k, out + next);
            dense_add_triangle(&soup, in + k, out + next, in + next);
        }
    }
    return dense_built(&soup);
}

static void the_boundary_of_a_disc_stays(void **state)
{
    (void)state;
    static const double lengths[] = {0.03, 0.1, 0.3};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = make_disc(), *first = dense_copy(m);
        he_remeshed done = remesh_evenly(m, lengths[i]);
        double apothem = cos(PI / 40);
        tell("disc", &done);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            if (he_mesh_is_live(m, HE_VERTEX, v) && he_is_boundary_vertex(m, (he_vertex){v})) {
                /* The boundary's 40 straight parts touch a circle of radius cos(pi / 40). */
                he_vec3 p = he_position(m, (he_vertex){v});
                double a = atan2(p.y, p.x) * 40 / (2 * PI), off = (a - floor(a) - 0.5) / 40;
                assert_near(hypot(p.x, p.y) * cos(2 * PI * off), apothem, 1e-12);
            }
        }
        assert_near(measure(m).area, measure(first).area, lengths[i] * lengths[i]);
        assert_true(done.smallest_angle > PI / 7);
        he_remesh_options options = remesh_options(lengths[i]);
        options.fixed_boundary = true;
        (void)remesh_mesh(first, &options);
        for (uint32_t k = 0; k < 40; k++) {
            assert_true(he_mesh_is_live(first, HE_VERTEX, 281 + k));
        }
        assert_int_equal(he_mesh_boundary_halfedges(first), 40);
        he_mesh_free(first);
        he_mesh_free(m);
    }
}

static void a_sphere_stays_round(void **state)
{
    (void)state;
    he_mesh *m = dense_shape("icosphere", "subdivisions", 4), *first = dense_copy(m);
    he_remeshed done = remesh_evenly(m, 0.1);
    tell("sphere", &done);
    assert_true(done.smallest_angle > PI / 6 && done.largest_angle < PI * 2 / 3);
    assert_near(done.mean, 0.1, 0.1);
    dense_apart there = dense_measure(m, first);
    printf("note: sphere: farthest %g, mean square %g\n", there.farthest, there.root_mean_square);
    assert_true(there.farthest < 0.1 * 0.1 / 3);
    assert_int_equal(there.turned, 0);
    he_mesh_free(first);
    he_mesh_free(m);
}

static void a_second_remeshing_changes_little(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(60);
    he_remeshed done = remesh_evenly(m, 0.15), again = remesh_evenly(m, 0.15);
    tell("torus", &done);
    tell("torus again", &again);
    assert_near(again.faces, done.faces, 0.02);
    assert_near(again.mean, done.mean, 0.02);
    he_mesh_free(m);
}

static void the_number_of_faces_is_met(void **state)
{
    (void)state;
    static const uint32_t targets[] = {500, 2000, 7200, 30000};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        he_mesh *m = dense_torus(60);
        he_remesh_options options = remesh_options(0);
        options.target_faces = targets[i];
        he_remeshed done = remesh_mesh(m, &options);
        tell("faces", &done);
        assert_near(done.faces, targets[i], 0.03);
        assert_int_equal(he_mesh_faces(m), done.faces);
        assert_true(done.smallest_angle > PI / 9);
        he_mesh_free(m);
    }
}

static void what_a_length_makes_is_foreseen(void **state)
{
    (void)state;
    static const double lengths[] = {0.05, 0.1, 0.4};
    const he_op *op = he_op_find("remesh", 6);
    he_arg args[HE_OP_PARAMS];
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_shape("icosphere", "subdivisions", 4);
        const he_remesh_options options = remesh_options(lengths[i]);
        const double before = he_mesh_faces(m), told = he_remesh_foretell(m, &options);
        he_op_defaults(op, args);
        args[0].given = true; /* edge_length */
        args[0].number = lengths[i];
        assert_true(fabs(he_op_growth(op, m, args) - fmax(1, told / before)) < 1e-12);
        const double after = remesh_mesh(m, &options).faces;
        assert_true(told > 0.6 * after && told < 3 * after);
        he_mesh_free(m);
    }
    he_op_defaults(op, args);
    assert_true(fabs(he_op_growth(op, NULL, args) - 1) < 1e-12);
    op = he_op_find("smooth", 6);
    he_op_defaults(op, args);
    const unsigned once = he_op_pace(op, args);
    args[1].number *= 7; /* steps */
    assert_int_equal(he_op_pace(op, args), 7 * once);
}

/* Remembers the phase of a remeshing that was told last. */
static bool remember(void *context, const char *phase, double done)
{
    (void)done;
    *(const char **)context = phase;
    return true;
}

static void what_would_make_too_many_faces_is_refused_before_it_begins(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = dense_shape("icosphere", "subdivisions", 4), *first = dense_copy(m);
        he_remesh_options options = remesh_options(i == 0 ? 1e-5 : 0);
        const char *phase = NULL;
        he_progress progress;
        he_error err = {0};
        he_progress_init(&progress, remember, &phase);
        if (i == 1) {
            options.by = HE_REMESH_BY_ERROR;
            options.error = 1e-10;
        }
        he_mesh_set_progress(m, &progress);
        assert_int_equal(he_remesh(m, &options, NULL, &err), HE_LIMIT);
        he_mesh_set_progress(m, NULL);
        assert_non_null(phase);
        assert_string_equal(phase, "preparing");
        assert_true(strstr(err.text, "there would be about") != NULL);
        assert_true(he_mesh_equal(m, first));
        assert_true(he_remesh_foretell(m, &options) >= HE_REMESH_FACES);
        he_mesh_free(first);
        he_mesh_free(m);
    }
}

static he_mesh *bent(unsigned which)
{
    return which == 0   ? dense_shape("icosphere", "subdivisions", 4)
           : which == 1 ? dense_torus(40)
           : which == 2 ? dense_grid(40, dense_waves, 1)
                        : dense_cube(20);
}

static void what_an_error_makes_is_foreseen(void **state)
{
    (void)state;
    static const double parts[] = {2e-5, 1e-4, 1e-3};
    static uint32_t half[4000];
    const he_op *op = he_op_find("remesh", 6);
    for (unsigned i = 0; i < 4 * 3 * 2; i++) {
        he_mesh *m = bent(i % 4);
        he_box box;
        (void)he_surface_box(m, &box);
        he_remesh_options options = remesh_options(0);
        options.by = HE_REMESH_BY_ERROR;
        options.error = parts[i / 4 % 3] * he_vec3_extent(he_vec3_sub(box.max, box.min));
        if (i >= 4 * 3) {
            options.faces = half;
            options.face_count = he_mesh_faces(m) / 2;
            for (uint32_t f = 0; f < options.face_count; f++) {
                half[f] = f;
            }
        }
        const double before = he_mesh_faces(m), told = he_remesh_foretell(m, &options);
        he_arg args[HE_OP_PARAMS];
        he_op_defaults(op, args);
        args[2].given = true; /* error */
        args[2].number = options.error;
        if (options.faces == NULL) {
            assert_true(fabs(he_op_growth(op, m, args) - fmax(1, told / before)) < 1e-12);
        }
        (void)remesh_mesh(m, &options);
        const double after = he_mesh_faces(m);
        assert_true(told > 0.7 * after && told < 1.4 * after);
        he_mesh_free(m);
    }
}

/* The usual largest length follows from the extent of the faces that are replaced. One triangle has
 * an extent, too. */
static void what_an_error_makes_of_one_face_is_foreseen(void **state)
{
    (void)state;
    static const uint32_t face[] = {0};
    he_mesh *m = dense_cube(20);
    he_remesh_options options = remesh_options(0);
    options.by = HE_REMESH_BY_ERROR;
    options.error = 0.01;
    options.faces = face;
    options.face_count = 1;
    const double before = he_mesh_faces(m), told = he_remesh_foretell(m, &options);
    assert_true(told >= before - 1 && told < before + 300);
    (void)remesh_mesh(m, &options);
    assert_true(he_mesh_faces(m) < before + 300);
    he_mesh_free(m);
}

/* A face with many corners may be listed many times before the list is checked, so the forecast
 * must not walk around it. */
static void the_forecast_looks_only_at_triangles(void **state)
{
    (void)state;
    static const uint32_t both[] = {0, 1}, repeated[] = {0, 0, 0, 0, 0};
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = fixture_mesh("01234567,108,219"), *first = dense_copy(m);
        he_remesh_options options = remesh_options(1);
        he_error err = {0};
        if (i == 1) {
            options.by = HE_REMESH_BY_ERROR;
            options.error = 0.1;
            options.min_length = 1;
            options.max_length = 2;
        }
        options.faces = &both[1];
        options.face_count = 1;
        const double replaced = he_remesh_foretell(m, &options) - 2;
        assert_true(replaced > 2);
        options.faces = both;
        options.face_count = 2;
        assert_near(he_remesh_foretell(m, &options), 1 + 2 * replaced, 1e-12);
        options.faces = repeated;
        options.face_count = 1;
        assert_true(he_remesh_foretell(m, &options) == 2);
        options.face_count = sizeof repeated / sizeof *repeated;
        assert_true(he_remesh_foretell(m, &options) == 0);
        options.face_count = 1;
        assert_int_equal(he_remesh(m, &options, NULL, &err), HE_NOT_TRIANGLE);
        assert_int_equal(err.id, 0);
        assert_true(he_mesh_equal(m, first));
        he_mesh_free(first);
        he_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_keeps_its_edges_area_and_volume),
        cmocka_unit_test(triangles_of_a_plane_are_even),
        cmocka_unit_test(the_boundary_of_a_disc_stays),
        cmocka_unit_test(a_sphere_stays_round),
        cmocka_unit_test(a_second_remeshing_changes_little),
        cmocka_unit_test(the_number_of_faces_is_met),
        cmocka_unit_test(what_a_length_makes_is_foreseen),
        cmocka_unit_test(what_an_error_makes_is_foreseen),
        cmocka_unit_test(what_an_error_makes_of_one_face_is_foreseen),
        cmocka_unit_test(the_forecast_looks_only_at_triangles),
        cmocka_unit_test(what_would_make_too_many_faces_is_refused_before_it_begins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
