/* Remeshing: seams of attributes of corners, such as uv. A grid has one seam, a polyline with a
 * bend: right of x = MIDDLE and below y = BEND, uv is another function of the place than elsewhere.
 *
 *      +---------+---------+
 *      |     outside       |
 *      |         +---------+ y = BEND
 *      |         | inside  |
 *      +---------+---------+
 *             x = MIDDLE
 */
#include "tests/unit/dense.h"

#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "mesh/write.h"
#include "tests/unit/remeshed.h"

#include <math.h>

enum { SIDE = 20, ACROSS = SIDE + 1, MIDDLE = 10, BEND = 13 };

static const double lengths[] = {0.37, 0.9, 1.7, 2.6};

enum { LENGTHS = sizeof lengths / sizeof *lengths };

static double flat(double x, double y)
{
    (void)x, (void)y;
    return 0;
}

static bool is_inside(const he_mesh *m, uint32_t face)
{
    he_vec3 sum = {0, 0, 0};
    for (unsigned i = 0; i < 3; i++) {
        sum = he_vec3_add(sum, dense_corner(m, face, i));
    }
    return sum.x > 3 * MIDDLE && sum.y < 3 * BEND;
}

static void uv_at(he_vec3 p, bool inside, double uv[2])
{
    uv[0] = inside ? 2 + 0.5 * p.y / SIDE : p.x / SIDE;
    uv[1] = inside ? 0.25 - p.x / SIDE : p.y / SIDE;
}

static void get(const he_column *column, he_halfedge h, double uv[2])
{
    const unsigned char *value = he_column_value(column, h.i);
    for (unsigned k = 0; k < 2; k++) {
        float narrow;
        if (column->type == HE_FLOAT) {
            memcpy(&narrow, value + k * sizeof narrow, sizeof narrow);
            uv[k] = (double)narrow;
        } else {
            memcpy(&uv[k], value + k * sizeof uv[k], sizeof uv[k]);
        }
    }
}

static void set(he_column *column, he_halfedge h, const double uv[2])
{
    const float narrow[2] = {(float)uv[0], (float)uv[1]};
    if (column->type == HE_FLOAT) {
        memcpy(he_column_row(column, h.i), narrow, sizeof narrow);
    } else {
        memcpy(he_column_row(column, h.i), uv, 2 * sizeof *uv);
    }
}

static he_mesh *textured(double (*height)(double x, double y), he_type type)
{
    he_mesh *m = dense_grid(SIDE, height, 1);
    he_column *column =
        remesh_add_column(m, &(he_column_schema){"uv", HE_HALFEDGE, type, 2, HE_INTERPOLATE});
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (unsigned k = 0; k < 3; k++, h = he_next(m, h)) {
            double uv[2];
            uv_at(he_position(m, he_origin(m, h)), is_inside(m, f), uv);
            set(column, h, uv);
        }
    }
    return m;
}

static double gap(const he_column *column, he_halfedge a, he_halfedge b)
{
    double at_a[2], at_b[2];
    get(column, a, at_a);
    get(column, b, at_b);
    return fmax(fabs(at_a[0] - at_b[0]), fabs(at_a[1] - at_b[1]));
}

/* The edges at which values differ by more than a bound, and the largest difference at others. */
typedef struct seam {
    uint32_t edges;
    double length, largest;
} seam;

static seam seam_of(const he_mesh *m, double bound)
{
    const he_column *column = he_mesh_find_column(m, HE_HALFEDGE, "uv");
    seam out = {0, 0, 0};
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        const he_halfedge h = {2 * e}, twin = {2 * e + 1};
        if (!he_mesh_is_live(m, HE_EDGE, e) || he_is_boundary_edge(m, (he_edge){e})) {
            continue;
        }
        const double apart =
            fmax(gap(column, h, he_next(m, twin)), gap(column, he_next(m, h), twin));
        if (apart > bound) {
            out.edges++;
            out.length += he_edge_length(m, (he_edge){e});
        } else {
            out.largest = fmax(out.largest, apart);
        }
    }
    return out;
}

/* Returns how far a value is at most from what it should be at its place on a flat grid. */
static double worst_value(const he_mesh *m)
{
    const he_column *column = he_mesh_find_column(m, HE_HALFEDGE, "uv");
    double worst = 0;
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (unsigned k = 0; k < 3 && he_mesh_is_live(m, HE_FACE, f); k++) {
            double wanted[2], found[2];
            uv_at(he_position(m, he_origin(m, h)), is_inside(m, f), wanted);
            get(column, h, found);
            worst = fmax(worst, fmax(fabs(found[0] - wanted[0]), fabs(found[1] - wanted[1])));
            h = he_next(m, h);
        }
    }
    return worst;
}

static he_remesh_options with_seams(double length)
{
    he_remesh_options options = remesh_options(length);
    options.keep_seams = true;
    return options;
}

static void a_flat_seam_stays_with_the_values_on_both_sides(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 2 * LENGTHS; i++) {
        const he_type type = i < LENGTHS ? HE_DOUBLE : HE_FLOAT;
        const double rounding = type == HE_DOUBLE ? 1e-13 : 1e-6;
        const he_remesh_options options = with_seams(lengths[i % LENGTHS]);
        he_mesh *m = textured(flat, type);
        /* The second time there are rounding errors, which must not count as seams. */
        for (unsigned again = 0; again < 2; again++) {
            const he_remeshed done = remesh_mesh(m, &options);
            assert_true(done.smallest_angle > 0.3);
            const seam after = seam_of(m, rounding);
            assert_true(fabs(after.length - (BEND + SIDE - MIDDLE)) <= 1e-12 * SIDE);
            const uint32_t corner = BEND * ACROSS + MIDDLE;
            assert_true(he_mesh_is_live(m, HE_VERTEX, corner));
            assert_true(
                dense_same_point(he_position(m, (he_vertex){corner}), (he_vec3){MIDDLE, BEND, 0}));
            assert_true(worst_value(m) <= rounding);
        }
        he_mesh_free(m);
    }
}

static void on_a_curved_surface_values_have_no_other_seam(void **state)
{
    (void)state;
    for (unsigned i = 0; i < LENGTHS; i++) {
        he_mesh *m = textured(dense_waves, HE_DOUBLE);
        const seam before = seam_of(m, 0.1);
        const he_remesh_options options = with_seams(lengths[i]);
        (void)remesh_mesh(m, &options);
        const seam after = seam_of(m, 0.1);
        assert_true(after.edges > 0);
        assert_true(after.length <= before.length * (1 + 1e-12));
        assert_true(after.length >= before.length * 0.97);
        assert_true(after.largest <= 1e-9);
        he_mesh_free(m);
    }
}

/* Returns true if remeshing makes the same triangles whether seams are kept or not. */
static bool is_no_seam(const char *name, he_type type, he_rule rule)
{
    he_mesh *m = dense_grid(SIDE, dense_waves, 1);
    he_column *column = remesh_add_column(m, &(he_column_schema){name, HE_HALFEDGE, type, 3, rule});
    for (uint32_t f = 0; f < he_mesh_issued(m, HE_FACE); f++) {
        he_halfedge h = he_face_halfedge(m, (he_face){f});
        for (unsigned k = 0; k < 3; k++, h = he_next(m, h)) {
            memset(he_column_row(column, h.i), (int)(1 + f % 50), column->row_bytes);
        }
    }
    he_mesh *other = dense_copy(m);
    const he_remesh_options without = remesh_options(1.7), with = with_seams(1.7);
    (void)remesh_mesh(m, &without);
    (void)remesh_mesh(other, &with);
    const bool same = he_mesh_equal(m, other);
    he_mesh_free(m);
    he_mesh_free(other);
    return same;
}

static void only_interpolated_numbers_that_do_not_tell_of_the_shape_have_seams(void **state)
{
    (void)state;
    assert_true(is_no_seam("normal", HE_FLOAT, HE_INTERPOLATE));
    assert_true(is_no_seam("tangent", HE_DOUBLE, HE_INTERPOLATE));
    assert_true(is_no_seam("uv", HE_FLOAT, HE_COPY));
    assert_true(is_no_seam("uv", HE_INT32, HE_COPY));
    assert_false(is_no_seam("uv", HE_FLOAT, HE_INTERPOLATE));
    assert_false(is_no_seam("color", HE_DOUBLE, HE_INTERPOLATE));
}

static void a_seam_goes_if_it_is_not_to_be_kept(void **state)
{
    (void)state;
    he_mesh *m = textured(flat, HE_DOUBLE);
    const he_remesh_options options = remesh_options(1.7);
    (void)remesh_mesh(m, &options);
    assert_true(worst_value(m) > 1);
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_seam_stays_with_the_values_on_both_sides),
        cmocka_unit_test(on_a_curved_surface_values_have_no_other_seam),
        cmocka_unit_test(only_interpolated_numbers_that_do_not_tell_of_the_shape_have_seams),
        cmocka_unit_test(a_seam_goes_if_it_is_not_to_be_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
