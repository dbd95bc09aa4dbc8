/* Tests of how far back the changes of a mesh can be read: as far as the oldest complete mesh data
 * on the disk, even if memory holds only a few of the changes. */
#include "tests/kept_journal.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "store/history_cursor.h"

static kept_journal *journal;

static st_store *open_store(void)
{
    st_store *store = st_store_new(&(st_store_options){
        .undo_budget = 3000, .max_meshes = 10, .journal = kept_journal_open(journal)});
    assert_non_null(store);
    return store;
}

static st_mesh *make(st_store *store)
{
    st_mesh *mesh;
    he_mesh *content = script_mesh("012,023,034", NULL);
    assert_int_equal(st_create(store, "m", NULL, content, NULL, &mesh), ST_OK);
    return mesh;
}

static st_mesh *load(st_store *store)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_load(store, "m", &mesh), ST_OK);
    return mesh;
}

static he_mesh *content_of(st_mesh *mesh)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(st_read_begin(mesh, NULL), &copy, NULL), HE_OK);
    st_read_end(mesh);
    return copy;
}

/* Reads all changes since the first revision, like a client that has missed many events. */
static void follow_all(st_mesh *mesh, he_mesh *const at[], uint64_t last)
{
    st_cursor *cursor;
    st_cursor_step step;
    assert_int_equal(st_cursor_begin(mesh, 1, &cursor), ST_OK);
    for (uint64_t revision = 2; revision <= last; revision++) {
        assert_int_equal(st_cursor_next(cursor, &step), ST_OK);
        assert_int_equal(step.revision, revision);
        assert_true(he_mesh_equal(step.content, at[revision]));
    }
    assert_int_equal(st_cursor_next(cursor, &step), ST_NOTHING);
    st_cursor_end(cursor);
}

static void what_memory_has_dropped_is_followed_from_the_disk(void **state)
{
    (void)state;
    enum { REVISIONS = 40 };
    journal = kept_journal_new();
    st_store *store = open_store();
    st_mesh *mesh = make(store);
    he_mesh *at[REVISIONS + 1] = {NULL, content_of(mesh)};
    for (unsigned revision = 2; revision <= REVISIONS; revision++) {
        st_write w;
        char text[64];
        snprintf(text, sizeof text, "vertex_add position=%u,1,0", revision);
        assert_int_equal(script_run(writing_begin(mesh, &w), text, NULL, NULL), HE_OK);
        assert_true(writing_commit(&w, "vertex_add", NULL));
        at[revision] = content_of(mesh);
    }
    for (int again = 0; again < 2; again++) {
        st_history reach;
        st_entry entry;
        st_history_reach(mesh, &reach);
        assert_int_equal(reach.oldest, 1);
        assert_false(st_history_entry(mesh, REVISIONS - 2, &entry));
        follow_all(mesh, at, REVISIONS);
        st_cursor *none;
        assert_int_equal(st_cursor_begin(mesh, 0, &none), ST_GONE);
        assert_int_equal(st_cursor_begin(mesh, REVISIONS + 1, &none), ST_AHEAD);
        st_release(mesh);
        st_store_free(store);
        store = open_store();
        mesh = load(store);
    }
    /* After the mesh data was replaced, the history must begin with the new data. */
    assert_int_equal(writing_replace(mesh, content_of(mesh), NULL, NULL), ST_OK);
    st_history reach;
    st_cursor *gone;
    st_history_reach(mesh, &reach);
    assert_int_equal(reach.oldest, REVISIONS + 1);
    assert_int_equal(st_cursor_begin(mesh, REVISIONS, &gone), ST_GONE);
    for (unsigned revision = 1; revision <= REVISIONS; revision++) {
        he_mesh_free(at[revision]);
    }
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_memory_has_dropped_is_followed_from_the_disk),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
