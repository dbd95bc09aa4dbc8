/* Tests of a store on a disk in which each allocation fails in turn, whether the store or SQLite
 * makes it, on any thread. Each request must be executed completely or not at all. The mesh in
 * memory, the mesh after it left memory and was loaded again, and the mesh after a restart must
 * have exactly the changes of the requests that succeeded. */
#include "tests/failing.h"
#include "tests/store_folder.h"
#include "tests/unit/dense.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "store/publish/limits.h"
#include "store/table.h"
#include "stored/stored.h"

#include <sched.h>

static char folder[FOLDER_PATH];
static st_store *store;
static he_mesh *large; /* a mesh so large that its data is stored in parts */

/* --- the store --- */

static void open_store(void)
{
    st_sqlite_opened out;
    const st_sqlite_options options = {.folder = folder, .release = "test"};
    assert_true(st_sqlite_open(&options, &out));
    store = st_store_new(
        &(st_store_options){.undo_budget = 1 << 20, .max_meshes = 100, .journal = out.journal});
    assert_non_null(store);
}

static void close_store(void)
{
    st_store_free(store);
    store = NULL;
}

/* --- the state that must result from the requests that succeeded --- */

enum { STEPS = 4 };

typedef struct expected {
    bool made;         /* whether the mesh "n" exists */
    uint64_t revision; /* revision of the mesh "m" */
    double x;          /* x coordinate of vertex 0 of the mesh "m" */
    uint32_t vertices;
    /* x coordinate of vertex 0 after each possible undo and redo; the last element of an array
     * belongs to the next undo or redo */
    double undo[STEPS], redo[STEPS];
    uint32_t undos, redos;
    bool renamed;
} expected;

static failing turn;

static bool was_done(st_status status)
{
    if (status != ST_OK && status != ST_NO_MEMORY) {
        failing_pause();
        fail_msg("status %d: allocation %ld had failed", status, turn.n);
    }
    return status == ST_OK;
}

static void compare(st_mesh *mesh, const expected *e)
{
    st_mesh_info info;
    assert_int_equal(st_unreadable(mesh), ST_OK);
    const he_mesh *content = st_read_begin(mesh, &info);
    assert_int_equal(info.revision, e->revision);
    assert_string_equal(info.name, e->renamed ? "renamed" : "");
    assert_int_equal(info.undo, e->undos);
    assert_int_equal(info.redo, e->redos);
    assert_int_equal(he_mesh_vertices(content), e->vertices);
    assert_true(he_position(content, (he_vertex){0}).x == e->x);
    st_read_end(mesh);
}

/* --- the requests --- */

/* Moves vertex 0 to a position that it had in no earlier revision. */
static void edit(st_mesh *mesh, expected *e)
{
    const uint32_t vertex = 0;
    const he_vec3 to = {(double)(e->revision + 1), 0, 0};
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    if (content == NULL) {
        return;
    }
    if (he_vertex_move(content, &vertex, 1, HE_MOVE_TO, &to, 1, NULL) != HE_OK ||
        st_write_changes(&w, NULL) != HE_OK) {
        st_write_abort(&w);
    } else if (was_done(st_write_commit(&w, "vertex_move"))) {
        e->undo[e->undos++] = e->x;
        e->redos = 0;
        e->revision++;
        e->x = to.x;
    }
}

static void undo(st_mesh *mesh, expected *e)
{
    if (e->undos > 0 && was_done(writing_step(mesh, ST_UNDO, 1))) {
        e->redo[e->redos++] = e->x;
        e->x = e->undo[--e->undos];
        e->revision++;
    }
}

static void redo(st_mesh *mesh, expected *e)
{
    if (e->redos > 0 && was_done(writing_step(mesh, ST_REDO, 1))) {
        e->undo[e->undos++] = e->x;
        e->x = e->redo[--e->redos];
        e->revision++;
    }
}

static void rename_mesh(st_mesh *mesh, expected *e)
{
    st_write w;
    if (was_done(st_write_begin(mesh, NULL, &w))) {
        st_write_rename(&w, "renamed");
        e->renamed = was_done(st_write_commit(&w, NULL));
    }
}

/* Replaces the mesh data as a PUT does: the new data `content` is written to the disk without
 * holding a lock. Frees `content`. */
static void replace(st_mesh *mesh, he_mesh *content, expected *e)
{
    const double x = he_position(content, (he_vertex){0}).x;
    const uint32_t vertices = he_mesh_vertices(content);
    st_stage *stage = NULL;
    st_write w;
    if (!was_done(st_store_stage(store, content, &stage))) {
        he_mesh_free(content);
        return;
    }
    assert_non_null(stage);
    if (!was_done(st_write_begin(mesh, NULL, &w))) {
        st_store_unstage(store, stage);
        he_mesh_free(content);
        return;
    }
    st_write_replace(&w, content, stage);
    if (was_done(st_write_commit(&w, NULL))) {
        e->revision++;
        e->x = x;
        e->vertices = vertices;
        e->undos = e->redos = 0;
    }
}

static void read_copies(st_mesh *mesh, const expected *e)
{
    st_snapshot *snapshot = NULL;
    if (was_done(st_snapshot_take(mesh, &snapshot))) {
        const he_mesh *content = st_snapshot_content(snapshot, NULL);
        assert_true(he_position(content, (he_vertex){0}).x == e->x);
        st_snapshot_release(snapshot);
    }
    if (e->undos > 0) {
        const st_status status = st_snapshot_at(mesh, e->revision - 1, &snapshot);
        if (was_done(status)) {
            st_snapshot_release(snapshot);
        }
    }
}

/* Removes all meshes from memory by setting a small memory budget. */
static void evict(void)
{
    enum { MIB = 1 << 20 };
    st_waits *waits = st_store_waits(store);
    while (st_waits_durable(waits) < st_waits_newest(waits)) {
        sched_yield();
    }
    st_memory_set_budget(MIB);
    st_memory_count(MIB);
    st_make_room(store, 1);
    st_memory_count(-MIB);
    st_memory_set_budget(0);
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(store, "m", &mesh), ST_COLD);
}

/* Returns the mesh "m", and loads it if it is not in memory. Returns NULL if there is not enough
 * memory to load it. */
static st_mesh *load(const expected *e)
{
    st_mesh *mesh = NULL;
    if (!was_done(st_load(store, "m", &mesh))) {
        return NULL;
    }
    compare(mesh, e);
    return mesh;
}

static void change(st_mesh *mesh, he_mesh *content, expected *e)
{
    edit(mesh, e);
    edit(mesh, e);
    undo(mesh, e);
    read_copies(mesh, e);
    redo(mesh, e);
    undo(mesh, e);
    compare(mesh, e);
    replace(mesh, content, e);
    edit(mesh, e);
    rename_mesh(mesh, e);
    compare(mesh, e);
}

static void create(expected *e)
{
    st_mesh *made = NULL;
    he_mesh *content = he_mesh_new();
    if (content == NULL) {
        return;
    }
    e->made = was_done(st_create(store, "n", "", content, NULL, &made));
    if (e->made) {
        st_release(made);
    } else {
        he_mesh_free(content);
    }
}

static void list(const expected *e)
{
    st_card cards[2];
    size_t count = 0;
    if (was_done(st_cards(store, "", cards, 2, &count))) {
        assert_int_equal(count, e->made ? 2 : 1);
    }
}

/* Makes one request of each kind, while the store's own threads run. Frees `content`. */
static void use_all(he_mesh *content, expected *e)
{
    st_mesh *mesh = load(e);
    if (mesh != NULL) {
        change(mesh, content, e);
        st_release(mesh);
    } else {
        he_mesh_free(content);
    }
    create(e);
    list(e);
    evict();
    mesh = load(e);
    if (mesh != NULL) {
        undo(mesh, e);
        edit(mesh, e);
        read_copies(mesh, e);
        st_release(mesh);
    }
    st_health health;
    st_store_health(store, &health);
    assert_int_equal(health.status, ST_OK);
}

static void expect_after_restart(const expected *e)
{
    open_store();
    st_mesh *made = NULL, *mesh = load(e);
    assert_non_null(mesh);
    assert_int_equal(st_load(store, "n", &made), e->made ? ST_OK : ST_ABSENT);
    st_release(made);
    st_release(mesh);
    close_store();
}

static void make_m(void)
{
    st_mesh *mesh = NULL;
    open_store();
    assert_int_equal(st_create(store, "m", "", fixture_mesh("012,023"), NULL, &mesh), ST_OK);
    st_release(mesh);
    close_store();
}

/* If the environment variable ROUNDS is set, the test has that many runs, and in run n the n-th
 * allocation fails; otherwise the first 8 allocations and some later ones fail, each in a run of
 * its own. The start of the store does not fail in this test; test_srv_journal_faults.c tests
 * starts without memory. */
static void without_memory_each_request_is_whole_or_not_at_all(void **state)
{
    (void)state;
    const char *text = getenv("ROUNDS");
    const long every = text == NULL ? 0 : strtol(text, NULL, 10);
    unsigned runs = 0, all = 0;
    turn = (failing){.may_succeed = true};
    while (failing_next(&turn)) {
        failing_pause();
        expected e = {.revision = 1, .vertices = 4};
        he_mesh *content = dense_copy(large);
        make_m();
        open_store();
        failing_resume();
        use_all(content, &e);
        close_store();
        all += failing_end(&turn, e.made && e.renamed && e.revision == 10);
        runs++;
        turn.sparse = turn.n < every ? 0 : 8;
        expect_after_restart(&e);
        folder_remove(folder);
        folder_make(folder);
    }
    print_message(
        "note: %u requests for memory failed, each alone; nothing was refused in %u runs\n",
        runs - 1, all);
    assert_true(runs > 50 && all > 5 && runs - all > 30);
}

static int begin(void **state)
{
    (void)state;
    folder_make(folder);
    large = dense_grid(120, NULL, 1);
    assert_true(he_stored_content_bound(large) > ST_BODY_BYTES);
    return 0;
}

static int end(void **state)
{
    (void)state;
    failing_off();
    he_mesh_free(large);
    folder_remove(folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_memory_each_request_is_whole_or_not_at_all, begin,
                                        end),
    };
    return cmocka_run_group_tests_name("starved", tests, NULL, NULL);
}
