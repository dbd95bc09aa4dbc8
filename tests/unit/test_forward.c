/* A store keeps an old snapshot of a mesh and a log of the later edits. he_delta_forward applies
 * the recorded changes (delta) of an edit to the snapshot, to which the edit was never applied.
 * After every entry of the log the result must equal the mesh that was edited, and undo and redo
 * must work from there. */
#include "tests/unit/edit_log.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"

#include "mesh/delta.h"
#include "mesh/write.h"
#include "tests/seed.h"
#include "tests/failing.h"

enum { ENTRIES = 60 };

/* Makes a random log and undoes all of it. Each delta then holds the values after its edit, like a
 * delta that was loaded from a file. */
static edit_log *undone_log(md_random *random)
{
    edit_log *log = edit_log_random(random, ENTRIES);
    while (log->done_count > 0) {
        edit_log_undo(log);
    }
    return log;
}

/* Applies entry i of the log to the mesh, as a store does when it loads the mesh: an edit that
 * occurs for the first time is applied by he_delta_forward; later entries undo or redo the edit. */
static he_status apply(const edit_log *log, size_t i, bool *seen, he_mesh *m)
{
    const edit_log_entry *e = &log->entries[i];
    uint32_t issued[HE_KIND_COUNT];
    if (e->undo) {
        he_delta_undo(log->steps[e->step], m);
    } else if (seen[e->step]) {
        he_delta_redo(log->steps[e->step], m);
    } else {
        edit_log_marks(e->after, issued);
        he_status status = he_delta_forward(log->steps[e->step], m, issued, NULL, NULL);
        seen[e->step] = status == HE_OK;
        return status;
    }
    return HE_OK;
}

static void every_entry_of_a_log_can_be_reached_from_its_beginning(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        edit_log *log = undone_log(&random);
        bool seen[EDIT_LOG_MOST] = {false};
        he_mesh *m = copy_of(log->entries[0].after);
        for (size_t i = 1; i < log->count; i++) {
            assert_int_equal(apply(log, i, seen, m), HE_OK);
            assert_true(he_mesh_equal(m, log->entries[i].after));
            assert_valid(m);
        }
        he_mesh_free(m);
        edit_log_free(log);
    }
}

static void without_memory_the_mesh_stays_as_it_was(void **state)
{
    (void)state;
    md_random random = {11};
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        md_random same = random;
        edit_log *log = undone_log(&same);
        bool seen[EDIT_LOG_MOST] = {false};
        he_mesh *m = copy_of(log->entries[0].after);
        failing_resume();
        he_status status = HE_OK;
        size_t i = 1;
        for (; i < log->count && status == HE_OK; i++) {
            status = apply(log, i, seen, m);
        }
        bool failed = !failing_status(&f, status);
        assert_true(he_mesh_equal(m, log->entries[status == HE_OK ? i - 1 : i - 2].after));
        for (i -= failed; i < log->count; i++) {
            assert_int_equal(apply(log, i, seen, m), HE_OK);
            assert_true(he_mesh_equal(m, log->entries[i].after));
        }
        he_mesh_free(m);
        edit_log_free(log);
    }
}

/* Runs `operation` on the mesh, and returns the delta that records its changes. */
static he_delta *delta_of(he_mesh *m, const char *operation)
{
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    script_prepare(m, operation);
    he_mesh_record(m, NULL);
    return delta;
}

static void expect_refusal(he_delta *delta, he_mesh *m, const he_mesh *after, size_t first)
{
    he_mesh *before = copy_of(m);
    he_error err = {.status = HE_OK};
    uint32_t issued[HE_KIND_COUNT];
    size_t refused = SIZE_MAX;
    edit_log_marks(after, issued);
    assert_int_equal(he_delta_forward(delta, m, issued, &refused, &err), HE_CORRUPT);
    assert_int_equal(err.status, HE_CORRUPT);
    assert_int_equal(refused, first);
    assert_true(he_mesh_equal(m, before));
    he_mesh_free(before);
}

static void another_mesh_than_the_edit_was_made_on_is_refused(void **state)
{
    (void)state;
    he_mesh *m = script_mesh("012,023", NULL), *other = script_mesh("012,023", NULL);
    script_add_columns(m);
    he_delta *values = delta_of(m, "edge_split edge=0-2 t=0.5");
    size_t first = 0; /* number of records before the first one that changes an attribute value */
    while (values->records[first].column < HE_COL_ATTRIBUTE) {
        first++;
    }
    expect_refusal(values, other, m, first);
    he_mesh_free(m);
    he_delta_free(values);

    m = script_mesh("012,023", NULL);
    he_delta *moved = delta_of(m, "vertex_move vertex=1 by=1,0,0");
    script_prepare(other, "vertex_move vertex=2 by=1,0,0");
    uint32_t issued[HE_KIND_COUNT];
    edit_log_marks(m, issued);
    assert_int_equal(he_delta_forward(moved, other, issued, NULL, NULL), HE_OK);
    /* vertex 1 has the position already that the delta would give it, so the delta does not fit
     * this mesh */
    expect_refusal(moved, other, m, 0);
    he_delta_free(moved);
    he_mesh_free(m);
    he_mesh_free(other);
}

static void no_attribute_is_added_over_a_taken_slot_or_name(void **state)
{
    (void)state;
    md_random random = {3}, same = random;
    he_mesh *m = script_mesh("012,023", NULL), *other = script_mesh("012,023", NULL);
    he_delta *delta = he_delta_new();
    he_mesh_record(m, delta);
    edit_log_add_column(m, &random, 1);
    he_mesh_record(m, NULL);
    he_delta_undo(delta, m);
    /* another column has the index in the table of columns that the delta would use */
    edit_log_add_column(other, &same, 1);
    expect_refusal(delta, other, m, 0);
    md_random another = {3};
    he_mesh_free(other);
    other = script_mesh("012,023", NULL);
    edit_log_add_column(other, &another, 2);
    another = (md_random){3};
    edit_log_add_column(other, &another, 1);
    /* the index that the delta would use is free, but another column has the name of the delta's
     * column */
    assert_int_equal(he_mesh_drop_column(other, 0, NULL), HE_OK);
    expect_refusal(delta, other, m, 0);
    he_delta_free(delta);
    he_mesh_free(m);
    he_mesh_free(other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_entry_of_a_log_can_be_reached_from_its_beginning),
        cmocka_unit_test(without_memory_the_mesh_stays_as_it_was),
        cmocka_unit_test(another_mesh_than_the_edit_was_made_on_is_refused),
        cmocka_unit_test(no_attribute_is_added_over_a_taken_slot_or_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
