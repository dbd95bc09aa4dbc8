/* Tests of what happens when the journal loses changes. Everything in memory that depends on a lost
 * change must be removed or refused: meshes, long edits, event streams, Idempotency-Keys,
 * answers. */
#include "tests/slow_journal.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"
#include "store/followers.h"

static slow_journal journal;
static st_store *store;
static st_mesh *mesh, *other;

static bool render(const st_mesh_info *info, const st_change *change, char **bytes, size_t *length)
{
    (void)info;
    (void)change;
    *length = 1;
    *bytes = he_mem_zero(1, 1);
    return *bytes != NULL;
}

static st_mesh *create(const char *id)
{
    st_mesh *made = NULL;
    assert_int_equal(st_create(store, id, NULL, fixture_mesh("012,023"), NULL, &made), ST_OK);
    return made;
}

static int setup(void **state)
{
    (void)state;
    store = st_store_new(&(st_store_options){.undo_budget = 1 << 20,
                                             .max_meshes = 200,
                                             .journal = slow_journal_open_keeping(&journal),
                                             .render = render,
                                             .listeners = 2,
                                             .mesh_listeners = 2});
    assert_non_null(store);
    mesh = create("m");
    other = create("n");
    slow_journal_advance(&journal, 2);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    st_release(mesh);
    st_release(other);
    assert_int_equal(journal.out, 0);
    st_store_free(store);
    return 0;
}

static st_mesh_info facts(st_mesh *of)
{
    st_mesh_info info;
    (void)st_read_begin(of, &info);
    st_read_end(of);
    return info;
}

static void edit(st_write *w)
{
    uint32_t vertex = 0;
    const he_vec3 by = {1, 0, 0};
    assert_int_equal(he_vertex_move(w->content, &vertex, 1, HE_MOVE_BY, &by, 1, NULL), HE_OK);
    assert_int_equal(st_write_changes(w, NULL), HE_OK);
}

static st_shown change(st_mesh *of)
{
    st_write w;
    assert_int_equal(st_write_begin(of, NULL, &w), ST_OK);
    edit(&w);
    assert_int_equal(st_write_commit(&w, "vertex_move"), ST_OK);
    return st_shown_of(&w.info);
}

/* Makes the journal lose all records whose position is `from` or higher. */
static void lose(uint64_t from)
{
    const uint64_t to = slow_journal_newest(&journal);
    const st_loss loss = {.from = from, .to = to, .status = ST_FULL, .reason = "the disk is full"};
    slow_journal_lose(&journal, &loss);
    slow_journal_advance(&journal, to);
}

static void a_mesh_with_a_lost_change_leaves_the_store(void **state)
{
    (void)state;
    st_write w;
    st_listener listener;
    st_missed missed;
    st_mesh_info info;
    st_mesh *found = NULL;
    const st_since since = {.given = false};
    (void)change(other);
    slow_journal_advance(&journal, 3);
    (void)change(mesh);
    lose(4);
    assert_int_equal(st_load(store, "m", &found), ST_ABSENT);
    assert_true(facts(mesh).lost && !facts(mesh).removed);
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_LOST);
    assert_int_equal(st_write_claim(mesh, NULL, &w), ST_LOST);
    assert_int_equal(st_follow(mesh, &listener, &since, &missed, &info), ST_LOST);
    assert_int_equal(st_listeners(store), 0);
    /* The change of the mesh "n" was not lost, so the store must still have the mesh "n". */
    assert_int_equal(st_find(store, "n", &found), ST_OK);
    st_release(found);
    assert_false(facts(other).lost);
    (void)change(other);
    /* A new mesh can be created with the id of the lost mesh. */
    st_mesh *again = create("m");
    assert_true(facts(again).incarnation != facts(mesh).incarnation);
    assert_false(facts(again).lost);
    st_release(again);
}

/* If a mesh was made from a changed state of another mesh, and this change is lost, the new mesh
 * must be lost, too. After the loss, it must be refused to make a mesh from the lost state. */
static void nothing_is_made_of_what_was_lost(void **state)
{
    (void)state;
    st_mesh *made = NULL;
    st_write w;
    const st_shown kept = st_shown_of(&(st_mesh_info){.position = 2});
    const st_shown from[] = {kept, change(other)};
    he_mesh *content = fixture_mesh("012");
    /* Before the change is lost, a mesh can be made from the changed state. */
    assert_int_equal(st_create_from(store, &(st_new_mesh){.id = "c", .from = &from[1]},
                                    fixture_mesh("012"), &made),
                     ST_OK);
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    edit(&w);
    st_write_from(&w, from, 2);
    assert_int_equal(st_write_commit(&w, "append"), ST_OK);
    assert_int_equal(slow_journal_newest(&journal), 5);
    lose(3);
    assert_true(facts(made).lost && facts(mesh).lost && facts(other).lost);
    st_release(made);
    st_release(mesh);
    mesh = create("m");
    assert_int_equal(
        st_create_from(store, &(st_new_mesh){.id = "d", .from = &from[1]}, content, &made),
        ST_LOST);
    assert_int_equal(st_load(store, "d", &made), ST_ABSENT);
    const uint64_t groups = journal.groups;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    edit(&w);
    st_write_from(&w, from, 2);
    assert_int_equal(st_write_commit(&w, "append"), ST_LOST);
    assert_int_equal(st_write_claim(mesh, NULL, &w), ST_OK);
    assert_int_equal(st_write_copy(&w, NULL, NULL), HE_OK);
    edit(&w);
    st_write_from(&w, from, 2);
    assert_int_equal(st_write_commit(&w, "append"), ST_LOST);
    assert_int_equal(facts(mesh).revision, 1);
    assert_true(journal.groups == groups);
    /* A mesh can still be made from the state before the lost change. */
    assert_int_equal(
        st_create_from(store, &(st_new_mesh){.id = "d", .from = &from[0]}, content, &made), ST_OK);
    st_release(made);
}

static void creations_and_removals_are_lost_too(void **state)
{
    (void)state;
    enum { MANY = 150 }; /* more meshes than the store removes in one step */
    st_mesh *found = NULL;
    uint64_t durable = slow_journal_newest(&journal);
    for (int i = 0; i < MANY; i++) {
        char id[16];
        snprintf(id, sizeof id, "x%d", i);
        st_release(create(id));
    }
    assert_int_equal(writing_remove(other), ST_OK);
    lose(durable + 1);
    st_mesh *left[2];
    assert_int_equal(st_list(store, "", left, 2), 1);
    st_release(left[0]);
    assert_int_equal(st_load(store, "x149", &found), ST_ABSENT);
    assert_false(facts(mesh).lost);
    assert_true(facts(other).removed && !facts(other).lost);
}

static void a_loss_of_one_mesh_leaves_the_others(void **state)
{
    (void)state;
    (void)change(mesh);
    (void)change(other);
    const st_loss loss = {.incarnation = facts(other).incarnation,
                          .from = 1,
                          .to = 4,
                          .status = ST_FAILED,
                          .reason = "another node has it"};
    slow_journal_lose(&journal, &loss);
    assert_true(facts(other).lost);
    assert_false(facts(mesh).lost);
    slow_journal_advance(&journal, 4);
    (void)change(mesh);
}

static void resume(st_wait *wait)
{
    (void)wait;
    fail_msg("it was over when it was added");
}

/* A request handler paused after its commit while the disk was full, and continues when the disk
 * has space again: its answer must count as lost. */
static void an_answer_that_comes_late_is_lost_all_the_same(void **state)
{
    (void)state;
    const st_shown list = st_shown_all(store, 2), single = change(mesh);
    const st_shown all = st_shown_all(store, 2);
    lose(3);
    const st_shown kept = change(other);
    slow_journal_advance(&journal, 4);
    const st_shown newer = st_shown_all(store, 3);
    const struct {
        st_shown shown;
        st_wait_end end;
    } rows[] = {{list, ST_WAIT_DURABLE},
                {single, ST_WAIT_LOST},
                {all, ST_WAIT_LOST},
                {kept, ST_WAIT_DURABLE},
                {newer, ST_WAIT_DURABLE}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        st_wait wait = {.shown = rows[i].shown, .resume = resume};
        assert_false(st_waits_add(st_store_waits(store), &wait));
        assert_int_equal(wait.end, rows[i].end);
        assert_int_equal(wait.status, rows[i].end == ST_WAIT_LOST ? ST_FULL : ST_OK);
    }
}

/* During a long edit, the state from which the edit started is lost, so the commit of the edit must
 * fail. */
static void a_claim_of_a_lost_mesh_commits_nothing(void **state)
{
    (void)state;
    st_write w;
    (void)change(mesh);
    assert_int_equal(st_write_claim(mesh, NULL, &w), ST_OK);
    assert_int_equal(st_write_copy(&w, NULL, NULL), HE_OK);
    edit(&w);
    lose(3);
    uint64_t groups = journal.groups;
    assert_int_equal(st_write_commit(&w, "vertex_move"), ST_LOST);
    assert_true(journal.groups == groups);
    assert_int_equal(journal.out, 0);
    assert_int_equal(facts(mesh).revision, 2);
}

static void wake(void *context)
{
    ++*(unsigned *)context;
}

static void listeners_are_sent_away(void **state)
{
    (void)state;
    st_listener listener;
    st_missed missed;
    st_mesh_info info;
    char buffer[8];
    size_t got;
    unsigned wakes = 0;
    const st_since since = {.given = false};
    assert_int_equal(st_follow(mesh, &listener, &since, &missed, &info), ST_OK);
    st_queue_wake(&listener, wake, &wakes);
    (void)change(mesh);
    assert_int_equal(st_queue_read(&listener, buffer, sizeof buffer, &got), ST_QUEUE_WAIT);
    lose(3);
    assert_int_equal(wakes, 1);
    assert_int_equal(st_queue_read(&listener, buffer, sizeof buffer, &got), ST_QUEUE_LOST);
    assert_int_equal(st_queue_skip(&listener).key, 1);
    st_unfollow(mesh, &listener);
}

/* The mesh that a request created is lost. If the request is repeated with the same
 * Idempotency-Key, it must be executed again: the kept answer is no longer right, because the mesh
 * does not exist. */
static void the_key_of_a_lost_creation_is_forgotten(void **state)
{
    (void)state;
    const st_key key = {.text = "a-key", .digest = {1, 2}};
    st_keyed *keyed = NULL;
    st_mesh *made = NULL;
    for (int lost = 0; lost < 2; lost++) {
        assert_int_equal(st_keyed_begin(store, NULL, &key, &keyed), ST_KEYED_NEW);
        assert_int_equal(
            st_create(store, "k", NULL, fixture_mesh("012"), &(st_cause){.keyed = keyed}, &made),
            ST_OK);
        const st_mesh_info info = facts(made);
        st_kept kept = {.status = 201,
                        .changed = true,
                        .id = "k",
                        .incarnation = info.incarnation,
                        .position = info.position};
        st_keyed_keep(keyed, &kept);
        st_keyed_end(keyed);
        st_release(made);
        if (lost == 0) {
            lose(info.position);
        }
    }
    slow_journal_advance(&journal, slow_journal_newest(&journal));
    assert_int_equal(st_keyed_begin(store, NULL, &key, &keyed), ST_KEYED_KEPT);
    st_keyed_end(keyed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_mesh_with_a_lost_change_leaves_the_store, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(nothing_is_made_of_what_was_lost, setup, teardown),
        cmocka_unit_test_setup_teardown(creations_and_removals_are_lost_too, setup, teardown),
        cmocka_unit_test_setup_teardown(a_loss_of_one_mesh_leaves_the_others, setup, teardown),
        cmocka_unit_test_setup_teardown(an_answer_that_comes_late_is_lost_all_the_same, setup,
                                        teardown),
        cmocka_unit_test_setup_teardown(a_claim_of_a_lost_mesh_commits_nothing, setup, teardown),
        cmocka_unit_test_setup_teardown(listeners_are_sent_away, setup, teardown),
        cmocka_unit_test_setup_teardown(the_key_of_a_lost_creation_is_forgotten, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
