/* A copy of a mesh is moved forward and back along a log of edits. At each point of the log, the
 * copy must equal the mesh at that point: in its links, in its positions, in columns that were
 * added, removed and restored, and in mesh data that was replaced as a whole. */
#include "tests/unit/edit_log.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"

#include "mesh/replay.h"
#include "tests/seed.h"
#include "tests/failing.h"

#include <inttypes.h>
#include <time.h>

enum { ENTRIES = 60 };

/* Moves the copy from its state after entry `at` of the log by one entry: back to the state after
 * the entry before it if `back` is true, otherwise forward to the state after the next entry. */
static he_status cross(const edit_log *h, he_replay *replay, size_t at, bool back)
{
    size_t crossed = back ? at : at + 1;
    const edit_log_entry *e = &h->entries[crossed];
    const he_mesh *there = h->entries[back ? at - 1 : at + 1].after;
    uint32_t issued[HE_KIND_COUNT];
    edit_log_marks(there, issued);
    he_crossing crossing = {.key = e->step,
                            .delta = h->steps[e->step],
                            .undo = e->undo != back,
                            .held = back && h->applied[e->step] == crossed,
                            .issued = issued};
    return he_replay_cross(replay, &crossing, NULL);
}

static void every_point_of_a_log_can_be_reached(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        edit_log *h = edit_log_random(&random, ENTRIES);
        he_replay *replay;
        assert_int_equal(he_replay_new(h->mesh, &replay, NULL), HE_OK);
        size_t at = h->count - 1;
        /* The copy moves to the beginning of the log, then back and forth, and finally to the
         * end. */
        for (size_t leg = 0; leg < 8; leg++) {
            size_t to = leg == 0   ? 0
                        : leg == 7 ? h->count - 1
                                   : md_below(&random, (uint32_t)h->count);
            while (at != to) {
                bool back = at > to;
                assert_int_equal(cross(h, replay, at, back), HE_OK);
                at = back ? at - 1 : at + 1;
                assert_true(he_mesh_equal(he_replay_mesh(replay), h->entries[at].after));
                assert_valid(he_replay_mesh(replay));
            }
        }
        assert_true(he_replay_bytes(replay) >= he_mesh_bytes(he_replay_mesh(replay)));
        he_replay_free(replay);
        edit_log_free(h);
    }
}

/* A new column belongs to the mesh alone, so the delta of the edit that adds the column does not
 * have the column's values: a copy that was made before the edit cannot be moved forward across the
 * edit. */
static void a_column_that_only_the_mesh_holds_cannot_be_replayed(void **state)
{
    (void)state;
    edit_log *h = edit_log_new(script_mesh("012,023", NULL));
    he_replay *replay;
    md_random random = {1};
    assert_int_equal(he_replay_new(h->mesh, &replay, NULL), HE_OK);
    he_delta *delta = h->steps[h->step_count] = he_delta_new();
    he_mesh_record(h->mesh, delta);
    edit_log_add_column(h->mesh, &random, 0);
    he_mesh_record(h->mesh, NULL);
    edit_log_note(h, h->step_count++, false);
    assert_int_equal(cross(h, replay, 0, false), HE_UNSUPPORTED);
    assert_true(he_mesh_equal(he_replay_mesh(replay), h->entries[0].after));
    he_replay_free(replay);
    edit_log_free(h);
}

static void a_replay_without_memory_is_refused_and_keeps_the_mesh(void **state)
{
    (void)state;
    md_random random = {7};
    edit_log *h = edit_log_random(&random, ENTRIES);
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        he_replay *replay = NULL;
        failing_resume();
        he_status status = he_replay_new(h->mesh, &replay, NULL);
        for (size_t at = h->count - 1; at > 0 && status == HE_OK; at--) {
            status = cross(h, replay, at, true);
        }
        for (size_t at = 0; at + 1 < h->count && status == HE_OK; at++) {
            status = cross(h, replay, at, false);
        }
        if (failing_status(&f, status)) {
            assert_true(he_mesh_equal(he_replay_mesh(replay), h->mesh));
        }
        he_replay_free(replay);
    }
    assert_true(he_mesh_equal(h->mesh, h->entries[h->count - 1].after));
    edit_log_free(h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_point_of_a_log_can_be_reached),
        cmocka_unit_test(a_column_that_only_the_mesh_holds_cannot_be_replayed),
        cmocka_unit_test(a_replay_without_memory_is_refused_and_keeps_the_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
