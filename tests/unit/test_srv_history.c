/* Tests of the history of a stored mesh: snapshots of earlier revisions, and cursors that move from
 * revision to revision, must equal the mesh at the revision. Columns are added and removed, memory
 * is limited, and other threads write. */
#include "tests/unit/dense.h"
#include "tests/unit/edit_script.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/whole/positions.h"
#include "mesh/write.h"
#include "store/history_cursor.h"
#include "store/store.h"
#include "system/memory.h"
#include "tests/failing.h"
#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

enum { MOST = 300 };

static st_store *store;

static st_mesh *open_mesh(uint64_t budget)
{
    store = st_store_new(&(st_store_options){
        .undo_budget = budget, .max_meshes = 10, .journal = st_journal_memory()});
    assert_non_null(store);
    he_mesh *content = script_mesh("012,023,034,045,051", NULL);
    script_add_columns(content);
    st_mesh *mesh;
    assert_int_equal(st_create(store, "m", NULL, content, NULL, &mesh), ST_OK);
    return mesh;
}

static void close_mesh(st_mesh *mesh)
{
    st_release(mesh);
    st_store_free(store);
}

static void add_column(he_mesh *m, unsigned serial)
{
    char name[32];
    he_column *column;
    snprintf(name, sizeof name, "later%u", serial);
    assert_int_equal(
        he_column_new(&(he_column_schema){name, HE_VERTEX, HE_FLOAT, 2, HE_INTERPOLATE}, &column,
                      NULL),
        HE_OK);
    assert_int_equal(he_column_extend(column, he_mesh_issued(m, HE_VERTEX), NULL), HE_OK);
    assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
}

static void drop_column(he_mesh *m)
{
    size_t slot = he_mesh_columns(m);
    while (slot > 0 && he_mesh_column(m, slot - 1) == NULL) {
        slot--;
    }
    if (slot > 0) {
        assert_int_equal(he_mesh_drop_column(m, slot - 1, NULL), HE_OK);
    }
}

/* Makes a random edit. If the edit is refused, there is no new revision. */
static void edit(st_mesh *mesh, md_random *random, unsigned serial)
{
    char text[96];
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    assert_non_null(m);
    switch (md_below(random, 7)) {
    case 0:
        add_column(m, serial);
        break;
    case 1:
        drop_column(m);
        break;
    case 2:
        snprintf(text, sizeof text, "face_poke face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        (void)script_run(m, text, NULL, NULL);
        break;
    case 3:
        snprintf(text, sizeof text, "face_delete face=#%u",
                 md_below(random, he_mesh_issued(m, HE_FACE)));
        (void)script_run(m, text, NULL, NULL);
        break;
    default:
        snprintf(text, sizeof text, "vertex_add position=%u,1,%u", serial, md_below(random, 9));
        (void)script_run(m, text, NULL, NULL);
        break;
    }
    if (w.delta->count > 0) {
        assert_true(writing_commit(&w, "some", NULL));
    } else {
        st_write_abort(&w);
    }
}

static st_status step(st_mesh *mesh, st_action which, uint32_t steps)
{
    return writing_step(mesh, which, steps);
}

static void change(st_mesh *mesh, md_random *random, unsigned serial)
{
    uint32_t what = md_below(random, 5);
    if (what < 3) {
        edit(mesh, random, serial);
    } else {
        (void)step(mesh, what == 3 ? ST_UNDO : ST_REDO, 1 + md_below(random, 3));
    }
}

static uint64_t head_of(st_mesh *mesh, he_mesh **content)
{
    st_mesh_info info;
    const he_mesh *m = st_read_begin(mesh, &info);
    if (content != NULL) {
        *content = copy_of(m);
    }
    st_read_end(mesh);
    return info.revision;
}

/* Copies of the mesh at each revision. Undoing or redoing several steps passes revisions of which
 * there is no copy. */
typedef struct album {
    he_mesh *at[MOST];
    uint64_t head;
} album;

static void take_picture(album *a, st_mesh *mesh)
{
    he_mesh *content;
    uint64_t head = head_of(mesh, &content);
    if (head == a->head || head >= MOST) {
        he_mesh_free(content);
        return;
    }
    a->head = head;
    a->at[head] = content;
}

static void clear_album(album *a)
{
    for (size_t i = 0; i < MOST; i++) {
        he_mesh_free(a->at[i]);
    }
    *a = (album){0};
}

static void expect_picture(const album *a, uint64_t revision, const he_mesh *m)
{
    if (a->at[revision] != NULL && !he_mesh_equal(m, a->at[revision])) {
        fail_msg("revision %" PRIu64 " is not what it was", revision);
    }
}

static void expect_snapshot(const album *a, st_mesh *mesh, uint64_t revision)
{
    st_snapshot *snapshot;
    st_mesh_info info;
    assert_int_equal(st_snapshot_at(mesh, revision, &snapshot), ST_OK);
    const he_mesh *m = st_snapshot_content(snapshot, &info);
    assert_int_equal(info.revision, revision);
    expect_picture(a, revision, m);
    if (a->at[revision] != NULL) {
        assert_int_equal(st_elements_at(mesh, revision), he_mesh_issued(m, HE_VERTEX) +
                                                             he_mesh_issued(m, HE_HALFEDGE) +
                                                             he_mesh_issued(m, HE_FACE));
    }
    st_snapshot_release(snapshot);
}

static void snapshots_of_earlier_revisions(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    st_mesh *mesh = open_mesh(1 << 20);
    album pictures = {0};
    st_snapshot *held = NULL, *none;
    take_picture(&pictures, mesh);
    for (unsigned i = 0; pictures.head < 200; i++) {
        change(mesh, &random, i);
        take_picture(&pictures, mesh);
        uint64_t revision = 1 + md_below(&random, (uint32_t)pictures.head);
        expect_snapshot(&pictures, mesh, revision);
        /* the test uses a snapshot while the mesh changes 16 times, so the store must keep the copy
         * of the mesh to which the snapshot refers */
        if (i % 16 == 0) {
            if (held != NULL) {
                st_snapshot_release(held);
            }
            assert_int_equal(st_snapshot_at(mesh, revision, &held), ST_OK);
        }
        if (i % 32 == 0) {
            st_store_shed(store);
        }
        st_mesh_info info;
        const he_mesh *m = st_snapshot_content(held, &info);
        expect_picture(&pictures, info.revision, m);
    }
    st_snapshot_release(held);
    assert_int_equal(st_snapshot_at(mesh, pictures.head + 1, &none), ST_AHEAD);
    assert_int_equal(writing_replace(mesh, fixture_mesh("012"), NULL, NULL), ST_OK);
    assert_int_equal(st_snapshot_at(mesh, pictures.head, &none), ST_GONE);
    clear_album(&pictures);
    close_mesh(mesh);
}

static uint64_t bytes_of_copies(void)
{
    st_store_measures measures;
    st_store_measure(store, &measures);
    return measures.snapshot_bytes;
}

/* Moves all vertices of a mesh in one edit, whose delta has one record of all positions. */
static void lift(st_mesh *mesh)
{
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    he_column present, *points;
    assert_non_null(m);
    he_mesh_position_column(m, &present);
    assert_int_equal(he_column_copy(&present, &points, NULL), HE_OK);
    for (size_t v = 0; v < points->rows; v++) {
        ((he_vec3 *)(void *)he_column_row(points, v))->z += 0.1;
    }
    assert_int_equal(he_positions_put(m, points, NULL), HE_OK);
    assert_int_equal(w.delta->object_count, 1);
    assert_true(writing_commit(&w, "some", NULL));
}

/* The copy of an earlier revision keeps the positions of each edit that it crosses, to cross it
 * again. */
static void what_a_copy_keeps_to_cross_edits_is_counted(void **state)
{
    (void)state;
    enum { EDITS = 3 };
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 26, .max_meshes = 1, .journal = st_journal_memory()});
    assert_non_null(store);
    he_mesh *content = dense_grid(130, dense_waves, 1);
    const uint64_t positions = sizeof(he_vec3) * (uint64_t)he_mesh_issued(content, HE_VERTEX);
    st_mesh *mesh;
    st_snapshot *snapshot;
    album pictures = {0};
    assert_int_equal(st_create(store, "m", NULL, content, NULL, &mesh), ST_OK);
    take_picture(&pictures, mesh);
    const uint64_t first = pictures.head;
    for (unsigned i = 0; i < EDITS; i++) {
        lift(mesh);
        take_picture(&pictures, mesh);
        assert_int_equal(st_snapshot_take(mesh, &snapshot), ST_OK);
        expect_picture(&pictures, pictures.head, st_snapshot_content(snapshot, NULL));
        st_snapshot_release(snapshot);
    }
    st_store_shed(store);
    assert_int_equal(bytes_of_copies(), 0);
    for (uint64_t back = 1; back <= EDITS; back++) {
        const uint64_t revision = first + EDITS - back;
        expect_snapshot(&pictures, mesh, revision);
        assert_in_range(bytes_of_copies(), he_mesh_bytes(pictures.at[revision]) + back * positions,
                        he_mesh_bytes(pictures.at[revision]) + (back + 1) * positions);
    }
    st_store_shed(store);
    assert_int_equal(bytes_of_copies(), 0);
    clear_album(&pictures);
    close_mesh(mesh);
}

/* Requires that a snapshot of the present revision, made without copying the mesh, equals it. */
static void expect_moved(st_mesh *mesh)
{
    st_snapshot *snapshot;
    he_mesh *content;
    failing_at(0);
    assert_int_equal(st_snapshot_take(mesh, &snapshot), ST_OK);
    assert_int_equal(failing_count(), 1); /* the snapshot itself */
    failing_off();
    (void)head_of(mesh, &content);
    assert_true(he_mesh_equal(st_snapshot_content(snapshot, NULL), content));
    he_mesh_free(content);
    st_snapshot_release(snapshot);
}

static void a_copy_follows_edits_of_all_positions(void **state)
{
    (void)state;
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 26, .max_meshes = 1, .journal = st_journal_memory()});
    assert_non_null(store);
    st_mesh *mesh;
    st_snapshot *snapshot;
    assert_int_equal(st_create(store, "m", NULL, dense_grid(130, dense_waves, 1), NULL, &mesh),
                     ST_OK);
    assert_int_equal(st_snapshot_take(mesh, &snapshot), ST_OK);
    st_snapshot_release(snapshot);
    const uint64_t bytes = bytes_of_copies();
    for (unsigned i = 0; i < 3; i++) {
        lift(mesh);
        expect_moved(mesh);
        assert_int_equal(bytes_of_copies(), bytes);
    }
    assert_int_equal(step(mesh, ST_UNDO, 1), ST_OK);
    expect_moved(mesh);
    assert_int_equal(step(mesh, ST_UNDO, 1), ST_OK);
    expect_moved(mesh);
    assert_int_equal(step(mesh, ST_REDO, 1), ST_OK);
    expect_moved(mesh);
    /* an edit of one face before the one of all positions is crossed as usual */
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    assert_non_null(m);
    script_prepare(m, "face_delete face=#7");
    assert_true(writing_commit(&w, "some", NULL));
    lift(mesh);
    expect_moved(mesh);
    /* a copy that is two such edits behind is replaced */
    lift(mesh);
    lift(mesh);
    assert_int_equal(st_snapshot_take(mesh, &snapshot), ST_OK);
    he_mesh *content;
    (void)head_of(mesh, &content);
    assert_true(he_mesh_equal(st_snapshot_content(snapshot, NULL), content));
    he_mesh_free(content);
    st_snapshot_release(snapshot);
    close_mesh(mesh);
}

static void follow(const album *a, st_cursor *walk, uint64_t head)
{
    st_cursor_step at;
    uint64_t revision = st_cursor_revision(walk);
    expect_picture(a, revision, st_cursor_content(walk));
    while (revision < head) {
        assert_int_equal(st_cursor_next(walk, &at), ST_OK);
        assert_int_equal(at.revision, ++revision);
        assert_ptr_equal(at.content, st_cursor_content(walk));
        assert_int_equal(at.undone, at.action == ST_UNDO);
        expect_picture(a, revision, at.content);
        he_changes changes;
        assert_int_equal(
            he_changes_find(at.content, at.delta, 0, at.delta->count, at.undone, &changes, NULL),
            HE_OK);
        he_changes_clear(&changes);
    }
    assert_int_equal(st_cursor_next(walk, &at), ST_NOTHING);
}

static void a_walk_follows_the_mesh(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (int round = 0; round < 10; round++) {
        st_mesh *mesh = open_mesh(1 << 20);
        album pictures = {0};
        st_cursor *walk, *none;
        take_picture(&pictures, mesh);
        for (unsigned i = 0; i < 30; i++) {
            change(mesh, &random, i);
            take_picture(&pictures, mesh);
        }
        uint64_t from = 1 + md_below(&random, (uint32_t)pictures.head);
        assert_int_equal(st_cursor_begin(mesh, from, &walk), ST_OK);
        assert_int_equal(st_cursor_begin(mesh, pictures.head + 1, &none), ST_AHEAD);
        follow(&pictures, walk, pictures.head);
        /* A cursor must continue to work while the mesh changes and gets columns that older copies
         * of the mesh do not have. */
        for (unsigned i = 0; i < 30; i++) {
            change(mesh, &random, 100 + i);
            take_picture(&pictures, mesh);
            if (md_below(&random, 4) == 0) {
                follow(&pictures, walk, pictures.head);
            }
        }
        follow(&pictures, walk, pictures.head);
        st_cursor_end(walk);
        clear_album(&pictures);
        close_mesh(mesh);
    }
}

/* A cursor has returned mesh data and a delta. Both must stay valid after their entry was dropped
 * from the log of edits. After that, the cursor must report that the beginning of the history is
 * missing. */
static void a_walk_is_told_that_the_history_was_cut(void **state)
{
    (void)state;
    md_random random = {3};
    st_mesh *mesh = open_mesh(3000);
    st_cursor *walk;
    st_cursor_step at;
    for (unsigned i = 0; i < 5; i++) {
        edit(mesh, &random, i);
    }
    uint64_t head = head_of(mesh, NULL);
    assert_int_equal(st_cursor_begin(mesh, head - 1, &walk), ST_OK);
    assert_int_equal(st_cursor_next(walk, &at), ST_OK);
    assert_int_equal(at.revision, head);
    for (unsigned i = 0; i < 60; i++) {
        edit(mesh, &random, 10 + i);
    }
    he_changes changes;
    assert_int_equal(
        he_changes_find(at.content, at.delta, 0, at.delta->count, at.undone, &changes, NULL),
        HE_OK);
    he_changes_clear(&changes);
    assert_int_equal(st_cursor_next(walk, &at), ST_GONE);
    st_cursor_end(walk);
    assert_int_equal(st_cursor_begin(mesh, 2, &walk), ST_GONE);
    assert_int_equal(st_cursor_begin(mesh, head_of(mesh, NULL), &walk), ST_OK);
    assert_int_equal(writing_replace(mesh, fixture_mesh("012"), NULL, NULL), ST_OK);
    assert_int_equal(st_cursor_next(walk, &at), ST_GONE);
    st_cursor_end(walk);
    close_mesh(mesh);
}

/* --- memory --- */

/* If an edit added a column, an undo moves the column to the log of edits: its bytes must then be
 * counted in the log's budget. */
static void the_log_keeps_its_budget(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    for (uint64_t budget = 0; budget < 20000; budget = 2 * budget + 700) {
        st_mesh *mesh = open_mesh(budget);
        album pictures = {0};
        take_picture(&pictures, mesh);
        for (unsigned i = 0; i < 200; i++) {
            change(mesh, &random, i);
            take_picture(&pictures, mesh);
            st_history facts;
            st_history_reach(mesh, &facts);
            st_entry newest;
            bool any = st_history_entry(mesh, 0, &newest);
            assert_true(facts.bytes <= budget || (any && facts.bytes < 600));
            assert_true(facts.oldest <= pictures.head);
            expect_snapshot(&pictures, mesh, facts.oldest);
        }
        clear_album(&pictures);
        close_mesh(mesh);
    }
}

static void what_the_log_frees_is_free(void **state)
{
    (void)state;
    enum { BUDGET = 1 << 20 };
    md_random random = {5};
    st_memory_install(0);
    uint64_t before = st_memory_used();
    st_mesh *mesh = open_mesh(BUDGET);
    for (unsigned i = 0; i < 20000; i++) {
        st_write w;
        he_mesh *m = writing_begin(mesh, &w);
        char text[64];
        snprintf(text, sizeof text, "vertex_move vertex=%u to=%u,1,2", md_below(&random, 6), i);
        assert_int_equal(script_run(m, text, NULL, NULL), HE_OK);
        assert_true(writing_commit(&w, "vertex_move", NULL));
    }
    st_history facts;
    st_history_reach(mesh, &facts);
    uint64_t used = st_memory_used() - before;
    printf("note: a budget of %d bytes: %" PRIu64 " counted, %" PRIu64 " held in all\n", BUDGET,
           facts.bytes, used);
    assert_true(facts.dropped > 0);
    assert_true(used < BUDGET + BUDGET / 4);
    close_mesh(mesh);
    assert_true(st_memory_used() == before);
    he_mem_set_hook(NULL);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    failing f = {0};
    while (failing_next(&f)) {
        failing_pause();
        md_random random = {11};
        st_mesh *mesh = open_mesh(1 << 20);
        album pictures = {0};
        take_picture(&pictures, mesh);
        for (unsigned i = 0; i < 25; i++) {
            edit(mesh, &random, i);
            take_picture(&pictures, mesh);
        }
        uint64_t head = pictures.head;
        st_write w;
        assert_non_null(writing_begin(mesh, &w));
        failing_resume();
        st_status status = st_write_step(&w, ST_UNDO, 7);
        bool step_failed = failing_count() >= f.n;
        if (status == ST_OK) {
            assert_int_equal(st_write_commit(&w, NULL), ST_OK);
        } else {
            st_write_abort(&w);
        }
        st_snapshot *snapshot = NULL;
        st_cursor *walk = NULL;
        st_cursor_step at;
        st_status seen = st_snapshot_at(mesh, 3, &snapshot);
        st_status walked = st_cursor_begin(mesh, 2, &walk);
        while (walked == ST_OK) {
            walked = st_cursor_next(walk, &at);
        }
        failing_end(&f, status == ST_OK && seen == ST_OK && walked == ST_NOTHING);
        assert_true(status == ST_OK || (step_failed && status == ST_NO_MEMORY));
        assert_true(seen == ST_OK || seen == ST_NO_MEMORY);
        assert_true(walked == ST_NOTHING || walked == ST_NO_MEMORY);
        he_mesh *now;
        assert_int_equal(head_of(mesh, &now), head + (status == ST_OK ? 7 : 0));
        if (status != ST_OK) {
            assert_true(he_mesh_equal(now, pictures.at[head]));
        } else {
            assert_true(he_mesh_equal_live(now, pictures.at[head - 7]));
        }
        he_mesh_free(now);
        if (snapshot != NULL) {
            expect_picture(&pictures, 3, st_snapshot_content(snapshot, NULL));
            st_snapshot_release(snapshot);
        }
        st_cursor_end(walk);
        expect_snapshot(&pictures, mesh, 2);
        clear_album(&pictures);
        close_mesh(mesh);
    }
}

/* --- threads --- */

enum { ROUNDS = 400, THREADS = 4 };
static _Atomic bool writing, broken;

/* Each edit moves the vertices 0 and 1 to one position, with x = number of the new revision. After
 * an undo, x is the number of the revision to which the undo returned. */
static void *write_on(void *context)
{
    st_mesh *mesh = context;
    md_random random = {17};
    for (unsigned i = 0; i < ROUNDS; i++) {
        if (i % 5 == 4) {
            (void)step(mesh, i % 2 == 0 ? ST_UNDO : ST_REDO, 1 + md_below(&random, 3));
            continue;
        }
        char text[96];
        st_write w;
        he_mesh *m = writing_begin(mesh, &w);
        snprintf(text, sizeof text, "vertex_move vertex=0,1 to=%" PRIu64 ",0,0",
                 w.info.revision + 1);
        bool good = m != NULL && script_run(m, text, NULL, NULL) == HE_OK;
        if (good && i % 7 == 0) {
            add_column(m, i);
        }
        if (!good) {
            atomic_store(&broken, true);
            break;
        }
        if (!writing_commit(&w, "vertex_move", NULL)) {
            atomic_store(&broken, true);
        }
    }
    atomic_store(&writing, false);
    return NULL;
}

static bool is_whole(const he_mesh *m, uint64_t revision)
{
    double x = he_position(m, (he_vertex){0}).x;
    return x == he_position(m, (he_vertex){1}).x && x <= (double)revision;
}

static void *read_back(void *context)
{
    st_mesh *mesh = context;
    md_random random = {23};
    bool more = true;
    while (more) {
        more = atomic_load(&writing);
        uint64_t head = head_of(mesh, NULL);
        uint64_t revision = md_from(&random, head > 60 ? (uint32_t)head - 50 : 2, (uint32_t)head);
        st_snapshot *snapshot;
        st_status status = st_snapshot_at(mesh, revision, &snapshot);
        if (status == ST_OK) {
            if (!is_whole(st_snapshot_content(snapshot, NULL), revision)) {
                atomic_store(&broken, true);
            }
            st_snapshot_release(snapshot);
        } else if (status != ST_GONE && revision != 1) {
            atomic_store(&broken, true);
        }
    }
    return NULL;
}

static void *walk_behind(void *context)
{
    st_mesh *mesh = context;
    st_cursor *walk = NULL;
    bool more = true;
    while (more) {
        more = atomic_load(&writing);
        st_cursor_step at;
        st_status status = ST_OK;
        if (walk == NULL) {
            status = st_cursor_begin(mesh, head_of(mesh, NULL), &walk);
        }
        while (status == ST_OK && (status = st_cursor_next(walk, &at)) == ST_OK) {
            if (!is_whole(at.content, at.revision)) {
                atomic_store(&broken, true);
            }
        }
        if (status == ST_GONE) {
            st_cursor_end(walk);
            walk = NULL;
        } else if (status != ST_NOTHING) {
            atomic_store(&broken, true);
        }
    }
    st_cursor_end(walk);
    return NULL;
}

static void readers_of_the_past_and_a_writer(void **state)
{
    (void)state;
    st_mesh *mesh = open_mesh(64 * 1024);
    st_write w;
    he_mesh *m = writing_begin(mesh, &w);
    he_vec3 point = {2, 0, 0};
    assert_int_equal(he_reserve(m, (he_reservation){.positions = 2}, NULL), HE_OK);
    he_set_position(m, (he_vertex){0}, point);
    he_set_position(m, (he_vertex){1}, point);
    assert_true(writing_commit(&w, "vertex_move", NULL));
    pthread_t threads[THREADS];
    atomic_store(&writing, true);
    assert_int_equal(pthread_create(&threads[0], NULL, read_back, mesh), 0);
    assert_int_equal(pthread_create(&threads[1], NULL, read_back, mesh), 0);
    assert_int_equal(pthread_create(&threads[2], NULL, walk_behind, mesh), 0);
    assert_int_equal(pthread_create(&threads[3], NULL, write_on, mesh), 0);
    for (size_t i = 0; i < THREADS; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_false(atomic_load(&broken));
    close_mesh(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(snapshots_of_earlier_revisions),
        cmocka_unit_test(a_copy_follows_edits_of_all_positions),
        cmocka_unit_test(what_a_copy_keeps_to_cross_edits_is_counted),
        cmocka_unit_test(a_walk_follows_the_mesh),
        cmocka_unit_test(a_walk_is_told_that_the_history_was_cut),
        cmocka_unit_test(the_log_keeps_its_budget),
        cmocka_unit_test(what_the_log_frees_is_free),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(readers_of_the_past_and_a_writer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
