/* The store: ids, revisions, undo and redo within a budget, snapshots, caches, threads. */
#include "tests/unit/fixture.h"

#include "edit/local/vertex.h"
#include "server/store/store.h"
#include "server/system/memory.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { BUDGET = 1 << 20, MESHES = 100 };

static srv_store *store;
static api_store api;

static void open_store(uint64_t budget, uint64_t meshes)
{
    store = srv_store_new(&(srv_store_options){
        .undo_budget = budget, .max_meshes = meshes, .journal = srv_journal_memory()});
    assert_non_null(store);
    api = srv_store_interface(store);
}

static int setup(void **state)
{
    (void)state;
    open_store(BUDGET, MESHES);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    srv_store_free(store);
    he_mem_set_hook(NULL);
    return 0;
}

static api_mesh *create(const char *id)
{
    api_mesh *mesh = NULL;
    assert_int_equal(api.create(api.self, id, "a name", fixture_mesh("012,023"), NULL, &mesh),
                     API_STORE_OK);
    return mesh;
}

/* Moves vertex 0 to x: one edit, one step. */
static void move(api_mesh *mesh, double x, bool barrier, api_mesh_info *info)
{
    he_delta *delta = NULL;
    he_mesh *content = api.write_begin(api.self, mesh, NULL, &delta);
    assert_non_null(content);
    assert_int_equal(delta->count, 0);
    he_vec3 point = {x, 0, 0};
    uint32_t vertex = 0;
    assert_int_equal(he_vertex_move(content, &vertex, 1, HE_MOVE_TO, &point, 1, NULL), HE_OK);
    assert_true(delta->count > 0);
    api.write_commit(api.self, mesh, "vertex_move", barrier, info);
}

static double x_of(api_mesh *mesh)
{
    const he_mesh *content = api.read_begin(api.self, mesh, NULL);
    double x = he_position(content, (he_vertex){0}).x;
    api.read_end(api.self, mesh);
    return x;
}

static api_mesh_info info_of(api_mesh *mesh)
{
    api_mesh_info info;
    assert_non_null(api.read_begin(api.self, mesh, &info));
    api.read_end(api.self, mesh);
    return info;
}

static api_store_status take_away(api_mesh *mesh)
{
    assert_non_null(api.write_begin(api.self, mesh, NULL, NULL));
    api_store_status status = api.remove(api.self, mesh, NULL);
    api.write_end(api.self, mesh);
    return status;
}

static api_store_status step(api_mesh *mesh, api_action which)
{
    const he_delta *delta = NULL;
    assert_non_null(api.write_begin(api.self, mesh, NULL, NULL));
    api_store_status status = api.step(api.self, mesh, which, 1, &delta, NULL);
    if (status == API_STORE_OK) {
        assert_true(delta->count > 0);
    }
    api.write_end(api.self, mesh);
    return status;
}

static void test_ids(void **state)
{
    (void)state;
    api_mesh *a = create("b"), *b = create(NULL), *found = NULL, *list[4];
    api_mesh_info info = info_of(b);
    assert_int_equal(strlen(info.id), 10);
    assert_int_equal(strspn(info.id, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                     "0123456789"),
                     10);
    assert_int_equal(info.revision, 1);
    assert_int_equal(info.metadata, 1);
    assert_string_equal(info.name, "a name");
    assert_true(info.incarnation != info_of(a).incarnation);

    he_mesh *content = fixture_mesh("012");
    assert_int_equal(api.create(api.self, "b", NULL, content, NULL, &found), API_STORE_TAKEN);
    he_mesh_free(content);
    assert_int_equal(api.find(api.self, "c", &found), API_STORE_ABSENT);
    assert_int_equal(api.find(api.self, "b", &found), API_STORE_OK);
    assert_ptr_equal(found, a);
    api.release(api.self, found);

    api_mesh *c = create("a"), *d = create("c");
    assert_int_equal(api.list(api.self, "a", list, 1), 1);
    /* The id the store chose may lie anywhere among the others. */
    bool first = strcmp(info.id, "a") > 0 && strcmp(info.id, "b") < 0;
    assert_ptr_equal(list[0], first ? b : a);
    api.release(api.self, list[0]);
    int after = 2 + (strcmp(info.id, "aa") > 0);
    assert_int_equal(api.list(api.self, "aa", list, 4), after);
    for (int i = 0; i < after; i++) {
        api.release(api.self, list[i]);
    }
    api.release(api.self, a);
    api.release(api.self, b);
    api.release(api.self, c);
    api.release(api.self, d);
    assert_int_equal(srv_store_count(store), 4);
}

static void test_removed_mesh_stays_for_its_readers(void **state)
{
    (void)state;
    api_mesh *mesh = create("m"), *found = NULL;
    uint64_t incarnation = info_of(mesh).incarnation;
    assert_int_equal(take_away(mesh), API_STORE_OK);
    assert_int_equal(take_away(mesh), API_STORE_ABSENT);
    assert_true(info_of(mesh).removed);
    assert_int_equal(api.find(api.self, "m", &found), API_STORE_ABSENT);
    api_mesh *again = create("m");
    assert_true(info_of(again).incarnation != incarnation);
    assert_int_equal(take_away(mesh), API_STORE_ABSENT);
    api.release(api.self, mesh);
    api.release(api.self, again);
}

static void test_too_many(void **state)
{
    (void)state;
    srv_store_free(store);
    open_store(BUDGET, 1);
    api_mesh *mesh = create("m"), *other = NULL;
    he_mesh *content = fixture_mesh("012");
    assert_int_equal(api.create(api.self, "n", NULL, content, NULL, &other), API_STORE_TOO_MANY);
    assert_int_equal(api.create(api.self, "m", NULL, content, NULL, &other), API_STORE_TAKEN);
    he_mesh_free(content);
    api.release(api.self, mesh);
}

static void test_undo_and_redo(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    double first = x_of(mesh);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_NOTHING);
    assert_int_equal(step(mesh, API_REDO), API_STORE_NOTHING);
    assert_int_equal(info_of(mesh).revision, 1);
    move(mesh, 10, false, NULL);
    api_mesh_info info;
    move(mesh, 20, false, &info);
    assert_int_equal(info.revision, 3);
    assert_int_equal(info.undo, 2);

    assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);
    assert_true(x_of(mesh) == 10);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);
    assert_true(x_of(mesh) == first);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_NOTHING);
    assert_int_equal(step(mesh, API_REDO), API_STORE_OK);
    assert_true(x_of(mesh) == 10);
    info = info_of(mesh);
    assert_int_equal(info.revision, 6);
    assert_int_equal(info.undo, 1);
    assert_int_equal(info.redo, 1);

    static const struct {
        uint64_t revision, inverts;
        api_action action;
        bool undoable;
    } rows[] = {
        {6, 2, API_REDO, true},  {5, 2, API_UNDO, false}, {4, 3, API_UNDO, false},
        {3, 0, API_EDIT, false}, {2, 0, API_EDIT, false},
    };
    api_entry entry;
    api.read_begin(api.self, mesh, NULL);
    for (size_t i = 0; i < 5; i++) {
        assert_true(api.history(api.self, mesh, i, &entry));
        assert_int_equal(entry.revision, rows[i].revision);
        assert_int_equal(entry.inverts, rows[i].inverts);
        assert_int_equal(entry.action, rows[i].action);
        assert_int_equal(entry.undoable, rows[i].undoable);
        assert_string_equal(entry.ops, "vertex_move");
        assert_true(entry.bytes > 0);
        assert_true(entry.time > 1e9);
    }
    assert_false(api.history(api.self, mesh, 5, &entry));
    api.read_end(api.self, mesh);

    move(mesh, 30, false, &info);
    assert_int_equal(info.redo, 0);
    assert_int_equal(info.undo, 2);
    assert_int_equal(step(mesh, API_REDO), API_STORE_NOTHING);
    api.release(api.self, mesh);
}

static void test_abort_leaves_nothing(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    he_mesh *before = NULL;
    const he_mesh *content = api.read_begin(api.self, mesh, NULL);
    assert_int_equal(he_mesh_copy(content, &before, NULL), HE_OK);
    api.read_end(api.self, mesh);
    for (int end = 0; end < 2; end++) {
        he_mesh *writing = api.write_begin(api.self, mesh, NULL, NULL);
        he_vertex made;
        assert_int_equal(he_vertex_add(writing, (he_vec3){1, 2, 3}, &made, NULL), HE_OK);
        if (end == 0) {
            api.write_abort(api.self, mesh);
        } else {
            api.write_end(api.self, mesh);
        }
        content = api.read_begin(api.self, mesh, NULL);
        assert_true(he_mesh_equal(content, before));
        api.read_end(api.self, mesh);
    }
    assert_int_equal(info_of(mesh).revision, 1);
    he_mesh_free(before);
    api.release(api.self, mesh);
}

static void test_barrier_and_replace_end_undo(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    api_mesh_info info;
    move(mesh, 1, false, NULL);
    move(mesh, 2, true, &info);
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.revision, 3);
    move(mesh, 3, false, NULL);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);

    assert_non_null(api.write_begin(api.self, mesh, NULL, NULL));
    api.replace(api.self, mesh, fixture_mesh("012"), &info);
    api.write_end(api.self, mesh);
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.redo, 0);
    assert_int_equal(info.revision, 6);
    const he_mesh *content = api.read_begin(api.self, mesh, NULL);
    fixture_counts(content, 3, 3, 1);
    api_entry entry;
    assert_true(api.history(api.self, mesh, 0, &entry));
    assert_int_equal(entry.action, API_REPLACE);
    assert_false(entry.undoable);
    api.read_end(api.self, mesh);

    assert_non_null(api.write_begin(api.self, mesh, NULL, NULL));
    api.rename(api.self, mesh, "other", &info);
    api.write_end(api.self, mesh);
    assert_string_equal(info.name, "other");
    assert_int_equal(info.metadata, 2);
    assert_int_equal(info.revision, 6);
    move(mesh, 9, false, NULL);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);
    api.release(api.self, mesh);
}

static void test_undo_budget(void **state)
{
    (void)state;
    srv_store_free(store);
    enum { SMALL_BUDGET = 4000, EDITS = 200 };
    open_store(SMALL_BUDGET, MESHES);
    api_mesh *mesh = create("m");
    api_mesh_info info = {0};
    for (int i = 0; i < EDITS; i++) {
        move(mesh, i + 1, false, &info);
    }
    assert_true(info.undo > 1);
    assert_true(info.undo < EDITS / 2);
    uint32_t steps = info.undo;
    for (uint32_t i = 0; i < steps; i++) {
        uint32_t left = info_of(mesh).undo;
        assert_int_equal(step(mesh, API_UNDO), left > 0 ? API_STORE_OK : API_STORE_NOTHING);
    }
    assert_true(x_of(mesh) < EDITS - 2);

    /* One edit beyond the budget: applied, but it cannot be undone, nor can what came before. */
    he_mesh *content = api.write_begin(api.self, mesh, NULL, NULL);
    for (int i = 0; i < EDITS; i++) {
        he_vertex made;
        assert_int_equal(he_vertex_add(content, (he_vec3){1, 2, 3}, &made, NULL), HE_OK);
    }
    api.write_commit(api.self, mesh, "vertex_add", false, &info);
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.redo, 0);
    api_entry entry;
    api.read_begin(api.self, mesh, NULL);
    assert_true(api.history(api.self, mesh, 0, &entry));
    assert_false(entry.undoable);
    assert_true(entry.bytes > SMALL_BUDGET);
    api.read_end(api.self, mesh);
    api.release(api.self, mesh);
}

static void test_long_names_of_operations_are_cut(void **state)
{
    (void)state;
    char ops[1000];
    size_t at = 0;
    while (at < 900) {
        at += (size_t)snprintf(ops + at, sizeof ops - at, "%svertex_move", at == 0 ? "" : ",");
    }
    api_mesh *mesh = create("m");
    he_mesh *content = api.write_begin(api.self, mesh, NULL, NULL);
    he_vertex made;
    assert_int_equal(he_vertex_add(content, (he_vec3){0}, &made, NULL), HE_OK);
    api.write_commit(api.self, mesh, ops, false, NULL);
    api_entry entry;
    api.read_begin(api.self, mesh, NULL);
    assert_true(api.history(api.self, mesh, 0, &entry));
    api.read_end(api.self, mesh);
    size_t length = strlen(entry.ops);
    assert_true(length < API_ENTRY_OPS);
    assert_string_equal(entry.ops + length - strlen("vertex_move,..."), "vertex_move,...");
    api.release(api.self, mesh);
}

static void test_snapshots(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    api_snapshot *a = NULL, *b = NULL;
    api_mesh_info info;
    move(mesh, 1, false, NULL);
    assert_int_equal(api.snapshot(api.self, mesh, &a), API_STORE_OK);
    assert_int_equal(api.snapshot(api.self, mesh, &b), API_STORE_OK);
    const he_mesh *shared = api.snapshot_content(a, &info);
    assert_ptr_equal(api.snapshot_content(b, NULL), shared);
    assert_int_equal(info.revision, 2);

    /* Held: it stays as it was. */
    move(mesh, 2, false, NULL);
    assert_true(he_position(shared, (he_vertex){0}).x == 1);
    api.snapshot_release(api.self, b);
    assert_int_equal(api.snapshot(api.self, mesh, &b), API_STORE_OK);
    assert_ptr_not_equal(api.snapshot_content(b, &info), shared);
    assert_int_equal(info.revision, 3);
    assert_true(he_position(api.snapshot_content(b, NULL), (he_vertex){0}).x == 2);
    api.snapshot_release(api.self, a);
    api.snapshot_release(api.self, b);

    /* Released: brought forward, undo and new rows included. */
    for (int round = 0; round < 4; round++) {
        if (round == 1) {
            assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);
        } else if (round == 2) {
            he_mesh *content = api.write_begin(api.self, mesh, NULL, NULL);
            he_vertex made;
            assert_int_equal(he_vertex_add(content, (he_vec3){7, 8, 9}, &made, NULL), HE_OK);
            api.write_commit(api.self, mesh, "vertex_add", false, NULL);
        } else {
            move(mesh, 10 + round, false, NULL);
        }
        assert_int_equal(api.snapshot(api.self, mesh, &a), API_STORE_OK);
        const he_mesh *content = api.read_begin(api.self, mesh, NULL);
        assert_true(he_mesh_equal(api.snapshot_content(a, NULL), content));
        api.read_end(api.self, mesh);
        api.snapshot_release(api.self, a);
    }

    /* It outlives its mesh. */
    assert_int_equal(api.snapshot(api.self, mesh, &a), API_STORE_OK);
    assert_int_equal(take_away(mesh), API_STORE_OK);
    api.release(api.self, mesh);
    assert_int_equal(he_mesh_vertices(api.snapshot_content(a, NULL)), 5);
    api.snapshot_release(api.self, a);
}

static void test_cache(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    int value = 7, got = 0;
    long other;
    api.read_begin(api.self, mesh, NULL);
    assert_false(api.cache_get(api.self, mesh, &got, sizeof got));
    api.cache_put(api.self, mesh, &value, sizeof value);
    assert_true(api.cache_get(api.self, mesh, &got, sizeof got));
    assert_int_equal(got, 7);
    assert_false(api.cache_get(api.self, mesh, &other, sizeof other));
    api.read_end(api.self, mesh);
    move(mesh, 1, false, NULL);
    api.read_begin(api.self, mesh, NULL);
    assert_false(api.cache_get(api.self, mesh, &got, sizeof got));
    api.read_end(api.self, mesh);
    api.release(api.self, mesh);
}

/* Every call of the store with each of its allocations failing in turn: a clean refusal, and the
 * mesh as it was. */
static void test_every_allocation_may_fail(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    for (long n = 1; n < 200; n++) {
        api_mesh *made = NULL;
        api_snapshot *snapshot = NULL;
        he_mesh *content = fixture_mesh("012,023");
        bool all = true;
        fixture_fail_at(n);
        api_store_status status = api.create(api.self, NULL, "x", content, NULL, &made);
        if (status != API_STORE_OK) {
            assert_int_equal(status, API_STORE_NO_MEMORY);
            all = false;
        }
        he_mesh *writing = api.write_begin(api.self, mesh, NULL, NULL);
        if (writing != NULL) {
            uint32_t vertex = 0;
            he_vec3 point = {(double)n, 0, 0};
            if (he_vertex_move(writing, &vertex, 1, HE_MOVE_TO, &point, 1, NULL) == HE_OK) {
                api.write_commit(api.self, mesh, "vertex_move", false, NULL);
            } else {
                api.write_abort(api.self, mesh);
                all = false;
            }
        } else {
            all = false;
        }
        if (api.snapshot(api.self, mesh, &snapshot) != API_STORE_OK) {
            all = false;
        }
        fixture_memory_back();
        if (snapshot != NULL) {
            const he_mesh *now = api.read_begin(api.self, mesh, NULL);
            assert_true(he_mesh_equal_live(api.snapshot_content(snapshot, NULL), now));
            api.read_end(api.self, mesh);
            api.snapshot_release(api.self, snapshot);
        }
        if (status == API_STORE_OK) {
            assert_int_equal(take_away(made), API_STORE_OK);
            api.release(api.self, made);
        } else {
            he_mesh_free(content);
        }
        if (all && n > 1) {
            api.release(api.self, mesh);
            return;
        }
    }
    fail_msg("no end of failing allocations");
}

static void test_memory_budget(void **state)
{
    (void)state;
    srv_store_free(store);
    srv_memory_install(0);
    open_store(BUDGET, MESHES);
    api_mesh *mesh = create("m"), *other = NULL;
    assert_true(srv_memory_used() > he_mesh_bytes(api.read_begin(api.self, mesh, NULL)));
    api.read_end(api.self, mesh);

    he_mesh *content = fixture_mesh("012");
    srv_memory_set_budget(srv_memory_used());
    assert_true(srv_memory_is_full());
    assert_int_equal(api.create(api.self, "n", NULL, content, NULL, &other), API_STORE_BUDGET);
    assert_null(he_mem_alloc(1 << 20));
    /* A writer has what is only kept for later freed. */
    srv_memory_set_budget(0);
    api_snapshot *snapshot = NULL;
    assert_int_equal(api.snapshot(api.self, mesh, &snapshot), API_STORE_OK);
    api.snapshot_release(api.self, snapshot);
    void *filling = he_mem_alloc(1 << 20);
    uint64_t with_copy = srv_memory_used();
    srv_memory_set_budget(with_copy + with_copy / 32);
    assert_true(srv_memory_is_full());
    assert_non_null(api.write_begin(api.self, mesh, NULL, NULL));
    api.write_abort(api.self, mesh);
    uint64_t without = srv_memory_used();
    srv_store_shed(store);
    assert_true(srv_memory_used() == without);
    he_mem_free(filling);
    uint64_t used = srv_memory_used();
    srv_memory_set_budget(0);
    void *block = he_mem_alloc(100000);
    assert_true(srv_memory_used() >= used + 100000);
    block = he_mem_resize(block, 10);
    assert_true(srv_memory_used() < used + 10000);
    he_mem_free(block);
    assert_int_equal(srv_memory_used(), used);
    he_mesh_free(content);
    api.release(api.self, mesh);
    srv_store_free(store);
    assert_int_equal(srv_memory_used(), 0);
    he_mem_set_hook(NULL);
    open_store(BUDGET, MESHES);
}

/* Threads. Writers move vertices 0 and 1 to the same point in one edit: readers must never see
 * them apart, nor a revision go back. */
enum { ROUNDS = 300, WRITERS = 2, READERS = 2 };
static _Atomic bool broken;

/* --- what is derived --- */

static atomic_int destroyed;

static void destroy(void *value)
{
    he_mem_free(value);
    atomic_fetch_add(&destroyed, 1);
}

/* One of each kind. */
static void derive(api_mesh *mesh)
{
    for (int kind = 0; kind < API_DERIVED_COUNT; kind++) {
        api_derived *kept = api.derived_begin(api.self, mesh, (api_derived_kind)kind);
        assert_null(kept->value);
        *kept = (api_derived){he_mem_alloc(1000), destroy};
        api.derived_end(api.self, mesh, (api_derived_kind)kind);
    }
}

static void test_what_is_derived_goes_with_shedding_and_the_mesh(void **state)
{
    (void)state;
    atomic_store(&destroyed, 0);
    api_mesh *mesh = create("a");
    derive(mesh);
    move(mesh, 1, false, NULL);
    api_derived *kept = api.derived_begin(api.self, mesh, API_DERIVED_SLOTS);
    assert_non_null(kept->value);
    api.derived_end(api.self, mesh, API_DERIVED_SLOTS);
    srv_store_shed(store);
    assert_int_equal(atomic_load(&destroyed), API_DERIVED_COUNT);
    derive(mesh);
    assert_int_equal(take_away(mesh), API_STORE_OK);
    assert_int_equal(atomic_load(&destroyed), API_DERIVED_COUNT);
    api.release(api.self, mesh);
    assert_int_equal(atomic_load(&destroyed), 2 * API_DERIVED_COUNT);
}

/* Each revision has its delta while the history is kept; a barrier ends what was before. */
static void test_deltas_by_revision(void **state)
{
    (void)state;
    api_mesh *mesh = create("a");
    move(mesh, 1, false, NULL);
    move(mesh, 2, false, NULL);
    assert_int_equal(step(mesh, API_UNDO), API_STORE_OK);
    api.read_begin(api.self, mesh, NULL);
    assert_null(api.revision_delta(api.self, mesh, 0));
    assert_null(api.revision_delta(api.self, mesh, 1));
    const he_delta *third = api.revision_delta(api.self, mesh, 3);
    assert_non_null(api.revision_delta(api.self, mesh, 2));
    assert_true(third != NULL && third != api.revision_delta(api.self, mesh, 2));
    assert_ptr_equal(api.revision_delta(api.self, mesh, 4), third);
    assert_null(api.revision_delta(api.self, mesh, 5));
    assert_null(api.revision_delta(api.self, mesh, UINT64_MAX));
    api.read_end(api.self, mesh);
    move(mesh, 3, true, NULL);
    api.read_begin(api.self, mesh, NULL);
    for (uint64_t revision = 0; revision < 8; revision++) {
        assert_null(api.revision_delta(api.self, mesh, revision));
    }
    api.read_end(api.self, mesh);
    api.release(api.self, mesh);
}

static void *write_some(void *context)
{
    api_mesh *mesh = context;
    for (int i = 0; i < ROUNDS; i++) {
        he_mesh *content = api.write_begin(api.self, mesh, NULL, NULL);
        uint32_t vertices[] = {0, 1};
        he_vec3 point = {i, i, i};
        if (content == NULL) {
            atomic_store(&broken, true);
            break;
        }
        if (i % 7 == 3) {
            const he_delta *lent;
            api_store_status status =
                api.step(api.self, mesh, i % 2 ? API_UNDO : API_REDO, 1, &lent, NULL);
            (void)status;
            api.write_end(api.self, mesh);
        } else if (he_vertex_move(content, vertices, 2, HE_MOVE_TO, &point, 1, NULL) != HE_OK) {
            atomic_store(&broken, true);
            api.write_abort(api.self, mesh);
        } else if (i % 5 == 0) {
            api.write_abort(api.self, mesh);
        } else {
            api.write_commit(api.self, mesh, "vertex_move", false, NULL);
        }
    }
    return NULL;
}

static bool together(const he_mesh *mesh)
{
    he_vec3 a = he_position(mesh, (he_vertex){0}), b = he_position(mesh, (he_vertex){1});
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void *read_some(void *context)
{
    api_mesh *mesh = context;
    uint64_t last = 0;
    for (int i = 0; i < ROUNDS; i++) {
        api_mesh_info info;
        api_snapshot *snapshot = NULL;
        const he_mesh *content = api.read_begin(api.self, mesh, &info);
        bool good = together(content) && info.revision >= last;
        last = info.revision;
        int value = i;
        api.cache_put(api.self, mesh, &value, sizeof value);
        good = good && api.cache_get(api.self, mesh, &value, sizeof value);
        api.read_end(api.self, mesh);
        good = good && api.snapshot(api.self, mesh, &snapshot) == API_STORE_OK;
        if (snapshot != NULL) {
            good = good && together(api.snapshot_content(snapshot, NULL));
            api.snapshot_release(api.self, snapshot);
        }
        if (!good) {
            atomic_store(&broken, true);
        }
    }
    return NULL;
}

static void *come_and_go(void *context)
{
    (void)context;
    for (int i = 0; i < ROUNDS; i++) {
        char id[16];
        api_mesh *mesh = NULL;
        snprintf(id, sizeof id, "t%d", i % 5);
        he_mesh *content = he_mesh_new();
        if (api.create(api.self, id, NULL, content, NULL, &mesh) != API_STORE_OK) {
            he_mesh_free(content);
            if (api.find(api.self, id, &mesh) != API_STORE_OK) {
                continue;
            }
        }
        api_store_status status = take_away(mesh);
        (void)status;
        api.release(api.self, mesh);
    }
    return NULL;
}

static void test_threads(void **state)
{
    (void)state;
    api_mesh *mesh = create("m");
    he_mesh *content = api.write_begin(api.self, mesh, NULL, NULL);
    uint32_t vertices[] = {0, 1};
    he_vec3 point = {0, 0, 0};
    assert_int_equal(he_vertex_move(content, vertices, 2, HE_MOVE_TO, &point, 1, NULL), HE_OK);
    api.write_commit(api.self, mesh, "vertex_move", true, NULL);
    pthread_t threads[WRITERS + READERS + 2];
    size_t count = 0;
    for (int i = 0; i < WRITERS; i++) {
        assert_int_equal(pthread_create(&threads[count++], NULL, write_some, mesh), 0);
    }
    for (int i = 0; i < READERS; i++) {
        assert_int_equal(pthread_create(&threads[count++], NULL, read_some, mesh), 0);
    }
    for (int i = 0; i < 2; i++) {
        assert_int_equal(pthread_create(&threads[count++], NULL, come_and_go, NULL), 0);
    }
    for (size_t i = 0; i < count; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_false(atomic_load(&broken));
    const he_mesh *final = api.read_begin(api.self, mesh, NULL);
    fixture_check(final);
    api.read_end(api.self, mesh);
    api.release(api.self, mesh);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(test_ids),
        TEST(test_removed_mesh_stays_for_its_readers),
        TEST(test_too_many),
        TEST(test_undo_and_redo),
        TEST(test_abort_leaves_nothing),
        TEST(test_barrier_and_replace_end_undo),
        TEST(test_undo_budget),
        TEST(test_long_names_of_operations_are_cut),
        TEST(test_snapshots),
        TEST(test_cache),
        TEST(test_every_allocation_may_fail),
        TEST(test_memory_budget),
        TEST(test_what_is_derived_goes_with_shedding_and_the_mesh),
        TEST(test_deltas_by_revision),
        TEST(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
