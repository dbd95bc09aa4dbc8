/* Tests of the names of revisions: the history keeps them with its entries, within the undo budget,
 * and drops both together. */
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/unit/kept_store.h"
#include "tests/writing.h"

#include "store/write.h"
#include "tests/failing.h"
#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>

static st_store *store;

static st_mesh *open_mesh(uint64_t budget)
{
    store = st_store_new(&(st_store_options){
        .undo_budget = budget, .max_meshes = 10, .journal = st_journal_memory()});
    assert_non_null(store);
    st_mesh *mesh;
    assert_int_equal(st_create(store, "m", NULL, script_mesh("012,023,034", NULL), NULL, &mesh),
                     ST_OK);
    return mesh;
}

static void close_mesh(st_mesh *mesh)
{
    st_release(mesh);
    st_store_free(store);
}

static void move(st_mesh *mesh, unsigned serial)
{
    char text[64];
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    assert_non_null(m);
    snprintf(text, sizeof text, "vertex_move vertex=1 to=%u,1,2", serial);
    assert_int_equal(script_run(m, text, NULL, NULL), HE_OK);
    assert_true(writing_commit(&w, "vertex_move", NULL));
}

static st_status name(st_mesh *mesh, uint64_t revision, const char *text)
{
    st_write w;
    st_status status = st_write_begin(mesh, NULL, &w);
    if (status != ST_OK) {
        return status;
    }
    status = st_write_moment(&w, revision, text);
    if (status == ST_OK) {
        return st_write_commit(&w, NULL);
    }
    st_write_abort(&w);
    return status;
}

/* Finds the entry of a revision. Returns false if the history has none. */
static bool find(st_mesh *mesh, uint64_t revision, st_entry *out)
{
    st_mesh_info info;
    (void)st_read_begin(mesh, &info);
    const bool found = revision <= info.revision &&
                       st_history_entry(mesh, (size_t)(info.revision - revision), out);
    st_read_end(mesh);
    return found;
}

static void expect_name(st_mesh *mesh, uint64_t revision, const char *text)
{
    st_entry entry;
    assert_true(find(mesh, revision, &entry));
    assert_int_equal(entry.revision, revision);
    assert_string_equal(entry.name, text);
}

static uint64_t bytes_of(st_mesh *mesh)
{
    st_history reach;
    (void)st_read_begin(mesh, NULL);
    st_history_reach(mesh, &reach);
    st_read_end(mesh);
    return reach.bytes;
}

static void a_revision_has_the_name_that_it_was_given_last(void **state)
{
    (void)state;
    st_mesh *mesh = open_mesh(1 << 20);
    st_mesh_info before, after;
    for (unsigned i = 0; i < 3; i++) {
        move(mesh, i);
    }
    assert_int_equal(writing_step(mesh, ST_UNDO, 1), ST_OK);
    const uint64_t bytes = bytes_of(mesh);
    (void)st_read_card(mesh, &before);
    assert_int_equal(name(mesh, 3, "a"), ST_OK);
    assert_int_equal(name(mesh, 5, "the undo"), ST_OK);
    assert_int_equal(name(mesh, 3, "abc"), ST_OK);
    expect_name(mesh, 2, "");
    expect_name(mesh, 3, "abc");
    expect_name(mesh, 5, "the undo");
    assert_int_equal(bytes_of(mesh), bytes + sizeof "abc" + sizeof "the undo");
    (void)st_read_card(mesh, &after);
    assert_int_equal(after.revision, before.revision);
    assert_int_equal(after.metadata, before.metadata + 3);
    assert_int_equal(after.undo, before.undo);
    assert_int_equal(after.redo, before.redo);
    /* The redo of a step does not take over the name of its undo. */
    assert_int_equal(writing_step(mesh, ST_REDO, 1), ST_OK);
    expect_name(mesh, 6, "");
    assert_int_equal(name(mesh, 3, ""), ST_OK);
    assert_int_equal(name(mesh, 5, ""), ST_OK);
    expect_name(mesh, 3, "");
    close_mesh(mesh);
}

static void what_has_no_entry_has_no_name(void **state)
{
    (void)state;
    st_mesh *mesh = open_mesh(1 << 20);
    assert_int_equal(name(mesh, 1, "the beginning"), ST_GONE);
    assert_int_equal(name(mesh, 2, "not yet"), ST_AHEAD);
    move(mesh, 1);
    assert_int_equal(name(mesh, 2, "now"), ST_OK);
    assert_int_equal(name(mesh, 3, "not yet"), ST_AHEAD);
    assert_int_equal(name(mesh, 0, "never"), ST_GONE);
    assert_int_equal(writing_remove(mesh), ST_OK);
    assert_int_equal(name(mesh, 2, "late"), ST_ABSENT);
    close_mesh(mesh);
}

static void names_count_and_go_with_their_entries(void **state)
{
    (void)state;
    enum { BUDGET = 20000 };
    md_random random = {seed_of_run()};
    char text[ST_MOMENT_NAME + 1];
    unsigned refused = 0, named = 0;
    st_mesh *mesh = open_mesh(BUDGET);
    for (unsigned i = 2; i < 3000; i++) {
        st_entry entry;
        const uint32_t what = md_below(&random, 10);
        if (what == 0) {
            (void)writing_step(mesh, ST_UNDO, 1);
        } else if (what == 1) {
            (void)writing_step(mesh, ST_REDO, 1);
        } else {
            move(mesh, i);
        }
        st_mesh_info info;
        (void)st_read_card(mesh, &info);
        const uint64_t back = md_below(&random, 120);
        const uint64_t revision = info.revision > back ? info.revision - back : 1;
        const size_t length = 1 + md_below(&random, ST_MOMENT_NAME);
        memset(text, 'a' + (int)(i % 26), length);
        text[length] = '\0';
        const bool was = find(mesh, revision, &entry);
        const uint64_t bytes = bytes_of(mesh);
        const st_status status = name(mesh, revision, text);
        if (status == ST_OK) {
            expect_name(mesh, revision, text);
            named++;
        } else {
            assert_int_equal(status, was ? ST_TOO_LARGE : ST_GONE);
            assert_int_equal(bytes_of(mesh), bytes);
            assert_int_equal(find(mesh, revision, &entry), was);
            refused += was;
        }
        assert_true(bytes_of(mesh) <= BUDGET);
    }
    printf("note: %u revisions named, %u names refused for lack of room\n", named, refused);
    assert_true(named > 0 && refused > 0);
    close_mesh(mesh);
}

static void the_newest_revision_can_always_be_named(void **state)
{
    (void)state;
    st_mesh *mesh = open_mesh(0);
    move(mesh, 1);
    assert_int_equal(name(mesh, 2, "even so"), ST_OK);
    expect_name(mesh, 2, "even so");
    move(mesh, 2);
    st_entry entry;
    assert_false(find(mesh, 2, &entry));
    close_mesh(mesh);
}

static void a_name_without_memory_changes_nothing(void **state)
{
    (void)state;
    st_mesh *mesh = open_mesh(1 << 20);
    move(mesh, 1);
    assert_int_equal(name(mesh, 2, "as it was"), ST_OK);
    failing f = {.what = "a name"};
    while (failing_next(&f)) {
        st_mesh_info before, after;
        failing_pause();
        (void)st_read_card(mesh, &before);
        failing_resume();
        const st_status status = name(mesh, 2, "new");
        if (!failing_end(&f, status == ST_OK)) {
            assert_int_equal(status, ST_NO_MEMORY);
            expect_name(mesh, 2, "as it was");
            (void)st_read_card(mesh, &after);
            assert_int_equal(after.metadata, before.metadata);
        }
    }
    expect_name(mesh, 2, "new");
    close_mesh(mesh);
}

static void names_are_loaded_again(void **state)
{
    (void)state;
    kept_journal *journal = kept_journal_new();
    store = kept_store_open(journal, 1 << 20, NULL);
    st_mesh *mesh = kept_store_make(store, "m");
    move(mesh, 1);
    move(mesh, 2);
    assert_int_equal(name(mesh, 2, "one"), ST_OK);
    assert_int_equal(name(mesh, 3, "two"), ST_OK);
    assert_int_equal(name(mesh, 2, ""), ST_OK);
    st_store *other = kept_store_open(journal, 1 << 20, NULL);
    st_mesh *loaded = kept_store_load(other, "m");
    kept_store_expect_same(mesh, loaded);
    expect_name(loaded, 2, "");
    expect_name(loaded, 3, "two");
    st_release(loaded);
    st_store_free(other);
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_revision_has_the_name_that_it_was_given_last),
        cmocka_unit_test(what_has_no_entry_has_no_name),
        cmocka_unit_test(names_count_and_go_with_their_entries),
        cmocka_unit_test(the_newest_revision_can_always_be_named),
        cmocka_unit_test(a_name_without_memory_changes_nothing),
        cmocka_unit_test(names_are_loaded_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
