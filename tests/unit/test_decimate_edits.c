/* Decimation as an edit: undo, recording in a delta, failing allocations, and cancelling. */
#include "tests/unit/dense.h"

#include "algo/progressive.h"
#include "mesh/write.h"
#include "tests/failing.h"

#include <math.h>
#include <stdio.h>

/* The request asks to remove nearly all faces, but the error limit of 0 allows no collapse: the
 * delta must stay empty. */
static void nothing_is_recorded_where_no_edge_may_go(void **state)
{
    (void)state;
    he_mesh *m = dense_torus(104), *before = dense_copy(m);
    he_delta *delta = he_delta_new();
    assert_non_null(delta);
    assert_true(he_mesh_faces(m) > HE_DECIMATE_RECORDED);
    he_mesh_record(m, delta);
    he_decimated done = dense_decimate(m, 0, 0);
    assert_int_equal(done.stop, HE_STOP_ERROR);
    assert_int_equal(delta->count, 0);
    assert_true(he_mesh_equal(m, before));
    he_mesh_record(m, NULL);
    he_delta_free(delta);
    he_mesh_free(before);
    he_mesh_free(m);
}

/* A small decimation is recorded change by change, a large one as a replacement of the whole mesh;
 * undo must work in both cases. */
static const struct {
    uint32_t side, faces;
    bool replaced;
} ways[] = {{20, 200, false}, {110, 3000, true}};

static void it_is_undone_and_done_again(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *m = dense_torus(ways[i].side), *before = dense_copy(m);
        he_delta *delta = he_delta_new();
        he_mesh_record(m, delta);
        dense_decimate(m, ways[i].faces, INFINITY);
        he_mesh_record(m, NULL);
        he_mesh *after = dense_copy(m);
        he_changes changes;
        assert_int_equal(he_changes_find(m, delta, 0, delta->count, false, &changes, NULL), HE_OK);
        assert_int_equal(changes.replaced, ways[i].replaced);
        assert_int_equal(changes.created[HE_VERTEX].count, 0);
        if (!changes.replaced) {
            assert_int_equal(changes.deleted[HE_FACE].count,
                             he_mesh_faces(before) - he_mesh_faces(m));
            assert_int_equal(changes.merged[HE_VERTEX].count,
                             2 * (he_mesh_vertices(before) - he_mesh_vertices(m)));
        }
        he_changes_clear(&changes);
        he_delta_undo(delta, m);
        assert_true(he_mesh_equal(m, before));
        he_delta_redo(delta, m);
        assert_true(he_mesh_equal(m, after));
        he_delta_free(delta);
        he_mesh_free(after);
        he_mesh_free(before);
        he_mesh_free(m);
    }
}

static void both_ways_and_each_time_it_is_the_same(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *a = dense_torus(ways[i].side), *b = dense_torus(ways[i].side);
        he_delta *delta = he_delta_new();
        he_mesh_record(b, delta);
        dense_decimate(a, ways[i].faces, INFINITY);
        dense_decimate(b, ways[i].faces, INFINITY);
        assert_true(he_mesh_equal(a, b));
        he_mesh_free(b);
        he_delta_free(delta);
        he_mesh_free(a);
    }
}

static void add_columns(he_mesh *m, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        char name[16];
        he_column *column = NULL;
        snprintf(name, sizeof name, "value%u", i);
        assert_int_equal(
            he_column_new(&(he_column_schema){name, HE_VERTEX, HE_FLOAT, 1, HE_INTERPOLATE},
                          &column, NULL),
            HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
        size_t slot = he_mesh_column_slot(m, he_mesh_find_column(m, HE_VERTEX, name));
        assert_int_equal(he_reserve_values(m, slot, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
        for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
            float value = (float)(v % 7 + i);
            he_set_attribute(m, slot, v, &value);
        }
    }
}

/* Decimates a mesh that has `columns` attributes, while a delta records the changes. Sets `room` to
 * the number of records for which the delta has memory, and `used` to the number of records in the
 * delta. */
static void record_with(unsigned columns, size_t *room, size_t *used)
{
    he_mesh *m = dense_torus(20);
    he_delta *delta = he_delta_new();
    add_columns(m, columns);
    he_mesh_record(m, delta);
    dense_decimate(m, 200, INFINITY);
    he_mesh_record(m, NULL);
    *room = delta->capacity;
    *used = delta->count;
    he_delta_free(delta);
    he_mesh_free(m);
}

static void a_record_grows_as_columns_do(void **state)
{
    (void)state;
    size_t room[3], used[3];
    static const unsigned columns[3] = {0, 8, 64};
    for (size_t i = 0; i < 3; i++) {
        record_with(columns[i], &room[i], &used[i]);
        printf("note: %u columns: %zu records used of %zu\n", columns[i], used[i], room[i]);
    }
    assert_true(used[1] > used[0]);
    assert_true(room[2] - room[0] <= 9 * (room[1] - room[0]));
    assert_true(room[2] <= 2 * used[2]);
}

static void memory_may_end_anywhere(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *first = dense_torus(ways[i].side);
        failing f = {0};
        while (failing_next(&f)) {
            failing_pause();
            he_mesh *m = dense_copy(first);
            failing_resume();
            he_decimate_options options = {ways[i].faces, INFINITY, 100};
            if (!failing_status(&f, he_decimate(m, &options, NULL, NULL))) {
                assert_true(he_mesh_equal(m, first));
            }
            he_mesh_free(m);
            assert_true(f.n < 200);
        }
        he_mesh_free(first);
    }
}

static void a_progressive_mesh_may_run_out_of_memory(void **state)
{
    (void)state;
    he_mesh *first = dense_torus(20);
    failing f = {0};
    while (failing_next(&f)) {
        he_progressive made = {0};
        const he_decimate_options options = {0, INFINITY, 100};
        bool failed = !failing_status(&f, he_progressive_new(first, &options, NULL, &made, NULL));
        assert_true(failed ? made.base == NULL : made.count > 100);
        if (!failed) {
            fixture_check(made.base);
            assert_int_equal(he_mesh_vertices(made.base) + made.count, 400);
        }
        he_progressive_clear(&made);
        assert_true(f.n < 200);
    }
    he_mesh_free(first);
}

static bool give_up(void *context, const char *phase, double done)
{
    long *left = context;
    (void)phase;
    assert_true(done >= 0 && done <= 1);
    return --*left > 0;
}

static void it_can_be_given_up(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        he_mesh *first = dense_torus(ways[i].side);
        bool cancelled = true;
        long told = 0;
        for (long n = 1; cancelled; n++) {
            he_mesh *m = dense_copy(first);
            he_progress progress;
            long left = n;
            he_progress_init(&progress, give_up, &left);
            he_mesh_set_progress(m, &progress);
            he_decimate_options options = {ways[i].faces, INFINITY, 100};
            he_status status = he_decimate(m, &options, NULL, NULL);
            he_mesh_set_progress(m, NULL);
            cancelled = status != HE_OK;
            if (cancelled) {
                assert_int_equal(status, HE_CANCELLED);
                assert_true(he_mesh_equal(m, first));
            }
            told = n;
            he_mesh_free(m);
        }
        assert_true(told > 3);
        he_mesh_free(first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_recorded_where_no_edge_may_go),
        cmocka_unit_test(it_is_undone_and_done_again),
        cmocka_unit_test(both_ways_and_each_time_it_is_the_same),
        cmocka_unit_test(a_record_grows_as_columns_do),
        cmocka_unit_test(memory_may_end_anywhere),
        cmocka_unit_test(a_progressive_mesh_may_run_out_of_memory),
        cmocka_unit_test(it_can_be_given_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
