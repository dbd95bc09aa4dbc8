/* Tests of the store: ids, revisions, undo and redo within a memory budget, snapshots, caches,
 * threads. */
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "mesh/compact.h"

#include "edit/local/vertex.h"
#include "store/store.h"
#include "system/clock.h"
#include "system/memory.h"
#include "tests/failing.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { BUDGET = 1 << 20, MESHES = 100 };

static st_store *store;

static void open_store(uint64_t budget, uint64_t meshes)
{
    store = st_store_new(&(st_store_options){
        .undo_budget = budget, .max_meshes = meshes, .journal = st_journal_memory()});
    assert_non_null(store);
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
    st_store_free(store);
    he_mem_set_hook(NULL);
    return 0;
}

static st_mesh *create(const char *id)
{
    st_mesh *mesh = NULL;
    assert_int_equal(st_create(store, id, "a name", fixture_mesh("012,023"), NULL, &mesh), ST_OK);
    return mesh;
}

/* Moves vertex 0 to (x, 0, 0) in one edit. If `barrier` is true, the edit cannot be undone. */
static void move(st_mesh *mesh, double x, bool barrier, st_mesh_info *info)
{
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    assert_non_null(content);
    assert_int_equal(w.delta->count, 0);
    he_vec3 point = {x, 0, 0};
    uint32_t vertex = 0;
    assert_int_equal(he_vertex_move(content, &vertex, 1, HE_MOVE_TO, &point, 1, NULL), HE_OK);
    assert_true(w.delta->count > 0);
    if (barrier) {
        assert_int_equal(he_compact(content, NULL, NULL), HE_OK);
    }
    assert_true(writing_commit(&w, "vertex_move", info));
}

static double x_of(st_mesh *mesh)
{
    const he_mesh *content = st_read_begin(mesh, NULL);
    double x = he_position(content, (he_vertex){0}).x;
    st_read_end(mesh);
    return x;
}

static st_mesh_info info_of(st_mesh *mesh)
{
    st_mesh_info info;
    assert_non_null(st_read_begin(mesh, &info));
    st_read_end(mesh);
    return info;
}

static st_status take_away(st_mesh *mesh)
{
    return writing_remove(mesh);
}

static st_status step(st_mesh *mesh, st_action which)
{
    return writing_step(mesh, which, 1);
}

static void ids_are_unique_and_listed_in_order(void **state)
{
    (void)state;
    st_mesh *a = create("b"), *b = create(NULL), *found = NULL, *list[4];
    st_mesh_info info = info_of(b);
    assert_int_equal(strlen(info.id), 10);
    assert_int_equal(strspn(info.id, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                     "0123456789"),
                     10);
    assert_int_equal(info.revision, 1);
    assert_int_equal(info.metadata, 1);
    assert_string_equal(info.name, "a name");
    assert_true(info.incarnation != info_of(a).incarnation);

    he_mesh *content = fixture_mesh("012");
    assert_int_equal(st_create(store, "b", NULL, content, NULL, &found), ST_TAKEN);
    he_mesh_free(content);
    assert_int_equal(st_find(store, "c", &found), ST_ABSENT);
    assert_int_equal(st_find(store, "b", &found), ST_OK);
    assert_ptr_equal(found, a);
    st_release(found);

    st_mesh *c = create("a"), *d = create("c");
    assert_int_equal(st_list(store, "a", list, 1), 1);
    /* The store chose the id of one mesh itself (`info.id`), so this id may come before, between or
     * after the other ids in the list. */
    bool first = strcmp(info.id, "a") > 0 && strcmp(info.id, "b") < 0;
    assert_ptr_equal(list[0], first ? b : a);
    st_release(list[0]);
    int after = 2 + (strcmp(info.id, "aa") > 0);
    assert_int_equal(st_list(store, "aa", list, 4), after);
    for (int i = 0; i < after; i++) {
        st_release(list[i]);
    }
    st_release(a);
    st_release(b);
    st_release(c);
    st_release(d);
    assert_int_equal(st_store_count(store), 4);
}

static void a_removed_mesh_stays_for_its_readers(void **state)
{
    (void)state;
    st_mesh *mesh = create("m"), *found = NULL;
    uint64_t incarnation = info_of(mesh).incarnation;
    assert_int_equal(take_away(mesh), ST_OK);
    assert_int_equal(take_away(mesh), ST_ABSENT);
    assert_true(info_of(mesh).removed);
    assert_int_equal(st_find(store, "m", &found), ST_ABSENT);
    st_mesh *again = create("m");
    assert_true(info_of(again).incarnation != incarnation);
    assert_int_equal(take_away(mesh), ST_ABSENT);
    st_release(mesh);
    st_release(again);
}

static void too_many_meshes_are_refused(void **state)
{
    (void)state;
    st_store_free(store);
    open_store(BUDGET, 1);
    st_mesh *mesh = create("m"), *other = NULL;
    he_mesh *content = fixture_mesh("012");
    assert_int_equal(st_create(store, "n", NULL, content, NULL, &other), ST_TOO_MANY);
    assert_int_equal(st_create(store, "m", NULL, content, NULL, &other), ST_TAKEN);
    he_mesh_free(content);
    st_release(mesh);
}

static void undo_and_redo_make_revisions_and_history_entries(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    double first = x_of(mesh);
    assert_int_equal(step(mesh, ST_UNDO), ST_NOTHING);
    assert_int_equal(step(mesh, ST_REDO), ST_NOTHING);
    assert_int_equal(info_of(mesh).revision, 1);
    move(mesh, 10, false, NULL);
    st_mesh_info info;
    move(mesh, 20, false, &info);
    assert_int_equal(info.revision, 3);
    assert_int_equal(info.undo, 2);

    assert_int_equal(step(mesh, ST_UNDO), ST_OK);
    assert_true(x_of(mesh) == 10);
    assert_int_equal(step(mesh, ST_UNDO), ST_OK);
    assert_true(x_of(mesh) == first);
    assert_int_equal(step(mesh, ST_UNDO), ST_NOTHING);
    assert_int_equal(step(mesh, ST_REDO), ST_OK);
    assert_true(x_of(mesh) == 10);
    info = info_of(mesh);
    assert_int_equal(info.revision, 6);
    assert_int_equal(info.undo, 1);
    assert_int_equal(info.redo, 1);

    static const struct {
        uint64_t revision, inverts;
        st_action action;
        bool undoable;
    } rows[] = {
        {6, 2, ST_REDO, true},  {5, 2, ST_UNDO, false}, {4, 3, ST_UNDO, false},
        {3, 0, ST_EDIT, false}, {2, 0, ST_EDIT, false},
    };
    st_entry entry;
    st_read_begin(mesh, NULL);
    for (size_t i = 0; i < 5; i++) {
        assert_true(st_history_entry(mesh, i, &entry));
        assert_int_equal(entry.revision, rows[i].revision);
        assert_int_equal(entry.inverts, rows[i].inverts);
        assert_int_equal(entry.action, rows[i].action);
        assert_int_equal(entry.undoable, rows[i].undoable);
        assert_string_equal(entry.ops, "vertex_move");
        assert_true(entry.bytes > 0);
        assert_true(entry.time > 1e9);
    }
    assert_false(st_history_entry(mesh, 5, &entry));
    st_read_end(mesh);

    move(mesh, 30, false, &info);
    assert_int_equal(info.redo, 0);
    assert_int_equal(info.undo, 2);
    assert_int_equal(step(mesh, ST_REDO), ST_NOTHING);
    st_release(mesh);
}

static void an_aborted_write_leaves_the_mesh_as_it_was(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    he_mesh *before = NULL;
    const he_mesh *content = st_read_begin(mesh, NULL);
    assert_int_equal(he_mesh_copy(content, &before, NULL), HE_OK);
    st_read_end(mesh);
    for (int end = 0; end < 2; end++) {
        st_write w;
        he_vertex made;
        assert_int_equal(he_vertex_add(writing_begin(mesh, &w), (he_vec3){1, 2, 3}, &made, NULL),
                         HE_OK);
        if (end > 0) {
            assert_int_equal(st_write_changes(&w, NULL), HE_OK);
        }
        st_write_abort(&w);
        content = st_read_begin(mesh, NULL);
        assert_true(he_mesh_equal(content, before));
        st_read_end(mesh);
    }
    assert_int_equal(info_of(mesh).revision, 1);
    he_mesh_free(before);
    st_release(mesh);
}

static void a_barrier_and_a_replacement_end_the_undo_history(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    st_mesh_info info;
    move(mesh, 1, false, NULL);
    move(mesh, 2, true, &info);
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.revision, 3);
    move(mesh, 3, false, NULL);
    assert_int_equal(step(mesh, ST_UNDO), ST_OK);

    assert_int_equal(writing_replace(mesh, fixture_mesh("012"), NULL, &info), ST_OK);
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.redo, 0);
    assert_int_equal(info.revision, 6);
    const he_mesh *content = st_read_begin(mesh, NULL);
    fixture_counts(content, 3, 3, 1);
    st_entry entry;
    assert_true(st_history_entry(mesh, 0, &entry));
    assert_int_equal(entry.action, ST_REPLACE);
    assert_false(entry.undoable);
    st_read_end(mesh);

    st_write w;
    assert_non_null(writing_begin(mesh, &w));
    st_write_rename(&w, "other");
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    info = w.info;
    assert_string_equal(info.name, "other");
    assert_int_equal(info.metadata, 2);
    assert_int_equal(info.revision, 6);
    move(mesh, 9, false, NULL);
    assert_int_equal(step(mesh, ST_UNDO), ST_OK);
    st_release(mesh);
}

static void the_undo_history_stays_within_its_budget(void **state)
{
    (void)state;
    st_store_free(store);
    enum { SMALL_BUDGET = 4000, EDITS = 200 };
    open_store(SMALL_BUDGET, MESHES);
    st_mesh *mesh = create("m");
    st_mesh_info info = {0};
    for (int i = 0; i < EDITS; i++) {
        move(mesh, i + 1, false, &info);
    }
    assert_true(info.undo > 1);
    assert_true(info.undo < EDITS / 2);
    uint32_t steps = info.undo;
    for (uint32_t i = 0; i < steps; i++) {
        uint32_t left = info_of(mesh).undo;
        assert_int_equal(step(mesh, ST_UNDO), left > 0 ? ST_OK : ST_NOTHING);
    }
    assert_true(x_of(mesh) < EDITS - 2);

    /* An edit that is larger than the undo budget must be applied, but afterwards neither this edit
     * nor any earlier edit can be undone. */
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    for (int i = 0; i < EDITS; i++) {
        he_vertex made;
        assert_int_equal(he_vertex_add(content, (he_vec3){1, 2, 3}, &made, NULL), HE_OK);
    }
    assert_true(writing_commit(&w, "vertex_add", &info));
    assert_int_equal(info.undo, 0);
    assert_int_equal(info.redo, 0);
    st_entry entry;
    st_read_begin(mesh, NULL);
    assert_true(st_history_entry(mesh, 0, &entry));
    assert_false(entry.undoable);
    assert_true(entry.bytes > SMALL_BUDGET);
    st_read_end(mesh);
    st_release(mesh);
}

static void long_names_of_operations_are_cut(void **state)
{
    (void)state;
    char ops[1000];
    size_t at = 0;
    while (at < 900) {
        at += (size_t)snprintf(ops + at, sizeof ops - at, "%svertex_move", at == 0 ? "" : ",");
    }
    st_mesh *mesh = create("m");
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    he_vertex made;
    assert_int_equal(he_vertex_add(content, (he_vec3){0}, &made, NULL), HE_OK);
    assert_true(writing_commit(&w, ops, NULL));
    st_entry entry;
    st_read_begin(mesh, NULL);
    assert_true(st_history_entry(mesh, 0, &entry));
    st_read_end(mesh);
    size_t length = strlen(entry.ops);
    assert_true(length < ST_ENTRY_OPS);
    assert_string_equal(entry.ops + length - strlen("vertex_move,..."), "vertex_move,...");
    st_release(mesh);
}

static void a_held_snapshot_does_not_change_and_a_new_one_is_current(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    st_snapshot *a = NULL, *b = NULL;
    st_mesh_info info;
    move(mesh, 1, false, NULL);
    assert_int_equal(st_snapshot_take(mesh, &a), ST_OK);
    assert_int_equal(st_snapshot_take(mesh, &b), ST_OK);
    const he_mesh *shared = st_snapshot_content(a, &info);
    assert_ptr_equal(st_snapshot_content(b, NULL), shared);
    assert_int_equal(info.revision, 2);

    /* A snapshot must not change as long as the test holds a reference to it. */
    move(mesh, 2, false, NULL);
    assert_true(he_position(shared, (he_vertex){0}).x == 1);
    st_snapshot_release(b);
    assert_int_equal(st_snapshot_take(mesh, &b), ST_OK);
    assert_ptr_not_equal(st_snapshot_content(b, &info), shared);
    assert_int_equal(info.revision, 3);
    assert_true(he_position(st_snapshot_content(b, NULL), (he_vertex){0}).x == 2);
    st_snapshot_release(a);
    st_snapshot_release(b);

    /* A new snapshot must show the present mesh, even if the store makes it by updating a snapshot
     * that was released, and even after an undo or after an edit that adds elements. */
    for (int round = 0; round < 4; round++) {
        if (round == 1) {
            assert_int_equal(step(mesh, ST_UNDO), ST_OK);
        } else if (round == 2) {
            st_write w;
            he_mesh *content = writing_begin(mesh, &w);
            he_vertex made;
            assert_int_equal(he_vertex_add(content, (he_vec3){7, 8, 9}, &made, NULL), HE_OK);
            assert_true(writing_commit(&w, "vertex_add", NULL));
        } else {
            move(mesh, 10 + round, false, NULL);
        }
        assert_int_equal(st_snapshot_take(mesh, &a), ST_OK);
        const he_mesh *content = st_read_begin(mesh, NULL);
        assert_true(he_mesh_equal(st_snapshot_content(a, NULL), content));
        st_read_end(mesh);
        st_snapshot_release(a);
    }

    /* A snapshot that is referenced must stay when its mesh is deleted. */
    assert_int_equal(st_snapshot_take(mesh, &a), ST_OK);
    assert_int_equal(take_away(mesh), ST_OK);
    st_release(mesh);
    assert_int_equal(he_mesh_vertices(st_snapshot_content(a, NULL)), 5);
    st_snapshot_release(a);
}

static uint64_t bytes_of_copies(void)
{
    st_store_measures measures;
    st_store_measure(store, &measures);
    return measures.snapshot_bytes;
}

static void a_copy_that_nobody_uses_is_freed(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    st_snapshot *a = NULL, *b = NULL, *past = NULL;
    move(mesh, 1, false, NULL);
    assert_int_equal(st_snapshot_take(mesh, &a), ST_OK);
    const he_mesh *shared = st_snapshot_content(a, NULL);
    st_store_expire_copies(store, UINT64_MAX); /* the copy is in use */
    assert_true(bytes_of_copies() > 0);
    assert_true(he_position(shared, (he_vertex){0}).x == 1);
    st_snapshot_release(a);
    st_store_expire_copies(store, 0); /* the copy was used later */
    assert_int_equal(st_snapshot_take(mesh, &b), ST_OK);
    assert_ptr_equal(st_snapshot_content(b, NULL), shared);
    st_snapshot_release(b);
    assert_int_equal(st_snapshot_at(mesh, 1, &past), ST_OK);
    st_snapshot_release(past);
    const uint64_t both = bytes_of_copies();
    st_store_expire_copies(store, st_clock_micros() + 1000000); /* the present revision only */
    assert_in_range(bytes_of_copies(), 1, both - 1);
    st_store_expire_copies(store, UINT64_MAX);
    assert_int_equal(bytes_of_copies(), 0);
    assert_int_equal(st_snapshot_take(mesh, &a), ST_OK);
    assert_true(he_position(st_snapshot_content(a, NULL), (he_vertex){0}).x == 1);
    st_snapshot_release(a);
    st_release(mesh);
}

static void a_cached_value_lasts_until_the_mesh_changes(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    int value = 7, got = 0;
    long other;
    st_read_begin(mesh, NULL);
    assert_false(st_cache_get(mesh, &got, sizeof got));
    st_cache_put(mesh, &value, sizeof value);
    assert_true(st_cache_get(mesh, &got, sizeof got));
    assert_int_equal(got, 7);
    assert_false(st_cache_get(mesh, &other, sizeof other));
    st_read_end(mesh);
    move(mesh, 1, false, NULL);
    st_read_begin(mesh, NULL);
    assert_false(st_cache_get(mesh, &got, sizeof got));
    st_read_end(mesh);
    st_release(mesh);
}

/* Each call of the store is repeated once for each of its allocations; in each repetition one
 * allocation fails. The call must be refused, and the mesh must be unchanged. */
static void calls_without_memory_are_refused_and_change_nothing(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        assert_true(f.n < 200);
        failing_pause();
        st_mesh *made = NULL;
        st_snapshot *snapshot = NULL;
        he_mesh *content = fixture_mesh("012,023");
        bool all = true;
        failing_resume();
        st_status status = st_create(store, NULL, "x", content, NULL, &made);
        if (status != ST_OK) {
            assert_int_equal(status, ST_NO_MEMORY);
            all = false;
        }
        st_write w;
        he_mesh *writing = writing_begin(mesh, &w);
        if (writing != NULL) {
            uint32_t vertex = 0;
            he_vec3 point = {(double)f.n, 0, 0};
            if (he_vertex_move(writing, &vertex, 1, HE_MOVE_TO, &point, 1, NULL) == HE_OK) {
                all = writing_commit(&w, "vertex_move", NULL) && all;
            } else {
                st_write_abort(&w);
                all = false;
            }
        } else {
            all = false;
        }
        if (st_snapshot_take(mesh, &snapshot) != ST_OK) {
            all = false;
        }
        failing_end(&f, all);
        if (snapshot != NULL) {
            const he_mesh *now = st_read_begin(mesh, NULL);
            assert_true(he_mesh_equal_live(st_snapshot_content(snapshot, NULL), now));
            st_read_end(mesh);
            st_snapshot_release(snapshot);
        }
        if (status == ST_OK) {
            assert_int_equal(take_away(made), ST_OK);
            st_release(made);
        } else {
            he_mesh_free(content);
        }
    }
    assert_true(f.n > 1);
    st_release(mesh);
}

/* Memory counts as short when the next large block does not fit into the budget, although a smaller
 * block would still fit. */
static void memory_is_short_before_it_is_full(void **state)
{
    (void)state;
    enum { FILLING = 8 << 20 };
    st_store_free(store);
    st_memory_install(0);
    open_store(BUDGET, MESHES);
    void *filling = he_mem_alloc(FILLING);
    assert_non_null(filling);
    const uint64_t used = st_memory_used();
    st_memory_set_budget(used / 93 * 100);
    assert_false(st_memory_is_full());
    assert_true(st_memory_is_short());
    assert_null(he_mem_alloc(st_memory_budget() / ST_MEMORY_SHORT_SHARE));
    st_memory_set_budget(used / 90 * 100);
    assert_false(st_memory_is_short());
    void *more = he_mem_alloc(st_memory_budget() / ST_MEMORY_SHORT_SHARE);
    assert_non_null(more);
    he_mem_free(more);
    st_memory_set_budget(0);
    assert_false(st_memory_is_short());
    he_mem_free(filling);
    st_store_free(store);
    he_mem_set_hook(NULL);
    open_store(BUDGET, MESHES);
}

static void memory_beyond_the_budget_is_refused_and_caches_make_room(void **state)
{
    (void)state;
    st_store_free(store);
    st_memory_install(0);
    open_store(BUDGET, MESHES);
    st_mesh *mesh = create("m"), *other = NULL;
    assert_true(st_memory_used() > he_mesh_bytes(st_read_begin(mesh, NULL)));
    st_read_end(mesh);

    he_mesh *content = fixture_mesh("012");
    st_memory_set_budget(st_memory_used());
    assert_true(st_memory_is_full());
    assert_int_equal(st_create(store, "n", NULL, content, NULL, &other), ST_BUDGET);
    assert_null(he_mem_alloc(1 << 20));
    /* If a write needs more memory than is free, the store must free caches for it. */
    st_memory_set_budget(0);
    st_snapshot *snapshot = NULL;
    assert_int_equal(st_snapshot_take(mesh, &snapshot), ST_OK);
    st_snapshot_release(snapshot);
    void *filling = he_mem_alloc(1 << 20);
    uint64_t with_copy = st_memory_used();
    st_memory_set_budget(with_copy + with_copy / 32);
    assert_true(st_memory_is_full());
    st_write w;
    assert_non_null(writing_begin(mesh, &w));
    st_write_abort(&w);
    uint64_t without = st_memory_used();
    st_store_shed(store);
    assert_true(st_memory_used() == without);
    he_mem_free(filling);
    uint64_t used = st_memory_used();
    st_memory_set_budget(0);
    void *block = he_mem_alloc(100000);
    assert_true(st_memory_used() >= used + 100000);
    block = he_mem_resize(block, 10);
    assert_true(st_memory_used() < used + 10000);
    he_mem_free(block);
    assert_int_equal(st_memory_used(), used);
    he_mesh_free(content);
    st_release(mesh);
    st_store_free(store);
    assert_int_equal(st_memory_used(), 0);
    he_mem_set_hook(NULL);
    open_store(BUDGET, MESHES);
}

/* Each edit of a writer moves the vertices 0 and 1 to one point. Readers must never see the two
 * vertices at different points, and must never see the revision decrease. */
enum { ROUNDS = 300, WRITERS = 2, READERS = 2 };
static _Atomic bool broken;

/* --- data that is derived from the mesh data of a revision and kept with it --- */

static atomic_int destroyed;

static void destroy(void *value)
{
    he_mem_free(value);
    atomic_fetch_add(&destroyed, 1);
}

/* Makes data of each derived kind for the mesh, as requests do. */
static void derive(st_mesh *mesh)
{
    for (int kind = 0; kind < ST_DERIVED_COUNT; kind++) {
        st_derived *kept = st_derived_begin(mesh, (st_derived_kind)kind);
        assert_null(kept->value);
        *kept = (st_derived){he_mem_alloc(1000), destroy};
        st_derived_end(mesh, (st_derived_kind)kind);
    }
}

static void derived_values_are_freed_by_shedding_and_with_the_mesh(void **state)
{
    (void)state;
    atomic_store(&destroyed, 0);
    st_mesh *mesh = create("a");
    derive(mesh);
    move(mesh, 1, false, NULL);
    st_derived *kept = st_derived_begin(mesh, ST_DERIVED_SLOTS);
    assert_non_null(kept->value);
    st_derived_end(mesh, ST_DERIVED_SLOTS);
    st_store_shed(store);
    assert_int_equal(atomic_load(&destroyed), ST_DERIVED_COUNT);
    derive(mesh);
    assert_int_equal(take_away(mesh), ST_OK);
    assert_int_equal(atomic_load(&destroyed), ST_DERIVED_COUNT);
    st_release(mesh);
    assert_int_equal(atomic_load(&destroyed), 2 * ST_DERIVED_COUNT);
}

/* The store must have the delta of each revision as long as its history keeps the revision. A
 * barrier (an edit that cannot be undone) removes all earlier revisions from the history. */
static void each_revision_has_its_delta_until_a_barrier(void **state)
{
    (void)state;
    st_mesh *mesh = create("a");
    move(mesh, 1, false, NULL);
    move(mesh, 2, false, NULL);
    assert_int_equal(step(mesh, ST_UNDO), ST_OK);
    st_read_begin(mesh, NULL);
    assert_null(st_revision_delta(mesh, 0));
    assert_null(st_revision_delta(mesh, 1));
    const he_delta *third = st_revision_delta(mesh, 3);
    assert_non_null(st_revision_delta(mesh, 2));
    assert_true(third != NULL && third != st_revision_delta(mesh, 2));
    assert_ptr_equal(st_revision_delta(mesh, 4), third);
    assert_null(st_revision_delta(mesh, 5));
    assert_null(st_revision_delta(mesh, UINT64_MAX));
    st_read_end(mesh);
    move(mesh, 3, true, NULL);
    st_read_begin(mesh, NULL);
    for (uint64_t revision = 0; revision < 8; revision++) {
        assert_null(st_revision_delta(mesh, revision));
    }
    st_read_end(mesh);
    st_release(mesh);
}

static void *write_some(void *context)
{
    st_mesh *mesh = context;
    for (int i = 0; i < ROUNDS; i++) {
        st_write w;
        he_mesh *content = writing_begin(mesh, &w);
        uint32_t vertices[] = {0, 1};
        he_vec3 point = {i, i, i};
        if (content == NULL) {
            atomic_store(&broken, true);
            break;
        }
        if (i % 7 == 3) {
            if (st_write_step(&w, i % 2 ? ST_UNDO : ST_REDO, 1) == ST_OK) {
                (void)st_write_commit(&w, NULL);
            } else {
                st_write_abort(&w);
            }
        } else if (he_vertex_move(content, vertices, 2, HE_MOVE_TO, &point, 1, NULL) != HE_OK) {
            atomic_store(&broken, true);
            st_write_abort(&w);
        } else if (i % 5 == 0) {
            st_write_abort(&w);
        } else if (!writing_commit(&w, "vertex_move", NULL)) {
            atomic_store(&broken, true);
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
    st_mesh *mesh = context;
    uint64_t last = 0;
    for (int i = 0; i < ROUNDS; i++) {
        st_mesh_info info;
        st_snapshot *snapshot = NULL;
        const he_mesh *content = st_read_begin(mesh, &info);
        bool good = together(content) && info.revision >= last;
        last = info.revision;
        int value = i;
        st_cache_put(mesh, &value, sizeof value);
        good = good && st_cache_get(mesh, &value, sizeof value);
        st_read_end(mesh);
        good = good && st_snapshot_take(mesh, &snapshot) == ST_OK;
        if (snapshot != NULL) {
            good = good && together(st_snapshot_content(snapshot, NULL));
            st_snapshot_release(snapshot);
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
        st_mesh *mesh = NULL;
        snprintf(id, sizeof id, "t%d", i % 5);
        he_mesh *content = he_mesh_new();
        if (st_create(store, id, NULL, content, NULL, &mesh) != ST_OK) {
            he_mesh_free(content);
            if (st_find(store, id, &mesh) != ST_OK) {
                continue;
            }
        }
        st_status status = take_away(mesh);
        (void)status;
        st_release(mesh);
    }
    return NULL;
}

static void concurrent_readers_see_only_whole_writes(void **state)
{
    (void)state;
    st_mesh *mesh = create("m");
    st_write w;
    he_mesh *content = writing_begin(mesh, &w);
    uint32_t vertices[] = {0, 1};
    he_vec3 point = {0, 0, 0};
    assert_int_equal(he_vertex_move(content, vertices, 2, HE_MOVE_TO, &point, 1, NULL), HE_OK);
    assert_int_equal(he_compact(content, NULL, NULL), HE_OK);
    assert_true(writing_commit(&w, "vertex_move", NULL));
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
    const he_mesh *final = st_read_begin(mesh, NULL);
    fixture_check(final);
    st_read_end(mesh);
    st_release(mesh);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(ids_are_unique_and_listed_in_order),
        TEST(a_removed_mesh_stays_for_its_readers),
        TEST(too_many_meshes_are_refused),
        TEST(undo_and_redo_make_revisions_and_history_entries),
        TEST(an_aborted_write_leaves_the_mesh_as_it_was),
        TEST(a_barrier_and_a_replacement_end_the_undo_history),
        TEST(the_undo_history_stays_within_its_budget),
        TEST(long_names_of_operations_are_cut),
        TEST(a_held_snapshot_does_not_change_and_a_new_one_is_current),
        TEST(a_copy_that_nobody_uses_is_freed),
        TEST(a_cached_value_lasts_until_the_mesh_changes),
        TEST(calls_without_memory_are_refused_and_change_nothing),
        TEST(memory_is_short_before_it_is_full),
        TEST(memory_beyond_the_budget_is_refused_and_caches_make_room),
        TEST(derived_values_are_freed_by_shedding_and_with_the_mesh),
        TEST(each_revision_has_its_delta_until_a_barrier),
        TEST(concurrent_readers_see_only_whole_writes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
