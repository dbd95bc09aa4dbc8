/* Tests of answers that wait until changes are durable: each wait must end once, in the order of
 * positions in the journal, and its result must be durable, lost or stopped. */
#include "tests/slow_journal.h"
#include "tests/unit/fixture.h"
#include "tests/writing.h"

#include "edit/local/vertex.h"

#include "store/publish/durability_wait.h"
#include "tests/seed.h"
#include "tests/failing.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

enum { MANY = 1000 };

static slow_journal slow;
static st_journal journal;
static st_waits *waits;
static st_wait all[MANY];
static size_t resumed;
static uint64_t last; /* position of the wait that ended last */
static bool in_order;

static void moved(void *context, uint64_t position)
{
    st_waits_moved(context, position);
}

static void lost(void *context, const st_loss *loss)
{
    st_waits_lose(context, loss);
}

static int setup(void **state)
{
    (void)state;
    journal = slow_journal_open(&slow);
    waits = st_waits_new();
    const st_journal_listener listener = {waits, moved, lost};
    journal.listen(journal.self, &listener);
    resumed = 0;
    last = 0;
    in_order = true;
    return waits == NULL;
}

static int teardown(void **state)
{
    (void)state;
    journal.listen(journal.self, NULL);
    st_waits_free(waits);
    journal.close(journal.self);
    return 0;
}

static void count(st_wait *wait)
{
    in_order = in_order && wait->shown.position >= last;
    last = wait->shown.position;
    resumed++;
    wait->resume = NULL; /* from now on, a second call of `resume` would crash */
}

/* Adds a wait. Returns false if the wait ended at once. */
static bool add(st_wait *wait, uint64_t position, uint64_t incarnation)
{
    uint64_t since = incarnation == 0 ? 0 : position - 1;
    *wait = (st_wait){.shown = {position, since, incarnation}, .resume = count};
    return st_waits_add(waits, wait);
}

static void one_notice_releases_a_thousand(void **state)
{
    (void)state;
    uint64_t random = seed_of_run();
    for (size_t i = 0; i < MANY; i++) {
        random = random * 6364136223846793005U + 1442695040888963407U;
        assert_true(add(&all[i], 1 + (random >> 33) % 500, 7));
    }
    slow_journal_advance(&slow, 0);
    assert_int_equal(resumed, 0);
    slow_journal_advance(&slow, 250);
    size_t early = 0;
    for (size_t i = 0; i < MANY; i++) {
        assert_int_equal(all[i].resume == NULL, all[i].shown.position <= 250);
        early += all[i].resume == NULL;
    }
    assert_int_equal(resumed, early);
    /* A wait that is added after others must still end in the order of positions. */
    st_wait late, past;
    assert_true(add(&late, 251, 7));
    assert_false(add(&past, 250, 7));
    assert_int_equal(past.end, ST_WAIT_DURABLE);
    slow_journal_advance(&slow, 500);
    assert_int_equal(resumed, MANY + 1);
    assert_true(in_order);
    for (size_t i = 0; i < MANY; i++) {
        assert_int_equal(all[i].end, ST_WAIT_DURABLE);
    }
}

/* A wait for any position of a lost interval, including both ends of the interval, must end as
 * lost, but only if it waits for the mesh whose records were lost. */
static void a_lost_position_ends_as_lost_whenever_it_is_added(void **state)
{
    (void)state;
    enum { BEFORE, FIRST, OTHER, LAST, AFTER, LIST, SAMPLE };
    static const struct {
        uint64_t position, incarnation;
        st_wait_end end;
    } rows[SAMPLE] = {
        [BEFORE] = {3, 7, ST_WAIT_DURABLE}, [FIRST] = {4, 7, ST_WAIT_LOST},
        [OTHER] = {5, 8, ST_WAIT_DURABLE},  [LAST] = {6, 7, ST_WAIT_LOST},
        [AFTER] = {7, 7, ST_WAIT_DURABLE},  [LIST] = {7, 0, ST_WAIT_LOST},
    };
    static const char reason[] = "the disk is full";
    for (size_t i = 0; i < SAMPLE; i++) {
        assert_true(add(&all[i], rows[i].position, rows[i].incarnation));
    }
    slow_journal_lose(&slow, &(st_loss){.incarnation = 7, .from = 4, .to = 6, .reason = reason});
    assert_int_equal(resumed, 0);
    slow_journal_advance(&slow, 7);
    assert_int_equal(resumed, SAMPLE);
    for (int again = 0; again < 2; again++) {
        for (size_t i = 0; i < SAMPLE; i++) {
            assert_int_equal(all[i].end, rows[i].end);
            assert_ptr_equal(all[i].reason, rows[i].end == ST_WAIT_LOST ? reason : NULL);
            assert_int_equal(st_waits_is_durable(waits, &all[i].shown),
                             rows[i].end == ST_WAIT_DURABLE);
            assert_false(add(&all[i], rows[i].position, rows[i].incarnation));
        }
    }
    /* The answer was begun after the loss, so it does not show a lost change and counts as
     * durable. */
    const st_shown later = {.position = 7, .since = 6};
    assert_true(st_waits_is_durable(waits, &later));
}

/* A request asked for a list. Its answer began after the journal had reported records as durable,
 * but before the threads that wrote these records had noted their positions. */
static void a_list_of_nothing_new_is_not_lost(void **state)
{
    (void)state;
    static const char reason[] = "full";
    const st_loss first = {.from = 3, .to = 6, .reason = reason};
    const st_loss next = {.from = 7, .to = 9, .reason = reason};
    slow_journal_lose(&slow, &first);
    slow_journal_advance(&slow, 6);
    const st_shown list = {.position = 5, .since = 6};
    assert_true(st_waits_is_durable(waits, &list));
    slow_journal_lose(&slow, &next);
    slow_journal_advance(&slow, 9);
    assert_true(st_waits_is_durable(waits, &list));
    assert_false(st_waits_is_lost(waits, &list));
}

static void a_loss_without_memory_takes_too_much_rather_than_too_little(void **state)
{
    (void)state;
    const st_loss loss = {.incarnation = 7, .from = 4, .to = 4, .reason = "no room"};
    failing_at(1);
    slow_journal_lose(&slow, &loss);
    failing_off();
    slow_journal_advance(&slow, 9);
    assert_false(add(&all[0], 3, 7));
    assert_int_equal(all[0].end, ST_WAIT_DURABLE);
    assert_false(add(&all[0], 4, 7));
    assert_int_equal(all[0].end, ST_WAIT_LOST);
    assert_false(add(&all[0], 9, 8));
    assert_int_equal(all[0].end, ST_WAIT_LOST);
}

static void a_stop_ends_what_is_not_known(void **state)
{
    (void)state;
    slow_journal_advance(&slow, 2);
    assert_true(add(&all[0], 3, 7));
    st_waits_stop(waits);
    assert_int_equal(resumed, 1);
    assert_int_equal(all[0].end, ST_WAIT_STOPPED);
    assert_false(add(&all[0], 4, 7));
    assert_int_equal(all[0].end, ST_WAIT_STOPPED);
    assert_false(add(&all[0], 2, 7));
    assert_int_equal(all[0].end, ST_WAIT_DURABLE);
}

static _Atomic bool stop_ended;
static bool ended_early;

static void *stop_waits(void *context)
{
    (void)context;
    st_waits_stop(waits);
    atomic_store(&stop_ended, true);
    return NULL;
}

/* Resumes a wait while another thread calls st_waits_stop. This function takes so long that
 * st_waits_stop would return before its end, if st_waits_stop did not wait until all waits are
 * resumed. */
static void resume_slowly(st_wait *wait)
{
    pthread_t stops;
    (void)wait;
    assert_int_equal(pthread_create(&stops, NULL, stop_waits, NULL), 0);
    for (int i = 0; i < 20000 && !atomic_load(&stop_ended); i++) {
        sched_yield();
    }
    ended_early = atomic_load(&stop_ended);
    assert_int_equal(pthread_detach(stops), 0);
}

/* st_waits_stop must return only after each wait has been resumed, because the caller of
 * st_waits_stop may then free the memory of the waits. */
static void a_stop_waits_for_what_is_being_resumed(void **state)
{
    (void)state;
    st_wait wait = {.shown = {5, 4, 7}, .resume = resume_slowly};
    atomic_store(&stop_ended, false);
    assert_true(st_waits_add(waits, &wait));
    slow_journal_advance(&slow, 5);
    while (!atomic_load(&stop_ended)) {
        sched_yield();
    }
    assert_false(ended_early);
}

/* All changes of one request must be one group of records in the journal, so that a crash leaves
 * all of them or none. */
static void a_request_is_one_group_of_records(void **state)
{
    (void)state;
    static slow_journal log;
    st_store *store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 16, .max_meshes = 1, .journal = slow_journal_open(&log)});
    st_mesh *mesh = NULL;
    st_mesh_info info;
    assert_int_equal(st_create(store, "m", NULL, fixture_mesh("012"), NULL, &mesh), ST_OK);
    for (uint32_t i = 1; i <= 3; i++) {
        st_write w;
        uint32_t vertex = 0;
        he_vec3 point = {i, 0, 0};
        he_mesh *content = writing_begin(mesh, &w);
        assert_int_equal(he_vertex_move(content, &vertex, 1, HE_MOVE_TO, &point, 1, NULL), HE_OK);
        assert_true(writing_commit(&w, "vertex_move", &info));
        assert_int_equal(info.position, 1 + i);
    }
    assert_int_equal(log.groups, 4);
    assert_int_equal(writing_step(mesh, ST_UNDO, 3), ST_OK);
    assert_int_equal(log.newest, 7);
    assert_int_equal(log.groups, 5);
    assert_int_equal(writing_step(mesh, ST_REDO, 2), ST_OK);
    assert_int_equal(log.newest, 9);
    assert_int_equal(log.groups, 6);
    assert_int_equal(writing_replace(mesh, fixture_mesh("012,023"), "name", &info), ST_OK);
    assert_string_equal(info.name, "name");
    assert_int_equal(info.revision, 10);
    assert_int_equal(info.position, 11);
    assert_int_equal(info.record, 11);
    assert_int_equal(log.groups, 7);
    st_release(mesh);
    st_store_free(store);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)
    const struct CMUnitTest tests[] = {
        TEST(one_notice_releases_a_thousand),
        TEST(a_lost_position_ends_as_lost_whenever_it_is_added),
        TEST(a_list_of_nothing_new_is_not_lost),
        TEST(a_loss_without_memory_takes_too_much_rather_than_too_little),
        TEST(a_stop_ends_what_is_not_known),
        TEST(a_stop_waits_for_what_is_being_resumed),
        cmocka_unit_test(a_request_is_one_group_of_records),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
