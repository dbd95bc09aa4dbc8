/* Adding, replacing and removing columns of attributes, and writing attribute values, are edits
 * like others: each is done completely or not at all, and undo restores every bit. */
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "edit/whole/attribute.h"
#include "edit/whole/positions.h"
#include "mesh/delta.h"
#include "tests/failing.h"

static he_column *column_of(const char *name, he_kind domain, uint32_t value)
{
    he_column *column = NULL;
    assert_int_equal(
        he_column_new(&(he_column_schema){name, domain, HE_UINT32, 1, HE_COPY}, &column, NULL),
        HE_OK);
    memcpy(column->fallback, &value, sizeof value);
    return column;
}

static uint32_t value_at(const he_mesh *m, const char *name, he_kind domain, uint32_t row)
{
    uint32_t value;
    const he_column *column = he_mesh_find_column(m, domain, name);
    assert_non_null(column);
    memcpy(&value, he_column_value(column, row), sizeof value);
    return value;
}

static void a_column_takes_the_place_of_its_namesake(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    assert_int_equal(he_attribute_put(m, column_of("a", HE_FACE, 1), NULL), HE_OK);
    assert_int_equal(he_attribute_put(m, column_of("b", HE_FACE, 2), NULL), HE_OK);
    he_mesh *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    assert_int_equal(he_attribute_put(m, column_of("a", HE_FACE, 3), NULL), HE_OK);
    assert_int_equal(he_attribute_put(m, column_of("a", HE_VERTEX, 4), NULL), HE_OK);
    assert_int_equal(he_attribute_drop(m, he_mesh_find_column(m, HE_FACE, "b"), NULL), HE_OK);
    he_mesh_record(m, NULL);
    assert_int_equal(value_at(m, "a", HE_FACE, 1), 3);
    assert_int_equal(value_at(m, "a", HE_VERTEX, 3), 4);
    assert_null(he_mesh_find_column(m, HE_FACE, "b"));
    he_mesh *after = copy_of(m);
    he_delta_undo(delta, m);
    assert_true(he_mesh_equal(m, before));
    he_delta_redo(delta, m);
    assert_true(he_mesh_equal(m, after));
    he_delta_free(delta);
    he_mesh_free(after);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void what_is_refused_writes_nothing(void **state)
{
    (void)state;
    he_mesh *m = fixture_mesh("012,023");
    assert_int_equal(he_attribute_put(m, column_of("a", HE_VERTEX, 1), NULL), HE_OK);
    const he_column *a = he_mesh_find_column(m, HE_VERTEX, "a");
    he_mesh *before = copy_of(m);
    const uint32_t values[2] = {7, 8};
    const struct {
        uint32_t ids[2];
        he_status status;
    } cases[] = {{{0, 0}, HE_REPEATED_ELEMENT}, {{0, 4}, HE_NO_SUCH_ELEMENT}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(he_attribute_write(m, a, cases[i].ids, 2, values, false, NULL),
                         cases[i].status);
        assert_true(he_mesh_equal(m, before));
    }
    assert_int_equal(he_attribute_write(m, a, (uint32_t[]){3, 1}, 2, values, false, NULL), HE_OK);
    assert_int_equal(value_at(m, "a", HE_VERTEX, 3), 7);
    assert_int_equal(value_at(m, "a", HE_VERTEX, 1), 8);
    assert_int_equal(he_attribute_write(m, a, NULL, 4, values, true, NULL), HE_OK);
    assert_int_equal(value_at(m, "a", HE_VERTEX, 2), 7);
    he_mesh_free(before);
    he_mesh_free(m);
}

static he_status put_and_write(he_mesh *m, he_column **takes)
{
    const uint32_t values[4] = {5, 6, 7, 8};
    he_status status = he_attribute_put(m, *takes, NULL);
    if (status == HE_OK) {
        *takes = NULL;
        const he_column *column = he_mesh_find_column(m, HE_VERTEX, "a");
        status = he_attribute_write(m, column, NULL, 4, values, false, NULL);
    }
    if (status == HE_OK) {
        status = he_attribute_drop(m, he_mesh_find_column(m, HE_FACE, "b"), NULL);
    }
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    for (int recorded = 0; recorded < 2; recorded++) {
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_mesh *m = fixture_mesh("012,023");
            he_column *takes = column_of("a", HE_VERTEX, 3);
            assert_int_equal(he_attribute_put(m, column_of("a", HE_VERTEX, 1), NULL), HE_OK);
            assert_int_equal(he_attribute_put(m, column_of("b", HE_FACE, 2), NULL), HE_OK);
            he_mesh *before = copy_of(m);
            he_delta *delta = he_delta_new();
            he_savepoint mark = {0};
            if (recorded) {
                he_mesh_record(m, delta);
                mark = he_delta_mark(m);
            }
            failing_resume();
            he_status status = put_and_write(m, &takes);
            if (!failing_status(&f, status) && (recorded || takes != NULL)) {
                if (recorded) {
                    he_delta_rollback(m, mark);
                }
                assert_true(he_mesh_equal(m, before));
            }
            he_mesh_record(m, NULL);
            he_column_free(takes);
            he_delta_free(delta);
            he_mesh_free(before);
            he_mesh_free(m);
        }
    }
}

static void positions_are_written_whole_or_not_at_all(void **state)
{
    (void)state;
    const he_vec3 points[] = {{0, -1, 0.5}, {1, -1, 0.5}, {2, -1, 0.5}, {3, -1, 0.5}};
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_mesh *m = fixture_mesh("012,023");
        he_mesh *before = copy_of(m);
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        he_savepoint mark = he_delta_mark(m);
        failing_resume();
        if (failing_status(&f, he_positions_write(m, NULL, 4, points, false, NULL))) {
            for (uint32_t v = 0; v < 4; v++) {
                const he_vec3 at = he_position(m, (he_vertex){v});
                assert_memory_equal(&at, &points[v], sizeof at);
            }
            assert_int_equal(he_positions_write(m, NULL, 3, points, false, NULL), HE_BAD_VALUE);
            he_delta_rollback(m, mark);
        }
        assert_true(he_mesh_equal(m, before));
        he_mesh_record(m, NULL);
        he_delta_free(delta);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_takes_the_place_of_its_namesake),
        cmocka_unit_test(what_is_refused_writes_nothing),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(positions_are_written_whole_or_not_at_all),
    };
    return cmocka_run_group_tests_name("attribute", tests, NULL, NULL);
}
