/* Decimation: which elements must stay, and which attribute values move together with vertices. */
#include "tests/unit/dense.h"

#include "mesh/marks.h"
#include "mesh/write.h"
#include "query/bvh.h"

#include <math.h>

/* A grid is bent out of its plane: decimation must leave its outline in place. */
static void boundaries_are_kept(void **state)
{
    (void)state;
    he_mesh *m = dense_grid(30, dense_waves, 1), *first = dense_copy(m);
    dense_decimate(m, he_mesh_faces(m) / 6, INFINITY);
    assert_int_equal(he_mesh_vertices(m) + he_mesh_faces(m) - he_mesh_edges(m), 1);
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (!he_mesh_is_live(m, HE_EDGE, e) || !he_is_boundary_edge(m, (he_edge){e})) {
            continue;
        }
        for (unsigned side = 0; side < 2; side++) {
            he_vec3 p = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, side)));
            double out = fmin(fmin(fabs(p.x), fabs(p.x - 30)), fmin(fabs(p.y), fabs(p.y - 30)));
            assert_true(out < 0.05);
        }
    }
    static const uint32_t corners[4] = {0, 30, 31 * 30, 31 * 31 - 1};
    dense_apart there = dense_measure(first, m);
    assert_true(there.farthest < 0.6);
    for (unsigned i = 0; i < 4; i++) {
        he_budget budget = {.left = UINT64_MAX};
        he_bvh *tree = NULL;
        he_hit hit;
        assert_int_equal(he_bvh_new(m, NULL, &tree, NULL), HE_OK);
        assert_int_equal(he_bvh_closest(tree, m, he_position(first, (he_vertex){corners[i]}),
                                        HUGE_VAL, &budget, &hit, NULL),
                         HE_OK);
        assert_true(hit.distance < 0.05);
        he_bvh_free(tree);
    }
    he_mesh_free(first);
    he_mesh_free(m);
}

/* Returns how far the boundary of a grid moves from its original outline in a decimation with this
 * boundary weight. */
static double outline_error(double weight)
{
    enum { SIDE = 30 };
    he_mesh *m = dense_grid(SIDE, dense_waves, 1);
    he_decimate_options options = {he_mesh_faces(m) / 20, INFINITY, weight};
    double most = 0;
    assert_int_equal(he_decimate(m, &options, NULL, NULL), HE_OK);
    fixture_check(m);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (he_mesh_is_live(m, HE_VERTEX, v) && he_is_boundary_vertex(m, (he_vertex){v})) {
            he_vec3 p = he_position(m, (he_vertex){v});
            double x = fmin(fabs(p.x), fabs(p.x - SIDE)), y = fmin(fabs(p.y), fabs(p.y - SIDE));
            most = fmax(most, fmin(x, y));
        }
    }
    he_mesh_free(m);
    return most;
}

static void a_boundary_is_kept_by_its_weight(void **state)
{
    (void)state;
    double free_of = outline_error(0), light = outline_error(0.1), heavy = outline_error(100);
    printf("note: off the outline by %g, %g and %g\n", free_of, light, heavy);
    assert_true(free_of > 4 * light && light > 4 * heavy && heavy < 0.1);
}

/* --- marks --- */

static void mark(he_mesh *m, he_kind kind, const char *name, uint32_t id)
{
    if (he_mark_find(m, kind, name) == NULL) {
        he_column *column = NULL;
        assert_int_equal(
            he_column_new(&(he_column_schema){name, kind, HE_BOOL, 1, HE_COPY}, &column, NULL),
            HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, kind), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    const unsigned char yes = 1;
    size_t slot = he_mesh_column_slot(m, he_mark_find(m, kind, name));
    assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
    he_set_attribute(m, slot, id, &yes);
}

static void locked_elements_stay(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(20), *first = dense_copy(m);
    for (uint32_t i = 0; i < 12; i++) {
        mark(m, HE_VERTEX, "locked", 31 * i);
        mark(m, HE_FACE, "locked", 61 * i + 3);
        mark(m, HE_EDGE, "locked", 97 * i + 1);
    }
    he_decimated done = dense_decimate(m, 0, INFINITY);
    assert_int_equal(done.stop, HE_STOP_EXHAUSTED);
    assert_true(he_mesh_faces(m) < 300);
    for (uint32_t i = 0; i < 12; i++) {
        he_vec3 p = he_position(m, (he_vertex){31 * i});
        he_vec3 q = he_position(first, (he_vertex){31 * i});
        assert_true(he_mesh_is_live(m, HE_VERTEX, 31 * i) && p.x == q.x && p.y == q.y &&
                    p.z == q.z);
        assert_true(he_mesh_is_live(m, HE_FACE, 61 * i + 3));
        for (unsigned k = 0; k < 2; k++) {
            he_halfedge h = {2 * (97 * i + 1) + k};
            assert_true(he_edge_is_live(m, he_edge_of(h)));
            assert_int_equal(he_origin(m, h).i, he_origin(first, h).i);
        }
    }
    he_mesh_free(first);
    he_mesh_free(m);
}

static void add_numbers(he_mesh *m, he_kind kind)
{
    he_column *column = NULL;
    uint32_t rows = he_mesh_issued(m, kind);
    assert_int_equal(
        he_column_new(&(he_column_schema){"number", kind, HE_DOUBLE, 1, HE_INTERPOLATE}, &column,
                      NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    for (uint32_t i = 0; i < rows; i++) {
        double value = i;
        memcpy(he_column_row(column, i), &value, sizeof value);
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void locked_elements_keep_their_attributes(void **state)
{
    (void)state;
    static const he_kind kinds[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        he_mesh *m = dense_grid(12, NULL, 1);
        add_numbers(m, kinds[k]);
        uint32_t rows = he_mesh_issued(m, kinds[k]);
        for (uint32_t i = 0; i < rows; i += 23) {
            mark(m, kinds[k], "locked", i);
        }
        dense_decimate(m, 0, INFINITY);
        assert_true(he_mesh_count(m, kinds[k]) < rows / 2);
        const he_column *numbers = he_mesh_find_column(m, kinds[k], "number");
        for (uint32_t i = 0; i < rows; i += 23) {
            double value;
            memcpy(&value, he_column_value(numbers, i), sizeof value);
            assert_true(he_mesh_is_live(m, kinds[k], i) && value == i);
        }
        he_mesh_free(m);
    }
}

/* A straight row of edges across a flat grid could be removed without any error. If its edges are
 * marked as a feature, the row must stay, and stay straight. */
static void feature_lines_keep_their_shape(void **state)
{
    (void)state;
    enum { SIDE = 16 };
    he_mesh *m = dense_grid(SIDE, NULL, 1);
    for (uint32_t i = 0; i < SIDE; i++) {
        uint32_t v = SIDE / 2 * (SIDE + 1) + i;
        he_halfedge h = he_find_halfedge(m, (he_vertex){v}, (he_vertex){v + 1});
        assert_true(h.i != HE_NONE);
        mark(m, HE_EDGE, "feature", he_edge_of(h).i);
    }
    he_decimated done = dense_decimate(m, 0, 0);
    assert_true(done.error == 0);
    double length = 0;
    const he_column *feature = he_mark_find(m, HE_EDGE, "feature");
    for (uint32_t e = 0; e < he_mesh_issued(m, HE_EDGE); e++) {
        if (he_mesh_is_live(m, HE_EDGE, e) && he_is_marked(feature, e)) {
            he_vec3 a = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, 0)));
            he_vec3 b = he_position(m, he_origin(m, he_edge_halfedge((he_edge){e}, 1)));
            assert_true(a.y == SIDE / 2.0 && b.y == SIDE / 2.0);
            length += fabs(a.x - b.x);
        }
    }
    assert_true(fabs(length - SIDE) < 1e-9);
    assert_in_range(he_mesh_vertices(m), 6, 6);
    he_mesh_free(m);
}

static void attributes_follow_the_place(void **state)
{
    (void)state;
    enum { SIDE = 16 };
    he_mesh *m = dense_grid(SIDE, NULL, 1);
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){"height", HE_VERTEX, HE_DOUBLE, 1, HE_INTERPOLATE},
                      &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    size_t slot = he_mesh_column_slot(m, column);
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        double value = 3 * p.x - 2 * p.y;
        assert_int_equal(he_reserve_values(m, slot, 1, NULL), HE_OK);
        he_set_attribute(m, slot, v, &value);
    }
    dense_decimate(m, 60, INFINITY);
    column = NULL;
    const he_column *heights = he_mesh_find_column(m, HE_VERTEX, "height");
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        if (he_mesh_is_live(m, HE_VERTEX, v)) {
            he_vec3 p = he_position(m, (he_vertex){v});
            double value;
            memcpy(&value, he_column_value(heights, v), sizeof value);
            assert_true(fabs(value - (3 * p.x - 2 * p.y)) < 1e-3);
        }
    }
    he_mesh_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boundaries_are_kept),
        cmocka_unit_test(a_boundary_is_kept_by_its_weight),
        cmocka_unit_test(locked_elements_stay),
        cmocka_unit_test(locked_elements_keep_their_attributes),
        cmocka_unit_test(feature_lines_keep_their_shape),
        cmocka_unit_test(attributes_follow_the_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
