/* Tests of loading meshes from the journal: a mesh that left memory after random edits and was
 * loaded again must equal the mesh before that, and so must its history. */
#include "tests/kept_journal.h"
#include "tests/seed.h"
#include "tests/unit/edit_log.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/unit/kept_store.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "mesh/compact.h"
#include "mesh/write.h"
#include "store/followers.h"
#include "store/publish/limits.h"
#include "store/table.h"
#include "stored/stored.h"
#include "tests/failing.h"

#include <semaphore.h>

static kept_journal *journal;

static st_store *open_store(uint64_t budget)
{
    return kept_store_open(journal, budget, NULL);
}

/* --- a mesh with random changes --- */

static void script(he_mesh *m, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void script(he_mesh *m, const char *format, ...)
{
    char text[128];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    (void)script_run(m, text, NULL, NULL);
}

static void edit_once(he_mesh *m, md_random *random, unsigned serial)
{
    size_t slot = he_mesh_columns(m);
    switch (md_below(random, 9)) {
    case 0:
        edit_log_add_column(m, random, serial);
        break;
    case 1:
        while (slot > 0 && he_mesh_column(m, slot - 1) == NULL) {
            slot--;
        }
        if (slot > 3) {
            assert_int_equal(he_mesh_drop_column(m, slot - 1, NULL), HE_OK);
        }
        break;
    case 2:
    case 3:
        script(m, "face_poke face=#%u", md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    case 4:
        script(m, "face_delete face=#%u", md_below(random, he_mesh_issued(m, HE_FACE)));
        break;
    case 5:
        if (he_mesh_faces(m) < 200) {
            script(m, "subdivide scheme=linear");
        }
        break;
    default:
        script(m, "vertex_add position=%u,1,%u", serial, md_below(random, 9));
        break;
    }
}

static void edit(st_mesh *mesh, md_random *random, unsigned serial)
{
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    assert_non_null(m);
    for (uint32_t i = md_from(random, 1, 3); i > 0; i--) {
        edit_once(m, random, 4 * serial + i);
    }
    if (md_chance(random, 4)) {
        assert_int_equal(he_compact(m, NULL, NULL), HE_OK);
    }
    if (w.delta->count > 0) {
        assert_true(writing_commit(&w, "vertex_add,face_poke", NULL));
    } else {
        st_write_abort(&w);
    }
}

/* Names a random revision, if the history still has its entry and room for the name. */
static void name_moment(st_mesh *mesh, md_random *random, unsigned serial)
{
    char name[ST_MOMENT_NAME + 1];
    st_write w;
    assert_non_null(writing_begin(mesh, &w));
    snprintf(name, sizeof name, "%.*u", (int)md_below(random, ST_MOMENT_NAME), serial);
    const uint64_t revision = md_from(random, 1, (uint32_t)w.info.revision);
    if (st_write_moment(&w, revision, md_chance(random, 20) ? "" : name) == ST_OK) {
        assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    } else {
        st_write_abort(&w);
    }
}

static void change(st_mesh *mesh, md_random *random, unsigned serial)
{
    char name[32];
    st_write w;
    switch (md_below(random, 24)) {
    case 0:
        assert_int_equal(writing_replace(mesh, script_mesh("012,023,034", NULL),
                                         serial % 2 == 0 ? "replaced" : NULL, NULL),
                         ST_OK);
        break;
    case 1:
        assert_non_null(writing_begin(mesh, &w));
        snprintf(name, sizeof name, "name %u", serial);
        st_write_rename(&w, name);
        assert_int_equal(st_write_commit(&w, NULL), ST_OK);
        break;
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
        (void)writing_step(mesh, ST_UNDO, md_from(random, 1, 4));
        break;
    case 7:
    case 8:
    case 9:
        (void)writing_step(mesh, ST_REDO, md_from(random, 1, 3));
        break;
    case 10:
    case 11:
        name_moment(mesh, random, serial);
        break;
    default:
        edit(mesh, random, serial);
        break;
    }
}

/* --- comparing the loaded mesh with the mesh that left memory --- */

static he_mesh *content_of(st_mesh *mesh)
{
    he_mesh *copy = copy_of(st_read_begin(mesh, NULL));
    st_read_end(mesh);
    return copy;
}

static void expect_contents(st_mesh *was, st_mesh *is)
{
    he_mesh *m = content_of(was), *n = content_of(is);
    assert_true(he_mesh_equal_live(m, n));
    he_mesh_free(m);
    he_mesh_free(n);
}

static uint64_t dropped_by(st_mesh *mesh)
{
    st_history reach;
    st_history_reach(mesh, &reach);
    return reach.dropped;
}

/* Applies undo (or redo) to the meshes `was` and `is` as often as possible, and requires equal
 * states. Each step makes a revision, for which the histories may have to drop old entries. Since
 * some entries take more bytes in one mesh than in the other, the history of `is` may drop an entry
 * earlier than the history of `was`; the function then returns false. The caller must make the
 * journal ignore these steps. */
static bool expect_stack(st_mesh *was, st_mesh *is, st_action which)
{
    while (writing_step(was, which, 1) == ST_OK) {
        st_status status = writing_step(is, which, 1);
        if (status == ST_NOTHING && dropped_by(is) > dropped_by(was)) {
            return false;
        }
        assert_int_equal(status, ST_OK);
        expect_contents(was, is);
    }
    return true;
}

static void expect_stacks(st_mesh *was, st_mesh *is)
{
    if (expect_stack(was, is, ST_UNDO)) {
        (void)expect_stack(was, is, ST_REDO);
    }
}

/* Loads the mesh into another store, and requires that the loaded mesh equals the given one.
 * Returns the other store. */
static st_store *expect_loads(st_mesh *mesh, uint64_t budget, st_mesh **loaded)
{
    st_store *other = open_store(budget);
    *loaded = kept_store_load(other, "m");
    kept_store_expect_same(mesh, *loaded);
    return other;
}

/* Called at the end of a test: requires that the loaded mesh equals the old one, and that undo and
 * redo lead to equal states in the two meshes. */
static void expect_loads_with_stacks(st_mesh *mesh, uint64_t budget)
{
    st_mesh *loaded;
    st_store *other = expect_loads(mesh, budget, &loaded);
    kept_journal_ignore(journal);
    expect_stacks(mesh, loaded);
    st_release(loaded);
    st_release(mesh);
    st_store_free(other);
}

enum { ROUNDS = 12, CHANGES = 80 };

/* The test changes a mesh and loads it again and again, and once more at the end. Each time the
 * loaded mesh must equal the changed one. */
static void a_mesh_comes_back_as_it_was(void **state)
{
    (void)state;
    static const uint64_t budgets[] = {64 << 20, 30000, 6000, 1500, 0};
    md_random random = {seed_of_run()};
    for (unsigned round = 0; round < ROUNDS; round++) {
        uint64_t budget = budgets[round % 5];
        journal = kept_journal_new();
        st_store *store = open_store(budget);
        st_mesh *mesh = kept_store_make(store, "m");
        for (unsigned i = 0; i < CHANGES; i++) {
            change(mesh, &random, i);
            if (md_chance(&random, 15)) {
                st_mesh *loaded;
                st_store *other = expect_loads(mesh, budget, &loaded);
                /* The loaded mesh must accept further edits, and its history must continue. */
                st_release(mesh);
                st_store_free(store);
                mesh = loaded;
                store = other;
            }
        }
        expect_loads_with_stacks(mesh, budget);
        st_store_free(store);
        kept_journal_free(journal);
    }
}

/* A long edit makes more changes than fit into one record, so the journal must store the changes in
 * parts. */
static void a_large_edit_comes_back_from_its_parts(void **state)
{
    (void)state;
    enum { ADDED = 20000 };
    journal = kept_journal_new();
    st_store *store = open_store(64 << 20);
    st_mesh *mesh = kept_store_make(store, "m");
    st_write w;
    assert_int_equal(st_write_claim(mesh, NULL, &w), ST_OK);
    assert_int_equal(st_write_copy(&w, NULL, NULL), HE_OK);
    for (unsigned i = 0; i < ADDED; i++) {
        he_vertex added;
        assert_int_equal(he_vertex_add(w.content, (he_vec3){i, 1, 2}, &added, NULL), HE_OK);
    }
    const size_t bound = he_stored_edit_bound(w.delta, w.content);
    assert_true(bound > ST_BODY_BYTES);
    assert_true(writing_commit(&w, "vertex_add", NULL));
    assert_int_equal(kept_journal_staged_edits(journal), 1);
    md_random random = {seed_of_run()};
    for (unsigned i = 0; i < 4; i++) {
        edit(mesh, &random, i);
    }
    expect_loads_with_stacks(mesh, 64 << 20);
    st_store_free(store);
    kept_journal_free(journal);
}

/* A task that signals that it has run. The pool runs the tasks of one mesh in order, so all earlier
 * tasks of the mesh have then been done. */
static void post(void *context)
{
    sem_post(context);
}

static void await_bases(st_pool *pool)
{
    sem_t done;
    sem_init(&done, 0, 0);
    const st_task task = {
        .work = post, .context = &done, .share = ST_SHARE_JOB, .flow = st_pool_flow("", "m")};
    assert_true(st_pool_submit(pool, &task));
    sem_wait(&done);
    sem_destroy(&done);
}

static void a_younger_base_leads_to_the_same_mesh(void **state)
{
    (void)state;
    static const uint64_t budgets[] = {64 << 20, 20000, 6000, 0};
    md_random random = {seed_of_run()};
    unsigned bases = 0;
    for (unsigned round = 0; round < ROUNDS; round++) {
        uint64_t budget = budgets[round % 4], base = 1;
        journal = kept_journal_new();
        st_pool *pool = st_pool_new("bases", 3, 100);
        st_store *store = kept_store_open(journal, budget, pool);
        st_mesh *mesh = kept_store_make(store, "m");
        for (unsigned i = 0; i < 2 * CHANGES; i++) {
            change(mesh, &random, i);
            if (md_chance(&random, 20)) {
                await_bases(pool);
                st_mesh *loaded;
                st_store *other = expect_loads(mesh, budget, &loaded);
                st_release(loaded);
                st_store_free(other);
                uint64_t now = kept_journal_facts(journal, "m").base;
                assert_true(now >= base);
                bases += now > base;
                base = now;
            }
        }
        await_bases(pool);
        expect_loads_with_stacks(mesh, budget);
        st_pool_free(pool);
        st_store_free(store);
        kept_journal_free(journal);
    }
    printf("note: %u younger bases\n", bases);
    assert_true(bases > ROUNDS);
}

static void a_smaller_budget_keeps_the_newest(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    journal = kept_journal_new();
    st_store *store = open_store(64 << 20);
    st_mesh *mesh = kept_store_make(store, "m");
    for (unsigned i = 0; i < CHANGES; i++) {
        edit(mesh, &random, i);
        (void)writing_step(mesh, i % 3 == 0 ? ST_UNDO : ST_REDO, 1);
    }
    for (uint64_t budget = 20000; budget > 500; budget /= 2) {
        st_store *other = open_store(budget);
        st_mesh *loaded = kept_store_load(other, "m");
        st_history reach;
        st_history_reach(loaded, &reach);
        assert_true(reach.bytes / 2 <= budget || reach.bytes < 700);
        expect_contents(mesh, loaded);
        st_release(loaded);
        st_store_free(other);
    }
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

/* A revision that is no longer in the history in memory must be read from the disk, as long as the
 * disk has the records of the revision. */
static void a_revision_beyond_memory_is_read_from_the_disk(void **state)
{
    (void)state;
    enum { REVISIONS = 40 };
    md_random random = {seed_of_run()};
    journal = kept_journal_new();
    st_store *store = open_store(3000);
    st_mesh *mesh = kept_store_make(store, "m");
    he_mesh *at[REVISIONS + 1] = {NULL, content_of(mesh)};
    st_mesh_info info;
    uint64_t head = 1;
    for (unsigned i = 0; head < REVISIONS; i++) {
        change(mesh, &random, i);
        (void)st_read_begin(mesh, &info);
        st_read_end(mesh);
        head = info.revision;
        if (head <= REVISIONS && at[head] == NULL) {
            at[head] = content_of(mesh);
        }
    }
    st_history reach;
    st_history_reach(mesh, &reach);
    assert_true(reach.dropped > 2);
    for (uint64_t revision = 1; revision <= REVISIONS; revision++) {
        st_snapshot *snapshot;
        assert_int_equal(st_snapshot_at(mesh, revision, &snapshot), ST_OK);
        const he_mesh *content = st_snapshot_content(snapshot, &info);
        assert_int_equal(info.revision, revision);
        assert_true(at[revision] == NULL || he_mesh_equal(content, at[revision]));
        st_snapshot_release(snapshot);
        he_mesh_free(at[revision]);
    }
    st_snapshot *none;
    assert_int_equal(st_snapshot_at(mesh, head + 1, &none), ST_AHEAD);
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

/* Makes a mesh with many edits, without keeping undo history in memory. Then waits until the store
 * has written a new base (a record with all mesh data) after most of these edits. */
static st_mesh *make_rebased(st_store **store, st_pool **pool)
{
    journal = kept_journal_new();
    *pool = st_pool_new("bases", 3, 100);
    *store = kept_store_open(journal, 0, *pool);
    st_mesh *mesh = kept_store_make(*store, "m");
    for (unsigned i = 0; i < 40; i++) {
        st_write w;
        script(writing_begin(mesh, &w), "vertex_move vertex=1 to=%u,1,2", i);
        assert_true(writing_commit(&w, "vertex_move", NULL));
    }
    await_bases(*pool);
    assert_true(kept_journal_facts(journal, "m").base > 2);
    return mesh;
}

static void end_rebased(st_mesh *mesh, st_store *store, st_pool *pool)
{
    st_release(mesh);
    st_pool_free(pool);
    st_store_free(store);
    kept_journal_free(journal);
}

static void a_revision_before_the_base_costs_no_load(void **state)
{
    (void)state;
    st_store *store;
    st_pool *pool;
    st_mesh *mesh = make_rebased(&store, &pool);
    st_snapshot *snapshot;
    for (uint64_t revision = 0; revision < kept_journal_facts(journal, "m").base; revision++) {
        assert_int_equal(st_snapshot_at(mesh, revision, &snapshot), ST_GONE);
    }
    assert_int_equal(kept_journal_facts(journal, "m").parts, 0);
    end_rebased(mesh, store, pool);
}

static void a_revision_of_the_disk_is_loaded_once_for_all_who_read_it(void **state)
{
    (void)state;
    journal = kept_journal_new();
    st_store *store = open_store(0);
    st_mesh *mesh = kept_store_make(store, "m");
    for (unsigned i = 0; i < 9; i++) {
        st_write w;
        script(writing_begin(mesh, &w), "vertex_move vertex=1 to=%u,1,2", i);
        assert_true(writing_commit(&w, "vertex_move", NULL));
    }
    double modified = 0;
    for (int i = 0; i < 5; i++) {
        st_snapshot *snapshot, *none;
        st_mesh_info info;
        assert_int_equal(st_snapshot_at(mesh, 4, &snapshot), ST_OK);
        (void)st_snapshot_content(snapshot, &info);
        assert_int_equal(info.revision, 4);
        assert_true(i == 0 || info.modified == modified);
        modified = info.modified;
        /* A request for a revision that does not exist must not make the store drop the copies of
         * other revisions that it keeps. */
        assert_int_equal(st_snapshot_at(mesh, 99, &none), ST_AHEAD);
        assert_int_equal(st_snapshot_at(mesh, 0, &none), ST_GONE);
        st_snapshot_release(snapshot);
    }
    assert_int_equal(kept_journal_facts(journal, "m").opened, 1);
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

/* Mesh data was written to the disk as a new base (the record from which a mesh is loaded). The
 * base is not used yet, because undo can still lead to earlier states. If the data of the mesh is
 * replaced now, the unused base must be deleted. */
static void a_base_that_waits_goes_with_the_content_it_was_of(void **state)
{
    (void)state;
    journal = kept_journal_new();
    st_pool *pool = st_pool_new("bases", 3, 100);
    st_store *store = kept_store_open(journal, 64 << 20, pool);
    st_mesh *mesh = kept_store_make(store, "m");
    for (unsigned i = 0; i < 40; i++) {
        st_write w;
        script(writing_begin(mesh, &w), "vertex_move vertex=1 to=%u,1,2", i);
        assert_true(writing_commit(&w, "vertex_move", NULL));
    }
    await_bases(pool);
    /* one new base is on the disk, but is not used yet */
    assert_int_equal(kept_journal_out(journal), 1);
    assert_int_equal(writing_replace(mesh, script_mesh("012,023", NULL), NULL, NULL), ST_OK);
    assert_int_equal(kept_journal_out(journal), 0);
    assert_int_equal(kept_journal_facts(journal, "m").base, 1);
    /* The replacement wrote all mesh data to the disk, so the store must not write the data again
     * as a new base. */
    await_bases(pool);
    assert_int_equal(kept_journal_out(journal), 0);
    end_rebased(mesh, store, pool);
}

/* --- loading while memory is short --- */

static void without_memory_nothing_is_loaded(void **state)
{
    (void)state;
    md_random random = {7};
    journal = kept_journal_new();
    st_store *store = open_store(1 << 20);
    st_mesh *mesh = kept_store_make(store, "m");
    for (unsigned i = 0; i < 30; i++) {
        change(mesh, &random, i);
    }
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        st_store *other = open_store(1 << 20);
        st_mesh *loaded = NULL;
        failing_resume();
        st_status status = st_load(other, "m", &loaded);
        assert_true(failing_end(&f, status == ST_OK) || status == ST_NO_MEMORY);
        if (status == ST_OK) {
            assert_string_equal(st_damage(loaded), "");
            kept_store_expect_same(mesh, loaded);
            st_release(loaded);
        } else {
            assert_false(kept_journal_facts(journal, "m").condemned);
            st_release(kept_store_load(other, "m")); /* succeeds with enough memory */
        }
        st_store_free(other);
    }
    printf("note: %ld allocations\n", f.n - 1);
    st_release(mesh);
    st_store_free(store);
    kept_journal_free(journal);
}

static st_status one_key(void *self, const char *id, st_take_key *take, void *context)
{
    (void)self;
    st_kept_key kept = {.key = {.text = "key", .digest = {1, 2}}, .id = id};
    return id == NULL || take(context, &kept) ? ST_OK : ST_NO_MEMORY;
}

static void without_memory_for_its_keys_nothing_is_loaded(void **state)
{
    (void)state;
    journal = kept_journal_new();
    st_store *store = open_store(1 << 20);
    st_release(kept_store_make(store, "m"));
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        st_store *other = open_store(1 << 20);
        st_mesh *loaded = NULL;
        other->journal.keys = one_key;
        failing_resume();
        st_status status = st_load(other, "m", &loaded);
        assert_true(failing_end(&f, status == ST_OK) || status == ST_NO_MEMORY);
        st_release(status == ST_OK ? loaded : kept_store_load(other, "m"));
        st_store_free(other);
    }
    st_store_free(store);
    kept_journal_free(journal);
}

/* --- lists of meshes --- */

static void a_list_has_what_is_in_memory_and_what_is_not(void **state)
{
    (void)state;
    journal = kept_journal_new();
    st_store *store = open_store(1 << 20);
    char id[8];
    for (unsigned i = 0; i < 40; i++) {
        snprintf(id, sizeof id, "m%02u", i);
        st_release(kept_store_make(store, id));
    }
    st_store_free(store);
    store = open_store(1 << 20);
    for (unsigned i = 0; i < 40; i += 3) {
        snprintf(id, sizeof id, "m%02u", i);
        st_release(kept_store_load(store, id));
    }
    st_card cards[7];
    size_t count = 7, all = 0;
    char after[ST_MESH_ID + 1] = "";
    while (count == 7) {
        assert_int_equal(st_cards(store, after, cards, 7, &count), ST_OK);
        for (size_t i = 0; i < count; i++, all++) {
            snprintf(id, sizeof id, "m%02zu", all);
            assert_string_equal(cards[i].id, id);
            assert_int_equal(cards[i].counts.faces, 5);
            snprintf(after, sizeof after, "%s", id);
        }
    }
    assert_int_equal(all, 40);
    assert_int_equal(st_store_count(store), 40);
    /* If a mesh is only on the disk, the store must know that its id is in use, without loading the
     * mesh. */
    st_mesh *mesh;
    he_mesh *content = fixture_mesh("012");
    size_t opened = kept_journal_facts(journal, "m01").opened;
    assert_int_equal(st_create(store, "m01", NULL, content, NULL, &mesh), ST_TAKEN);
    assert_int_equal(kept_journal_facts(journal, "m01").opened, opened);
    he_mesh_free(content);
    st_store_free(store);
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_comes_back_as_it_was),
        cmocka_unit_test(a_large_edit_comes_back_from_its_parts),
        cmocka_unit_test(a_younger_base_leads_to_the_same_mesh),
        cmocka_unit_test(a_revision_beyond_memory_is_read_from_the_disk),
        cmocka_unit_test(a_smaller_budget_keeps_the_newest),
        cmocka_unit_test(a_revision_before_the_base_costs_no_load),
        cmocka_unit_test(a_revision_of_the_disk_is_loaded_once_for_all_who_read_it),
        cmocka_unit_test(a_base_that_waits_goes_with_the_content_it_was_of),
        cmocka_unit_test(without_memory_nothing_is_loaded),
        cmocka_unit_test(without_memory_for_its_keys_nothing_is_loaded),
        cmocka_unit_test(a_list_has_what_is_in_memory_and_what_is_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
