/* A copy that travels along a log of edits is, at every point of it, the mesh as it was then:
 * links, positions, columns that came, went and came back, whole contents that were replaced. */
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"

#include "mesh/compact.h"
#include "mesh/replay.h"
#include "mesh/write.h"
#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <time.h>

enum { ENTRIES = 60, LOG = 400 };

/* The log of one mesh, as a server would keep it, with the mesh as it was after each entry. */
typedef struct entry {
    size_t step;
    bool undo;
    he_mesh *after;
} entry;

typedef struct history {
    he_mesh *mesh;
    he_delta *steps[LOG];
    size_t applied[LOG]; /* the entry that crossed the step last */
    size_t step_count;
    size_t done[LOG], undone[LOG]; /* the stacks */
    size_t done_count, undone_count;
    entry entries[LOG + 1]; /* the first is the beginning */
    size_t count;
} history;

static history *history_new(he_mesh *mesh)
{
    history *h = calloc(1, sizeof *h);
    assert_non_null(h);
    h->mesh = mesh;
    h->entries[0].after = copy_of(mesh);
    h->count = 1;
    return h;
}

static void history_free(history *h)
{
    for (size_t i = 0; i < h->step_count; i++) {
        he_delta_free(h->steps[i]);
    }
    for (size_t i = 0; i < h->count; i++) {
        he_mesh_free(h->entries[i].after);
    }
    he_mesh_free(h->mesh);
    free(h);
}

static void note_entry(history *h, size_t step, bool undo)
{
    h->applied[step] = h->count;
    h->entries[h->count++] = (entry){step, undo, copy_of(h->mesh)};
}

static void add_column(he_mesh *m, md_random *random, unsigned serial)
{
    static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE, HE_MESH_KIND};
    he_kind domain = domains[md_below(random, 5)];
    char name[16];
    he_column *column;
    snprintf(name, sizeof name, "late%u", serial);
    assert_int_equal(
        he_column_new(name, domain, HE_FLOAT, 3, (he_rule)md_below(random, 3), &column, NULL),
        HE_OK);
    column->fallback[2] = (unsigned char)md_below(random, 256);
    size_t rows = domain == HE_MESH_KIND ? 1 : he_mesh_issued(m, domain);
    assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static bool random_column(const he_mesh *m, md_random *random, size_t *slot)
{
    for (int tries = 0; tries < 10 && he_mesh_columns(m) > 0; tries++) {
        *slot = md_below(random, (uint32_t)he_mesh_columns(m));
        if (he_mesh_column(m, *slot) != NULL) {
            return true;
        }
    }
    return false;
}

static void write_values(he_mesh *m, md_random *random, size_t slot)
{
    const he_column *column = he_mesh_column(m, slot);
    he_kind domain = column->domain;
    uint32_t rows = domain == HE_MESH_KIND ? 1 : he_mesh_issued(m, domain);
    assert_int_equal(he_reserve(m, (he_need){.attributes = 4}, NULL), HE_OK);
    for (int i = 0; i < 4; i++) {
        uint32_t row = md_below(random, rows);
        unsigned char value[HE_COLUMN_ROW_BYTES] = {(unsigned char)md_below(random, 2), 0, 1};
        if (domain == HE_MESH_KIND || he_mesh_is_live(m, domain, row)) {
            he_set_attribute(m, slot, row, value);
        }
    }
}

/* One random change, recorded. */
static void change(he_mesh *m, md_random *random, unsigned serial)
{
    char text[96];
    size_t slot;
    switch (md_below(random, 8)) {
    case 0:
        add_column(m, random, serial);
        return;
    case 1:
        if (random_column(m, random, &slot)) {
            assert_int_equal(he_mesh_drop_column(m, slot, NULL), HE_OK);
        }
        return;
    case 2:
        if (random_column(m, random, &slot)) {
            write_values(m, random, slot);
        }
        return;
    case 3:
        if (md_below(random, 3) == 0) {
            assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
        }
        return;
    case 4:
        snprintf(text, sizeof text, "vertex_add position=%u,1,%u", serial, md_below(random, 9));
        break;
    case 5:
        snprintf(text, sizeof text, "face_delete face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    case 6:
        snprintf(text, sizeof text, "face_poke face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    default:
        snprintf(text, sizeof text, "edge_split edge=#%u t=0.25",
                 md_below(random, he_mesh_issued(m, HE_EDGE)));
        break;
    }
    /* An element that is gone refuses, and changes nothing. */
    (void)script_run(m, text, NULL, NULL);
}

static void edit(history *h, md_random *random)
{
    he_delta *delta = he_delta_new();
    he_mesh_record(h->mesh, delta);
    unsigned changes = 1 + md_below(random, 3);
    for (unsigned i = 0; i < changes; i++) {
        change(h->mesh, random, (unsigned)(h->count * 10 + i));
    }
    he_mesh_record(h->mesh, NULL);
    h->steps[h->step_count] = delta;
    h->done[h->done_count++] = h->step_count;
    h->undone_count = 0;
    note_entry(h, h->step_count++, false);
}

static void step_history(history *h, md_random *random)
{
    unsigned what = md_below(random, 4);
    if (what == 0 && h->done_count > 0) {
        size_t step = h->done[--h->done_count];
        h->undone[h->undone_count++] = step;
        he_delta_undo(h->steps[step], h->mesh);
        note_entry(h, step, true);
    } else if (what == 1 && h->undone_count > 0) {
        size_t step = h->undone[--h->undone_count];
        h->done[h->done_count++] = step;
        he_delta_redo(h->steps[step], h->mesh);
        note_entry(h, step, false);
    } else {
        edit(h, random);
    }
}

static history *random_history(md_random *random, size_t entries)
{
    he_mesh *mesh = script_mesh("012,023,034,045", NULL);
    script_add_columns(mesh);
    history *h = history_new(mesh);
    while (h->count < entries) {
        step_history(h, random);
    }
    return h;
}

/* Across the entry before `at` (back) or after it. */
static he_status cross(const history *h, he_replay *replay, size_t at, bool back)
{
    size_t crossed = back ? at : at + 1;
    const entry *e = &h->entries[crossed];
    const he_mesh *there = h->entries[back ? at - 1 : at + 1].after;
    uint32_t issued[HE_KIND_COUNT];
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        issued[kind] = he_mesh_issued(there, (he_kind)kind);
    }
    he_crossing crossing = {.key = e->step,
                            .delta = h->steps[e->step],
                            .undo = e->undo != back,
                            .held = back && h->applied[e->step] == crossed,
                            .issued = issued};
    return he_replay_cross(replay, &crossing, NULL);
}

static void test_every_point_of_a_log_can_be_reached(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        history *h = random_history(&random, ENTRIES);
        he_replay *replay;
        assert_int_equal(he_replay_new(h->mesh, &replay, NULL), HE_OK);
        size_t at = h->count - 1;
        /* To the beginning, then back and forth, then to the end. */
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
        history_free(h);
    }
}

/* A column that came lives in the mesh and nowhere else: a copy that was made before cannot have
 * it from the delta. */
static void test_what_the_mesh_holds_cannot_be_had_from_the_delta(void **state)
{
    (void)state;
    history *h = history_new(script_mesh("012,023", NULL));
    he_replay *replay;
    md_random random = {1};
    assert_int_equal(he_replay_new(h->mesh, &replay, NULL), HE_OK);
    he_delta *delta = h->steps[h->step_count] = he_delta_new();
    he_mesh_record(h->mesh, delta);
    add_column(h->mesh, &random, 0);
    he_mesh_record(h->mesh, NULL);
    note_entry(h, h->step_count++, false);
    assert_int_equal(cross(h, replay, 0, false), HE_UNSUPPORTED);
    assert_true(he_mesh_equal(he_replay_mesh(replay), h->entries[0].after));
    he_replay_free(replay);
    history_free(h);
}

static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    md_random random = {7};
    history *h = random_history(&random, ENTRIES);
    bool failed = true;
    for (unsigned n = 1; failed; n++) {
        he_replay *replay = NULL;
        fail_allocation(n);
        he_status status = he_replay_new(h->mesh, &replay, NULL);
        for (size_t at = h->count - 1; at > 0 && status == HE_OK; at--) {
            status = cross(h, replay, at, true);
        }
        for (size_t at = 0; at + 1 < h->count && status == HE_OK; at++) {
            status = cross(h, replay, at, false);
        }
        failed = allocation_failed();
        fail_allocation(0);
        /* A mesh without slack may refuse to be grown; nothing else goes wrong. */
        assert_true(status == HE_OK || (failed && status == HE_NO_MEMORY));
        if (status == HE_OK) {
            assert_true(he_mesh_equal(he_replay_mesh(replay), h->mesh));
        }
        he_replay_free(replay);
    }
    assert_true(he_mesh_equal(h->mesh, h->entries[h->count - 1].after));
    history_free(h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_point_of_a_log_can_be_reached),
        cmocka_unit_test(test_what_the_mesh_holds_cannot_be_had_from_the_delta),
        cmocka_unit_test(test_every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
