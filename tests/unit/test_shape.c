/* Tests of the table of primitive shapes: which counts, positions and orientation the shapes have,
 * and which arguments are refused. */
#include "fixture.h"

#include "tests/failing.h"

#include "algo/shape.h"
#include "geometry/geometry.h"
#include "query/topology.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static const he_shape *shape_named(const char *name)
{
    const he_shape *shape = he_shape_find(name, strlen(name));
    if (shape == NULL) {
        fail_msg("there is no shape %s", name);
    }
    return shape;
}

/* Makes a shape. The arguments are in the order in which the table of shapes lists the shape's
 * parameters; NAN stands for a parameter's default value. */
static he_mesh *make(const char *name, double a, double b, double c, double d)
{
    const he_shape *shape = shape_named(name);
    double args[HE_SHAPE_PARAMS], given[HE_SHAPE_PARAMS] = {a, b, c, d};
    he_shape_defaults(shape, args);
    for (size_t i = 0; i < he_shape_params(shape); i++) {
        args[i] = isnan(given[i]) ? args[i] : given[i];
    }
    he_soup soup;
    he_mesh *mesh = NULL;
    he_error err = {0};
    if (he_shape_make(shape, args, NULL, &soup, &err) != HE_OK ||
        he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, &err) != HE_OK) {
        fail_msg("%s: %s", name, err.text);
    }
    he_soup_clear(&soup);
    fixture_check(mesh);
    return mesh;
}

static he_mesh *make_default(const char *name)
{
    return make(name, NAN, NAN, NAN, NAN);
}

static he_topology topology_of(const he_mesh *m)
{
    he_topology t;
    assert_int_equal(he_topology_find(m, &t, NULL), HE_OK);
    return t;
}

static double volume_of(const he_mesh *m)
{
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    assert_true(measures.has_volume);
    return measures.volume;
}

static double area_of(const he_mesh *m)
{
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    return measures.area;
}

static void assert_near(double got, double wanted)
{
    if (!(fabs(got - wanted) <= 1e-12 * fmax(1, fabs(wanted)))) {
        fail_msg("%.17g is not %.17g", got, wanted);
    }
}

static void shapes_have_their_counts_genus_and_boundary_loops(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double args[4];
        unsigned v, e, f, loops;
        int genus;
        bool closed;
    } rows[] = {
        {"tetrahedron", {NAN, NAN, NAN, NAN}, 4, 6, 4, 0, 0, true},
        {"cube", {NAN, NAN, NAN, NAN}, 8, 12, 6, 0, 0, true},
        {"octahedron", {NAN, NAN, NAN, NAN}, 6, 12, 8, 0, 0, true},
        {"dodecahedron", {NAN, NAN, NAN, NAN}, 20, 30, 12, 0, 0, true},
        {"icosahedron", {NAN, NAN, NAN, NAN}, 12, 30, 20, 0, 0, true},
        {"icosphere", {0, NAN, NAN, NAN}, 12, 30, 20, 0, 0, true},
        {"icosphere", {1, NAN, NAN, NAN}, 42, 120, 80, 0, 0, true},
        {"icosphere", {3, NAN, NAN, NAN}, 642, 1920, 1280, 0, 0, true},
        {"uv_sphere", {15, 15, NAN, NAN}, 212, 435, 225, 0, 0, true},
        {"uv_sphere", {3, 2, NAN, NAN}, 5, 9, 6, 0, 0, true},
        {"uv_sphere", {4, 3, NAN, NAN}, 10, 20, 12, 0, 0, true},
        {"grid", {4, 4, NAN, NAN}, 25, 40, 16, 1, 0, false},
        {"grid", {1, 1, NAN, NAN}, 4, 4, 1, 1, 0, false},
        {"grid", {3, 1, NAN, NAN}, 8, 10, 3, 1, 0, false},
        {"torus", {3, 3, NAN, NAN}, 9, 18, 9, 0, 1, true},
        {"torus", {8, 5, NAN, NAN}, 40, 80, 40, 0, 1, true},
        {"cylinder", {6, NAN, NAN, 0}, 12, 18, 6, 2, 0, false},
        {"cylinder", {6, NAN, NAN, 1}, 12, 18, 8, 0, 0, true},
        {"cylinder", {3, NAN, NAN, 1}, 6, 9, 5, 0, 0, true},
        {"cone", {6, NAN, NAN, 0}, 7, 12, 6, 1, 0, false},
        {"cone", {6, NAN, NAN, 1}, 7, 12, 7, 0, 0, true},
        {"cone", {3, NAN, NAN, 1}, 4, 6, 4, 0, 0, true},
        {"disk", {3, NAN, NAN, NAN}, 4, 6, 3, 1, 0, false},
        {"disk", {12, NAN, NAN, NAN}, 13, 24, 12, 1, 0, false},
        {"polygon", {3, NAN, NAN, NAN}, 3, 3, 1, 1, 0, false},
        {"polygon", {1000, NAN, NAN, NAN}, 1000, 1000, 1, 1, 0, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const double *a = rows[i].args;
        he_mesh *m = make(rows[i].name, a[0], a[1], a[2], a[3]);
        he_topology t = topology_of(m);
        fixture_counts(m, rows[i].v, rows[i].e, rows[i].f);
        assert_int_equal(t.boundary_loops, rows[i].loops);
        assert_int_equal(t.closed, rows[i].closed);
        assert_int_equal(t.components, 1);
        assert_true(t.manifold && t.has_genus);
        assert_int_equal(t.genus, rows[i].genus);
        he_topology_clear(&t);
        he_mesh_free(m);
    }
}

static void an_open_cylinder_of_six_sides_has_two_loops_of_six(void **state)
{
    (void)state;
    he_mesh *m = make("cylinder", 6, NAN, NAN, 0);
    he_boundaries loops;
    assert_int_equal(he_boundaries_find(m, &loops, NULL), HE_OK);
    assert_int_equal(loops.count, 2);
    assert_int_equal(loops.loops[0].length, 6);
    assert_int_equal(loops.loops[1].length, 6);
    he_boundaries_clear(&loops);
    he_mesh_free(m);
}

/* Requires for every shape that it has the requested size, that it is a valid mesh, and that its
 * faces look outward or up. */
static void each_shape_has_its_stated_size_and_looks_outward_or_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < he_shape_count(); i++) {
        const he_shape *shape = he_shape_at(i);
        assert_ptr_equal(he_shape_find(shape->name, strlen(shape->name)), shape);
        assert_true(strlen(shape->doc) > 5);
        double args[HE_SHAPE_PARAMS];
        he_shape_defaults(shape, args);
        he_shape_size size = shape->size(args);
        he_soup soup;
        assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_OK);
        assert_int_equal(soup.vertex_count, size.vertices);
        assert_int_equal(soup.face_count, size.faces);
        assert_int_equal(soup.corner_count, size.corners);
        for (size_t v = 0; v < soup.vertex_count; v++) {
            he_vec3 p = soup.positions[v];
            assert_false((p.x == 0 && signbit(p.x)) || (p.y == 0 && signbit(p.y)) ||
                         (p.z == 0 && signbit(p.z)));
        }
        he_soup_clear(&soup);
        he_mesh *m = make_default(shape->name);
        he_vec3 middle = {0, 0, 0};
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            middle = he_vec3_add(middle, he_position(m, (he_vertex){v}));
        }
        middle = he_vec3_scale(middle, 1.0 / he_mesh_vertices(m));
        for (uint32_t f = 0; f < he_mesh_faces(m); f++) {
            he_vec3 normal, centroid = he_face_centroid(m, (he_face){f});
            assert_true(he_face_normal(m, (he_face){f}, &normal));
            if (strcmp(shape->name, "grid") == 0 || strcmp(shape->name, "disk") == 0 ||
                strcmp(shape->name, "polygon") == 0) {
                assert_near(normal.z, 1);
            } else if (strcmp(shape->name, "torus") != 0) {
                assert_true(he_vec3_dot(normal, he_vec3_sub(centroid, middle)) > 0);
            }
        }
        he_mesh_free(m);
    }
    assert_null(he_shape_find("klein_bottle", 12));
    assert_null(he_shape_find("cub", 3));
    assert_null(he_shape_find("", 0));
}

static void regular_solids_have_equal_edges_and_exact_volumes(void **state)
{
    (void)state;
    static const char *const names[] = {"tetrahedron", "octahedron", "icosahedron", "dodecahedron"};
    for (size_t i = 0; i < 4; i++) {
        he_mesh *m = make(names[i], 2.5, NAN, NAN, NAN);
        double side = he_edge_length(m, (he_edge){0});
        for (uint32_t e = 0; e < he_mesh_edges(m); e++) {
            assert_near(he_edge_length(m, (he_edge){e}), side);
        }
        for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
            assert_near(he_vec3_length(he_position(m, (he_vertex){v})), 2.5);
        }
        double r = 2.5;
        /* The volumes are closed forms in the radius of the circumscribed sphere. */
        double golden = (1 + sqrt(5)) / 2;
        double ico = r / sin(2 * PI / 5), dodeca = r * 2 / (sqrt(3) * golden);
        double wanted[4] = {
            8 * sqrt(3) / 27 * r * r * r,
            4.0 / 3 * r * r * r,
            5 * (3 + sqrt(5)) / 12 * ico * ico * ico,
            (15 + 7 * sqrt(5)) / 4 * dodeca * dodeca * dodeca,
        };
        assert_near(volume_of(m), wanted[i]);
        he_mesh_free(m);
    }
    he_mesh *m = make_default("cube");
    assert_true(volume_of(m) == 1);
    assert_true(area_of(m) == 6);
    he_mesh_free(m);
    m = make("cube", 3, NAN, NAN, NAN);
    assert_true(volume_of(m) == 27);
    he_mesh_free(m);
}

static void shapes_have_the_radius_volume_and_area_of_their_arguments(void **state)
{
    (void)state;
    he_mesh *m = make("icosphere", 4, 3, NAN, NAN);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        assert_near(he_vec3_length(he_position(m, (he_vertex){v})), 3);
    }
    double ball = 4.0 / 3 * PI * 27;
    assert_true(volume_of(m) < ball && volume_of(m) > 0.99 * ball);
    he_mesh_free(m);
    m = make("uv_sphere", 64, 64, 3, NAN);
    for (uint32_t v = 0; v < he_mesh_vertices(m); v++) {
        assert_near(he_vec3_length(he_position(m, (he_vertex){v})), 3);
    }
    assert_true(volume_of(m) < ball && volume_of(m) > 0.99 * ball);
    he_mesh_free(m);
    m = make("torus", 200, 100, 2, 0.5);
    double ring = 2 * PI * PI * 2 * 0.25;
    assert_true(volume_of(m) < ring && volume_of(m) > 0.99 * ring);
    he_mesh_free(m);
    /* A regular n-gon in a circle of radius r has the area n r^2 sin(2 pi / n) / 2. */
    m = make("cylinder", 7, 2, 3, 1);
    assert_near(volume_of(m), 3 * 7 * 4 * sin(2 * PI / 7) / 2);
    he_mesh_free(m);
    m = make("cone", 7, 2, 3, 1);
    assert_near(volume_of(m), 7 * 4 * sin(2 * PI / 7) / 2);
    he_mesh_free(m);
    m = make("polygon", 5, 2, NAN, NAN);
    assert_near(area_of(m), 5 * 4 * sin(2 * PI / 5) / 2);
    he_mesh_free(m);
    m = make("disk", 5, 2, NAN, NAN);
    assert_near(area_of(m), 5 * 4 * sin(2 * PI / 5) / 2);
    he_mesh_free(m);
    m = make("grid", 3, 7, 4, 5);
    assert_near(area_of(m), 20);
    he_box box;
    assert_true(he_mesh_box(m, &box));
    assert_true(box.min.x == -2 && box.max.x == 2 && box.min.y == -2.5 && box.max.y == 2.5);
    he_mesh_free(m);
}

static void bad_arguments_of_a_shape_are_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t param;
        double value;
        he_status status;
    } rows[] = {{"cube", 0, 0, HE_BAD_VALUE},         {"cube", 0, -1, HE_BAD_VALUE},
                {"cube", 0, NAN, HE_NOT_FINITE},      {"cube", 0, INFINITY, HE_NOT_FINITE},
                {"cube", 0, 1e300, HE_BAD_VALUE},     {"icosphere", 0, -1, HE_BAD_VALUE},
                {"icosphere", 0, 13, HE_BAD_VALUE},   {"icosphere", 0, 1.5, HE_BAD_VALUE},
                {"uv_sphere", 0, 2, HE_BAD_VALUE},    {"uv_sphere", 1, 1, HE_BAD_VALUE},
                {"grid", 0, 0, HE_BAD_VALUE},         {"grid", 3, 0, HE_BAD_VALUE},
                {"torus", 1, 2, HE_BAD_VALUE},        {"torus", 0, 1e18, HE_BAD_VALUE},
                {"cylinder", 3, 0.5, HE_BAD_VALUE},   {"cylinder", 3, 2, HE_BAD_VALUE},
                {"cone", 0, 2, HE_BAD_VALUE},         {"polygon", 0, 2, HE_BAD_VALUE},
                {"disk", 2, -INFINITY, HE_NOT_FINITE}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const he_shape *shape = shape_named(rows[i].name);
        double args[HE_SHAPE_PARAMS];
        he_shape_defaults(shape, args);
        args[rows[i].param] = rows[i].value;
        he_soup soup = {.vertex_count = 77};
        he_error err = {0};
        size_t param = 99;
        assert_int_equal(he_shape_check(shape, args, &param, &err), rows[i].status);
        assert_int_equal(param, rows[i].param);
        assert_int_equal(err.status, rows[i].status);
        assert_non_null(strstr(err.text, shape->params[param].name));
        assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), rows[i].status);
        assert_int_equal(soup.vertex_count, 77);
    }
    /* Arguments that are just inside the limits must be accepted. */
    he_mesh *m = make("disk", NAN, NAN, -2, NAN);
    he_mesh_free(m);
    m = make("cube", 1e-300, NAN, NAN, NAN);
    he_mesh_free(m);
}

static void a_shape_over_its_limits_is_refused_before_allocating(void **state)
{
    (void)state;
    for (size_t i = 0; i < he_shape_count(); i++) {
        const he_shape *shape = he_shape_at(i);
        double args[HE_SHAPE_PARAMS];
        he_shape_defaults(shape, args);
        he_shape_size size = shape->size(args);
        uint64_t bytes = size.vertices * 24 + (size.faces + size.corners) * 4;
        he_limits exact = {size.vertices, size.faces, size.corners, bytes, NULL};
        he_soup soup;
        assert_int_equal(he_shape_make(shape, args, &exact, &soup, NULL), HE_OK);
        he_soup_clear(&soup);
        for (int j = 0; j < 4; j++) {
            he_limits low = exact;
            low.vertices -= j == 0;
            low.faces -= j == 1 && low.faces > 1;
            low.corners -= j == 2;
            low.bytes -= j == 3;
            if (j == 1 && low.faces == exact.faces) {
                continue;
            }
            he_error err = {0};
            failing_at(0);
            assert_int_equal(he_shape_make(shape, args, &low, &soup, &err), HE_LIMIT);
            assert_int_equal(failing_count(), 0);
            failing_off();
            assert_int_equal(err.status, HE_LIMIT);
        }
    }
    static const char *const large[] = {"uv_sphere", "grid", "torus"};
    for (size_t i = 0; i < 3; i++) {
        const he_shape *shape = shape_named(large[i]);
        double args[HE_SHAPE_PARAMS];
        he_shape_defaults(shape, args);
        args[0] = shape->params[0].max;
        args[1] = shape->params[1].max;
        he_soup soup;
        failing_at(0);
        assert_int_equal(he_shape_make(shape, args, NULL, &soup, NULL), HE_LIMIT);
        assert_int_equal(failing_count(), 0);
        failing_off();
    }
}

static void each_allocation_of_a_shape_may_fail(void **state)
{
    (void)state;
    const he_shape *shape = shape_named("icosphere");
    double args[HE_SHAPE_PARAMS];
    he_shape_defaults(shape, args);
    failing f = {0};
    while (failing_next(&f)) {
        he_soup soup = {.vertex_count = 77};
        if (failing_status(&f, he_shape_make(shape, args, NULL, &soup, NULL))) {
            he_soup_clear(&soup);
        } else {
            assert_int_equal(soup.vertex_count, 77);
        }
    }
    assert_int_equal(f.n, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_have_their_counts_genus_and_boundary_loops),
        cmocka_unit_test(an_open_cylinder_of_six_sides_has_two_loops_of_six),
        cmocka_unit_test(each_shape_has_its_stated_size_and_looks_outward_or_up),
        cmocka_unit_test(regular_solids_have_equal_edges_and_exact_volumes),
        cmocka_unit_test(shapes_have_the_radius_volume_and_area_of_their_arguments),
        cmocka_unit_test(bad_arguments_of_a_shape_are_refused_by_name),
        cmocka_unit_test(a_shape_over_its_limits_is_refused_before_allocating),
        cmocka_unit_test(each_allocation_of_a_shape_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
