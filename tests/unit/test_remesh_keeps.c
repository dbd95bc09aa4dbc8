/* Remeshing: feature lines and their corners, values on the two sides of a line, faces outside the
 * set, the distance that is reported, and the order of parallel parts. */
#include "tests/unit/dense.h"

#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "mesh/write.h"
#include "tests/unit/backwards.h"
#include "tests/unit/remeshed.h"

#include <math.h>

enum { SIDE = 20, ACROSS = SIDE + 1 };

/* --- lines --- */

/* The line from vertex (4, 10) of a grid to (15, 10), and on to (15, 16). */
static bool is_on_line(uint32_t v)
{
    const uint32_t x = v % ACROSS, y = v / ACROSS;
    return (y == 10 && x >= 4 && x <= 15) || (x == 15 && y >= 10 && y <= 16);
}

static void mark_line(he_mesh *m)
{
    he_column *feature =
        remesh_add_column(m, &(he_column_schema){"feature", HE_EDGE, HE_BOOL, 1, HE_COPY});
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        const he_halfedge h = {2 * e};
        const uint32_t a = he_origin(m, h).i, b = he_target(m, h).i;
        const bool straight = a % ACROSS == b % ACROSS || a / ACROSS == b / ACROSS;
        *he_column_row(feature, e) = straight && is_on_line(a) && is_on_line(b);
    }
}

static double to_segment(he_vec3 p, he_vec3 a, he_vec3 b)
{
    const he_vec3 ab = he_vec3_sub(b, a), ap = he_vec3_sub(p, a);
    const double t = fmin(fmax(he_vec3_dot(ap, ab) / he_vec3_dot(ab, ab), 0), 1);
    return he_vec3_length(he_vec3_sub(ap, he_vec3_scale(ab, t)));
}

static double to_line(const he_mesh *first, he_vec3 p)
{
    double least = HUGE_VAL;
    for (uint32_t v = 0; v < ACROSS * ACROSS; v++) {
        const uint32_t beside[2] = {v + 1, v + ACROSS};
        for (int k = 0; k < 2 && is_on_line(v); k++) {
            if (beside[k] < ACROSS * ACROSS && is_on_line(beside[k])) {
                least = fmin(least, to_segment(p, he_position(first, (he_vertex){v}),
                                               he_position(first, (he_vertex){beside[k]})));
            }
        }
    }
    return least;
}

/* What the marked edges of a mesh are together. */
typedef struct line {
    uint32_t edges, ends;
    double length;
} line;

static line line_of(const he_mesh *m)
{
    line out = {0};
    const he_column *feature = he_mesh_find_column(m, HE_EDGE, "feature");
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        uint32_t count = 0;
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            const he_halfedge h = {2 * e};
            if (he_mesh_is_live(m, HE_EDGE, e) && *he_column_value(feature, e) != 0) {
                count += he_origin(m, h).i == v || he_target(m, h).i == v;
            }
        }
        out.ends += count == 1;
        assert_true(count <= 2);
    }
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (he_mesh_is_live(m, HE_EDGE, e) && *he_column_value(feature, e) != 0) {
            out.edges++;
            out.length += he_edge_length(m, (he_edge){e});
        }
    }
    return out;
}

static void a_feature_line_is_divided_anew_and_its_corners_stay(void **state)
{
    (void)state;
    static const double lengths[] = {0.45, 0.8, 1.7, 3};
    static const uint32_t corners[] = {10 * ACROSS + 4, 10 * ACROSS + 15, 16 * ACROSS + 15};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_grid(SIDE, dense_waves, 1);
        mark_line(m);
        he_mesh *first = dense_copy(m);
        const line before = line_of(m);
        const he_remesh_options options = remesh_options(lengths[i]);
        (void)remesh_mesh(m, &options);
        const line after = line_of(m);
        const he_column *feature = he_mesh_find_column(m, HE_EDGE, "feature");
        assert_int_equal(before.edges, 17);
        assert_int_equal(before.ends, 2);
        assert_int_equal(after.ends, 2);
        assert_true(after.edges != before.edges);
        assert_true(after.length <= before.length * (1 + 1e-12));
        assert_true(after.length >= before.length * 0.97);
        for (size_t k = 0; k < 3; k++) {
            assert_true(he_mesh_is_live(m, HE_VERTEX, corners[k]));
            assert_true(dense_same_point(he_position(m, (he_vertex){corners[k]}),
                                         he_position(first, (he_vertex){corners[k]})));
        }
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            if (he_mesh_is_live(m, HE_EDGE, e) && *he_column_value(feature, e) != 0) {
                const he_vec3 a = he_position(m, he_origin(m, (he_halfedge){2 * e}));
                const he_vec3 b = he_position(m, he_target(m, (he_halfedge){2 * e}));
                assert_true(to_line(first, a) <= 1e-12 && to_line(first, b) <= 1e-12);
                assert_true(to_line(first, he_vec3_scale(he_vec3_add(a, b), 0.5)) <=
                            0.1 * lengths[i]);
            }
        }
        he_mesh_free(first);
        he_mesh_free(m);
    }
}

/* --- values --- */

static void set_value(he_column *column, uint32_t row, double value)
{
    memcpy(he_column_row(column, row), &value, sizeof value);
}
static double value_of(const he_column *column, uint32_t row)
{
    double value;
    memcpy(&value, he_column_value(column, row), sizeof value);
    return value;
}

/* Returns 1 if the middle of a face of the grid is right of the middle of the grid, else 0. */
static double side_of(const he_mesh *m, uint32_t face)
{
    double sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum += dense_corner(m, face, i).x;
    }
    return sum / 3 > 0.5 * SIDE ? 1 : 0;
}

static void values_stay_on_their_side_of_a_line(void **state)
{
    (void)state;
    static const double lengths[] = {0.4, 1.4, 2.5};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_grid(SIDE, dense_waves, 1);
        he_column *feature =
            remesh_add_column(m, &(he_column_schema){"feature", HE_EDGE, HE_BOOL, 1, HE_COPY});
        he_column *corner = remesh_add_column(
            m, &(he_column_schema){"seam", HE_HALFEDGE, HE_DOUBLE, 1, HE_INTERPOLATE});
        he_column *face =
            remesh_add_column(m, &(he_column_schema){"part", HE_FACE, HE_DOUBLE, 1, HE_COPY});
        for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
            const he_halfedge h = {2 * e};
            *he_column_row(feature, e) =
                he_origin(m, h).i % ACROSS == SIDE / 2 && he_target(m, h).i % ACROSS == SIDE / 2;
        }
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            he_halfedge h = he_face_halfedge(m, (he_face){f});
            set_value(face, f, side_of(m, f));
            for (unsigned k = 0; k < 3; k++, h = he_next(m, h)) {
                set_value(corner, h.i, side_of(m, f));
            }
        }
        const he_remesh_options options = remesh_options(lengths[i]);
        (void)remesh_mesh(m, &options);
        const he_column *corner_after = he_mesh_find_column(m, HE_HALFEDGE, "seam");
        const he_column *face_after = he_mesh_find_column(m, HE_FACE, "part");
        for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
            if (!he_mesh_is_live(m, HE_FACE, f)) {
                continue;
            }
            he_halfedge h = he_face_halfedge(m, (he_face){f});
            assert_true(value_of(face_after, f) == side_of(m, f));
            for (unsigned k = 0; k < 3; k++, h = he_next(m, h)) {
                assert_true(fabs(value_of(corner_after, h.i) - side_of(m, f)) <= 1e-12);
            }
        }
        he_mesh_free(m);
    }
}

/* --- the set of faces --- */

static void faces_outside_the_set_keep_every_bit(void **state)
{
    (void)state;
    static uint32_t ids[2 * SIDE * SIDE];
    static const double lengths[] = {0.3, 2.2};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_grid(SIDE, dense_waves, 1), *first = dense_copy(m);
        he_remesh_options options = remesh_options(lengths[i]);
        options.faces = ids;
        for (uint32_t f = 0; f < 2 * SIDE * SIDE; f++) {
            if (side_of(m, f) == 1) {
                ids[options.face_count++] = f;
            }
        }
        const he_remeshed done = remesh_mesh(m, &options);
        assert_int_equal(done.faces_before, options.face_count);
        assert_true(done.faces != done.faces_before);
        for (uint32_t f = 0; f < 2 * SIDE * SIDE; f++) {
            he_halfedge h = he_face_halfedge(first, (he_face){f});
            for (unsigned k = 0; k < 3 && side_of(first, f) == 0; k++, h = he_next(first, h)) {
                const he_vertex v = he_origin(first, h);
                assert_int_equal(he_face_of(m, h).i, f);
                assert_int_equal(he_origin(m, h).i, v.i);
                assert_true(dense_same_point(he_position(m, v), he_position(first, v)));
            }
        }
        he_mesh_free(first);
        he_mesh_free(m);
    }
}

/* --- the reported distance --- */

static void require_bound(const char *what, he_mesh *takes, double length, bool project)
{
    he_mesh *first = dense_copy(takes);
    he_remesh_options options = remesh_options(length);
    options.project = project;
    const he_remeshed done = remesh_mesh(takes, &options);
    const double farthest = dense_measure(takes, first).farthest;
    printf("note: %s, edges of %g: at most %g away, the farthest point of samples %g\n", what,
           length, done.distance, farthest);
    assert_true(farthest <= done.distance * (1 + 1e-9) + 1e-13);
    /* Samples miss the farthest point, and the farthest point is nearer than the one below it. */
    assert_true(done.distance <= 3 * farthest + 1e-9);
    he_mesh_free(first);
    he_mesh_free(takes);
}

static void the_reported_distance_bounds_that_of_all_points(void **state)
{
    (void)state;
    static const double lengths[] = {0.4, 1, 2};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        require_bound("waves", dense_grid(SIDE, dense_waves, 1), lengths[i], true);
        require_bound("waves, not projected", dense_grid(SIDE, dense_waves, 1), lengths[i], false);
        require_bound("torus", dense_torus(60), 0.2 * lengths[i], true);
        require_bound("sphere", dense_shape("icosphere", "subdivisions", 4), 0.2 * lengths[i],
                      true);
        require_bound("cube", dense_cube(10), lengths[i], true);
    }
}

static void a_closed_convex_surface_keeps_its_volume(void **state)
{
    (void)state;
    static const double lengths[] = {0.1, 0.2, 0.4};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        he_mesh *m = dense_shape("icosphere", "subdivisions", 5);
        he_measures before, after;
        const he_remesh_options options = remesh_options(lengths[i]);
        assert_int_equal(he_mesh_measure(m, &before, NULL), HE_OK);
        (void)remesh_mesh(m, &options);
        assert_int_equal(he_mesh_measure(m, &after, NULL), HE_OK);
        const double change = after.volume / before.volume - 1, h = lengths[i];
        printf("note: sphere, edges of %g: the volume changes by %g, %g h^2\n", h, change,
               change / (h * h));
        /* With its vertices on the sphere it would change by about -0.3 h^2. */
        assert_true(fabs(change) < 0.06 * h * h);
        he_mesh_free(m);
    }
}

static void the_order_of_the_parts_does_not_matter(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(120), *alone = dense_copy(m);
    he_progress progress;
    uint32_t count;
    const he_remesh_options options = remesh_options(0.06);
    backwards_lend(&progress, &count);
    he_mesh_set_progress(m, &progress);
    const he_remeshed done = remesh_mesh(m, &options);
    he_mesh_set_progress(m, NULL);
    const he_remeshed alone_done = remesh_mesh(alone, &options);
    assert_true(count >= 4);
    assert_true(he_mesh_equal(m, alone));
    assert_true(done.distance == alone_done.distance);
    he_mesh_free(alone);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_feature_line_is_divided_anew_and_its_corners_stay),
        cmocka_unit_test(values_stay_on_their_side_of_a_line),
        cmocka_unit_test(faces_outside_the_set_keep_every_bit),
        cmocka_unit_test(the_reported_distance_bounds_that_of_all_points),
        cmocka_unit_test(a_closed_convex_surface_keeps_its_volume),
        cmocka_unit_test(the_order_of_the_parts_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
