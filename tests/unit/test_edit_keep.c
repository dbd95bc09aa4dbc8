/* A weld with the option `keep` preserves the attribute values of vertices: if the merged vertices
 * have different values, the attribute becomes an attribute of face corners. Undo makes it an
 * attribute of vertices again. */
#include "unit/edit_script.h"

#include "mesh/check.h"
#include "mesh/write.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* In this mesh vertices 1 and 5 have equal positions, and so have vertices 2 and 4. */
static const he_vec3 beside[6] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}};
#define BESIDE "012,345"

/* Adds a column of attribute values: either one bool per element, which is true, or two doubles per
 * element, which for element i are 10 * i + 1 and 7. */
static he_column *add_column(he_mesh *m, he_kind domain, const char *name, he_type type,
                             he_rule rule)
{
    he_column *column = NULL;
    uint32_t components = type == HE_BOOL ? 1 : 2;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, type, components, rule}, &column, NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, domain), NULL), HE_OK);
    for (size_t row = 0; row < column->rows; row++) {
        double numbers[2] = {10.0 * (double)row + 1, 7};
        if (type == HE_DOUBLE) {
            memcpy(he_column_row(column, row), numbers, sizeof numbers);
        } else {
            memset(he_column_row(column, row), 1, column->row_bytes);
        }
    }
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    return column;
}

static void set_first(he_column *column, uint32_t row, double value)
{
    memcpy(he_column_row(column, row), &value, sizeof value);
}

static double first_of(const he_column *column, uint32_t row)
{
    double value;
    memcpy(&value, he_column_value(column, row), sizeof value);
    return value;
}

/* Requires that the attribute has the values a, b and c at the three corners of the face, in the
 * order around the face. The value a may be at any corner. */
static void expect_corners(const he_mesh *m, const char *name, uint32_t face, double a, double b,
                           double c)
{
    const he_column *column = he_mesh_find_column(m, HE_HALFEDGE, name);
    assert_non_null(column);
    he_halfedge h = he_face_halfedge(m, (he_face){face});
    for (unsigned i = 0; i < 3; i++, h = he_next(m, h)) {
        he_halfedge n = he_next(m, h);
        if (first_of(column, h.i) == a && first_of(column, n.i) == b &&
            first_of(column, he_next(m, n).i) == c) {
            return;
        }
    }
    fail_msg("corners of face %u do not say %g %g %g", face, a, b, c);
}

static const struct {
    const char *operation;
    size_t result;
} welds[] = {
    {"weld tolerance=0", 1},
    {"vertex_weld tolerance=0", 1},
    {"edge_weld a=1-2 b=4-5", 1},
    {"loop_join a=2-1 b=5-4", 0},
};
enum { WELDS = sizeof welds / sizeof *welds };

static void values_that_differ_go_to_corners(void **state)
{
    (void)state;
    for (size_t i = 0; i < WELDS; i++) {
        he_mesh *m = script_mesh(BESIDE, beside);
        add_column(m, HE_VERTEX, "uv", HE_DOUBLE, HE_INTERPOLATE);
        he_mesh *before = copy_of(m);
        he_delta *delta = he_delta_new();
        he_results results = {0};
        assert_non_null(delta);
        he_mesh_record(m, delta);
        assert_int_equal(script_run(m, welds[i].operation, &results, NULL), HE_OK);
        assert_valid(m);
        bool whole = strncmp(welds[i].operation, "loop", 4) == 0;
        assert_true(results.number[welds[i].result] == (whole ? 3 : 2));
        assert_null(he_mesh_find_column(m, HE_VERTEX, "uv"));
        expect_corners(m, "uv", 0, 1, 11, 21);
        expect_corners(m, "uv", 1, 31, 41, 51);
        he_mesh *after = copy_of(m);
        he_mesh_record(m, NULL);
        he_delta_undo(delta, m);
        assert_equal(m, before);
        he_delta_redo(delta, m);
        assert_equal(m, after);
        he_delta_undo(delta, m);
        assert_equal(m, before);
        he_results_clear(&results);
        he_delta_free(delta);
        he_mesh_free(before);
        he_mesh_free(after);
        he_mesh_free(m);
    }
}

static void equal_values_stay_at_vertices(void **state)
{
    (void)state;
    for (size_t i = 0; i < WELDS - 1; i++) {
        he_mesh *m = script_mesh(BESIDE, beside);
        he_column *column = add_column(m, HE_VERTEX, "uv", HE_DOUBLE, HE_INTERPOLATE);
        set_first(column, 4, 21);
        set_first(column, 5, 11);
        he_results results = {0};
        assert_int_equal(script_run(m, welds[i].operation, &results, NULL), HE_OK);
        assert_true(results.number[welds[i].result] == 0);
        assert_null(he_mesh_find_column(m, HE_HALFEDGE, "uv"));
        assert_true(first_of(he_mesh_find_column(m, HE_VERTEX, "uv"), 1) == 11);
        he_results_clear(&results);
        he_mesh_free(m);
    }
}

static void an_attribute_that_corners_have_is_not_changed(void **state)
{
    (void)state;
    static const struct {
        he_type type;
        bool agrees;
        const char *made;
    } rows[] = {{HE_DOUBLE, false, "uv_2"}, {HE_BOOL, false, "uv_2"}, {HE_DOUBLE, true, NULL}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        he_mesh *m = script_mesh(BESIDE, beside);
        const he_column *vertices = add_column(m, HE_VERTEX, "uv", HE_DOUBLE, HE_INTERPOLATE);
        he_column *corners = add_column(m, HE_HALFEDGE, "uv", rows[i].type, HE_INTERPOLATE);
        for (uint32_t h = 0; h < 12 && rows[i].agrees; h++) {
            set_first(corners, h, first_of(vertices, he_origin(m, (he_halfedge){h}).i));
        }
        he_column *wanted = NULL;
        assert_int_equal(he_column_copy(corners, &wanted, NULL), HE_OK);
        script_prepare(m, "edge_weld a=1-2 b=4-5");
        he_halfedge h = he_face_halfedge(m, (he_face){0});
        for (unsigned k = 0; k < 3; k++, h = he_next(m, h)) {
            const he_column *now = he_mesh_find_column(m, HE_HALFEDGE, "uv");
            assert_memory_equal(he_column_value(now, h.i), he_column_value(wanted, h.i),
                                now->row_bytes);
        }
        assert_int_equal(he_mesh_find_column(m, HE_HALFEDGE, "uv_2") != NULL, rows[i].made != NULL);
        if (rows[i].made != NULL) {
            expect_corners(m, rows[i].made, 1, 31, 41, 51);
        }
        he_column_free(wanted);
        he_mesh_free(m);
    }
}

/* The value of a vertex without faces cannot move to corners: if such a value is not the default,
 * the attribute must stay an attribute of vertices. */
static void vertices_without_corners_keep_the_attribute(void **state)
{
    (void)state;
    for (unsigned value = 0; value < 2; value++) {
        he_mesh *m = script_mesh(BESIDE "+", NULL);
        he_column *column = add_column(m, HE_VERTEX, "uv", HE_DOUBLE, HE_COPY);
        memset(he_column_row(column, 6), 0, column->row_bytes);
        set_first(column, 6, value);
        script_prepare(m, "vertex_weld vertices=1,5");
        expect_corners(m, "uv", 1, 31, 41, 51);
        column = (he_column *)he_mesh_find_column(m, HE_VERTEX, "uv");
        assert_int_equal(column != NULL, value != 0);
        assert_true(column == NULL || first_of(column, 6) == value);
        he_mesh_free(m);
    }
}

static void marks_and_defaults_are_no_values(void **state)
{
    (void)state;
    he_mesh *m = script_mesh(BESIDE, beside);
    he_column *mark = add_column(m, HE_VERTEX, "selected", HE_BOOL, HE_COPY);
    memset(he_column_row(mark, 5), 0, 1);
    he_column *column = add_column(m, HE_VERTEX, "note", HE_DOUBLE, HE_DEFAULT);
    memset(he_column_row(column, 4), 0, 2 * column->row_bytes);
    he_results results = {0};
    assert_int_equal(script_run(m, "weld tolerance=0", &results, NULL), HE_OK);
    assert_true(results.number[1] == 0);
    assert_non_null(he_mesh_find_column(m, HE_VERTEX, "selected"));
    assert_true(first_of(he_mesh_find_column(m, HE_VERTEX, "note"), 1) == 11);
    he_results_clear(&results);
    he_mesh_free(m);
}

static void a_weld_without_memory_changes_nothing(void **state)
{
    (void)state;
    for (size_t i = 0; i < WELDS; i++) {
        for (unsigned recorded = 0; recorded < 2; recorded++) {
            failing f = {0};
            while (failing_next(&f)) {
                failing_pause();
                he_mesh *m = script_mesh(BESIDE, beside);
                he_delta *delta = recorded ? he_delta_new() : NULL;
                add_column(m, HE_VERTEX, "uv", HE_DOUBLE, HE_INTERPOLATE);
                add_column(m, HE_VERTEX, "normal", HE_DOUBLE, HE_COPY);
                he_mesh *before = copy_of(m);
                he_mesh_record(m, delta);
                failing_resume();
                he_status status = script_run(m, welds[i].operation, NULL, NULL);
                bool failed = !failing_status(&f, status);
                assert_true(f.n > 1 || failed);
                he_mesh_record(m, NULL);
                if (failed) {
                    assert_equal(m, before);
                }
                he_delta_free(delta);
                he_mesh_free(before);
                he_mesh_free(m);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_that_differ_go_to_corners),
        cmocka_unit_test(equal_values_stay_at_vertices),
        cmocka_unit_test(an_attribute_that_corners_have_is_not_changed),
        cmocka_unit_test(vertices_without_corners_keep_the_attribute),
        cmocka_unit_test(marks_and_defaults_are_no_values),
        cmocka_unit_test(a_weld_without_memory_changes_nothing),
    };
    return cmocka_run_group_tests_name("edit_keep", tests, NULL, NULL);
}
