/* Writing the positions of many vertices at once: the delta then has one record with all positions,
 * which undo, redo, the stored form and the list of changes treat like records of single words. */
#include "unit/dense.h"
#include "unit/edit_log.h"
#include "unit/edit_script.h"
#include "unit/fixture.h"

#include "edit/whole/positions.h"
#include "mesh/write.h"
#include "stored/stored.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <math.h>

enum { SIDE = 130 }; /* a grid of this side has more vertices than are listed one by one */

static he_column *points_of(const he_mesh *m)
{
    he_column present, *copy;
    he_mesh_position_column(m, &present);
    assert_int_equal(he_column_copy(&present, &copy, NULL), HE_OK);
    return copy;
}

static he_vec3 *point(const he_column *column, uint32_t v)
{
    return (he_vec3 *)(void *)he_column_row((he_column *)(uintptr_t)column, v);
}

/* Makes a column in which every vertex is moved up, with a vertex deleted and another added. */
static he_mesh *moved_grid(he_column **out)
{
    he_mesh *m = dense_grid(SIDE, dense_waves, 1);
    script_prepare(m,
                   "vertex_add position=9,9,9; vertex_add position=8,8,8; vertex_delete vertex=5");
    *out = points_of(m);
    for (uint32_t v = 0; v < (*out)->rows; v++) {
        point(*out, v)->z += 1;
    }
    return m;
}

static void most_positions_are_one_record(void **state)
{
    (void)state;
    he_column *points;
    he_mesh *m = moved_grid(&points), *before = copy_of(m);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    assert_int_equal(he_positions_put(m, points, NULL), HE_OK);
    he_mesh_record(m, NULL);
    assert_int_equal(delta->count, 1);
    assert_int_equal(delta->records[0].column, HE_COL_POSITIONS);
    assert_true(he_delta_bytes(delta) < 26 * (size_t)he_mesh_issued(m, HE_VERTEX));
    assert_valid(m); /* the deleted vertex is still at the origin */
    he_mesh *after = copy_of(m);
    for (int turn = 0; turn < 2; turn++) {
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal(m, before));
        he_delta_redo(delta, m);
        assert_true(he_mesh_equal(m, after));
    }
    he_changes changes;
    assert_int_equal(he_changes_find(m, delta, 0, 1, false, &changes, NULL), HE_OK);
    assert_int_equal(changes.modified[HE_VERTEX].count, he_mesh_vertices(m));
    he_changes_clear(&changes);
    /* the points of he_positions_write give the same mesh, without a delta too */
    he_column *again = points_of(after);
    assert_int_equal(he_positions_write(before, NULL, again->rows, point(again, 0), false, NULL),
                     HE_OK);
    assert_true(he_mesh_equal(before, after));
    he_column_free(again);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(after);
    he_mesh_free(m);
}

static void a_few_positions_are_records_of_words(void **state)
{
    (void)state;
    he_column *points;
    he_mesh *m = moved_grid(&points), *before = copy_of(m);
    he_column *few = points_of(m);
    point(few, 7)->x = 0.5;
    point(few, 9)->y = 0.25;
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    assert_int_equal(he_positions_put(m, few, NULL), HE_OK);
    he_mesh_record(m, NULL);
    assert_true(delta->count >= 2 && delta->count <= 4 && delta->object_count == 0);
    assert_true(he_position(m, (he_vertex){9}).y == 0.25);
    he_delta_undo(delta, m);
    assert_true(he_mesh_equal(m, before));
    he_column_free(points);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* A record of a word takes 16 bytes, and the record of all positions 24 bytes a vertex. */
static void the_smaller_record_is_kept(void **state)
{
    (void)state;
    static const double heights[] = {1, 0.1}; /* these differ from 0 in one and in two words */
    for (unsigned i = 0; i < 2; i++) {
        he_mesh *m = dense_grid(SIDE, NULL, 1), *before = copy_of(m);
        he_column *points = points_of(m);
        const size_t vertices = he_mesh_issued(m, HE_VERTEX);
        for (uint32_t v = 0; v < vertices; v++) {
            assert_true(point(points, v)->z == 0);
            point(points, v)->z = heights[i];
        }
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        assert_int_equal(he_positions_put(m, points, NULL), HE_OK);
        he_mesh_record(m, NULL);
        assert_int_equal(delta->count, i == 0 ? vertices : 1);
        assert_int_equal(delta->object_count, i);
        assert_true(he_delta_bytes(delta) < (i == 0 ? 17 : 26) * vertices);
        assert_true(he_position(m, (he_vertex){77}).z == heights[i]);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal(m, before));
        he_delta_free(delta);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void refused_positions_leave_the_mesh_as_it_was(void **state)
{
    (void)state;
    he_column *points;
    he_error err = {0};
    he_mesh *m = moved_grid(&points);
    script_prepare(m, "mark locked vertex=17");
    he_mesh *before = copy_of(m);
    assert_int_equal(he_positions_put(m, points, &err), HE_LOCKED_ELEMENT);
    assert_int_equal(err.id, 17);
    *point(points, 17) = he_position(m, (he_vertex){17});
    point(points, 23)->y = NAN;
    assert_int_equal(he_positions_put(m, points, &err), HE_NOT_FINITE);
    assert_int_equal(err.id, 23);
    point(points, 23)->y = 2;
    points->rows--;
    assert_int_equal(he_positions_put(m, points, &err), HE_BAD_VALUE);
    points->rows++;
    assert_true(he_mesh_equal(m, before));
    assert_int_equal(he_positions_put(m, points, &err), HE_OK);
    assert_valid(m);
    he_mesh_free(before);
    he_mesh_free(m);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    for (int put = 0; put < 2; put++) {
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_column *points;
            he_mesh *m = moved_grid(&points), *before = copy_of(m);
            he_delta *delta = he_delta_new();
            he_mesh_record(m, delta);
            he_savepoint mark = he_delta_mark(m);
            failing_resume();
            he_status status =
                put ? he_positions_put(m, points, NULL)
                    : he_positions_write(m, NULL, points->rows, point(points, 0), false, NULL);
            bool done = failing_status(&f, status);
            if (done) {
                assert_int_equal(delta->count, 1);
                he_delta_rollback(m, mark);
            }
            assert_true(he_mesh_equal(m, before));
            if (!done || !put) {
                he_column_free(points);
            }
            he_mesh_record(m, NULL);
            he_delta_free(delta);
            he_mesh_free(before);
            he_mesh_free(m);
        }
    }
}

static bool lists(const he_ids *list, uint32_t id)
{
    size_t i = 0;
    while (i < list->count && list->ids[i] != id) {
        i++;
    }
    return i < list->count;
}

/* Returns true if an attribute that both meshes have differs at a vertex. */
static bool attributes_differ(const he_mesh *a, const he_mesh *b, uint32_t v)
{
    bool differ = false;
    for (size_t i = 0; i < he_mesh_columns(a) && !differ; i++) {
        const he_column *one = he_mesh_column(a, i);
        const he_column *other = one == NULL || one->domain != HE_VERTEX
                                     ? NULL
                                     : he_mesh_find_column(b, HE_VERTEX, one->name);
        differ = other != NULL &&
                 memcmp(he_column_value(one, v), he_column_value(other, v), one->row_bytes) != 0;
    }
    return differ;
}

/* Requires that the list of modified vertices has those, and only those, that exist in both meshes
 * and differ. */
static void compare_changes(const he_mesh *from, const he_mesh *to, const he_changes *changes)
{
    for (uint32_t v = 0; v < he_mesh_issued(to, HE_VERTEX); v++) {
        const he_vertex at = {v};
        if (v >= he_mesh_issued(from, HE_VERTEX) || !he_mesh_is_live(from, HE_VERTEX, v) ||
            !he_mesh_is_live(to, HE_VERTEX, v)) {
            assert_false(lists(&changes->modified[HE_VERTEX], v));
            continue;
        }
        const he_vec3 a = he_position(from, at), b = he_position(to, at);
        const bool differs = memcmp((const char *)&a, (const char *)&b, sizeof a) != 0 ||
                             he_vertex_halfedge(from, at).i != he_vertex_halfedge(to, at).i;
        if (differs || !attributes_differ(from, to, v)) {
            assert_int_equal(lists(&changes->modified[HE_VERTEX], v), differs);
        }
    }
}

static bool is_repeated(const edit_log *log, size_t from, size_t entry)
{
    size_t i = from;
    while (i < entry && log->entries[i].step != log->entries[entry].step) {
        i++;
    }
    return i < entry;
}

static void changes_equal_the_differences(void **state)
{
    (void)state;
    enum { ENTRIES = 40, MOST = 6 };
    md_random random = {seed_of_run()};
    unsigned compared = 0;
    for (int round = 0; round < 60; round++) {
        edit_log *log = edit_log_random(&random, ENTRIES);
        he_change_part parts[MOST];
        const size_t last = log->count - 1;
        size_t count = 0;
        for (size_t back = 0; back < MOST && back < last; back++) {
            const edit_log_entry *e = &log->entries[last - back];
            bool repeats = false;
            for (size_t i = last - back; i <= last; i++) {
                repeats |= is_repeated(log, last - back, i);
            }
            if (repeats) {
                break;
            }
            const he_delta *delta = log->steps[e->step];
            memmove(parts + 1, parts, count * sizeof *parts);
            parts[0] = (he_change_part){delta, 0, delta->count, e->undo};
            count++;
            he_changes changes;
            assert_int_equal(he_changes_sum(log->mesh, parts, count, &changes, NULL), HE_OK);
            if (!changes.replaced) {
                compare_changes(log->entries[last - back - 1].after, log->mesh, &changes);
                compared++;
            }
            he_changes_clear(&changes);
        }
        edit_log_free(log);
    }
    print_message("note: compared %u sums of changes\n", compared);
    assert_true(compared > 60);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(most_positions_are_one_record),
        cmocka_unit_test(a_few_positions_are_records_of_words),
        cmocka_unit_test(the_smaller_record_is_kept),
        cmocka_unit_test(refused_positions_leave_the_mesh_as_it_was),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(changes_equal_the_differences),
    };
    return cmocka_run_group_tests_name("positions", tests, NULL, NULL);
}
