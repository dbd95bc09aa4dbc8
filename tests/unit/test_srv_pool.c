/* Tests of the thread pool: in which order tasks run, and which tasks may occupy all threads. A
 * task that a test wants to block waits for a condition variable (the gate), until the test opens
 * the gate. */
#include "system/thread_pool.h"

#include "api/describe/routes.h"
#include "api/request/api.h"
#include "store/store.h"

#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { ROOM = 64 };

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t changed = PTHREAD_COND_INITIALIZER;
static bool open;
static int waiting_at_gate[ST_SHARES], most_at_gate[ST_SHARES], most_long;
static char order[ROOM + 1];
static size_t begun;

static int reset(void **state)
{
    (void)state;
    open = false;
    begun = 0;
    most_long = 0;
    memset(order, 0, sizeof order);
    memset(waiting_at_gate, 0, sizeof waiting_at_gate);
    memset(most_at_gate, 0, sizeof most_at_gate);
    return 0;
}

static void note(void *context)
{
    pthread_mutex_lock(&lock);
    order[begun++] = *(const char *)context;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
}

static const st_share shares[ST_SHARES] = {ST_SHARE_BRIEF, ST_SHARE_LONG, ST_SHARE_JOB};

static void wait_at_gate(void *context)
{
    const st_share share = *(const st_share *)context;
    pthread_mutex_lock(&lock);
    int here = ++waiting_at_gate[share];
    int all_long = waiting_at_gate[ST_SHARE_LONG] + waiting_at_gate[ST_SHARE_JOB];
    most_at_gate[share] = here > most_at_gate[share] ? here : most_at_gate[share];
    most_long = all_long > most_long ? all_long : most_long;
    pthread_cond_broadcast(&changed);
    while (!open) {
        pthread_cond_wait(&changed, &lock);
    }
    waiting_at_gate[share]--;
    pthread_mutex_unlock(&lock);
}

static void send_to_gate(st_pool *pool, st_share share)
{
    assert_true(st_pool_submit(
        pool, &(st_task){.work = wait_at_gate, .context = (void *)&shares[share], .share = share}));
}

static void await_at_gate(st_share share, int count)
{
    pthread_mutex_lock(&lock);
    while (waiting_at_gate[share] < count) {
        pthread_cond_wait(&changed, &lock);
    }
    pthread_mutex_unlock(&lock);
}

static void await_begun(size_t count)
{
    pthread_mutex_lock(&lock);
    while (begun < count) {
        pthread_cond_wait(&changed, &lock);
    }
    pthread_mutex_unlock(&lock);
}

static void open_gate(void)
{
    pthread_mutex_lock(&lock);
    open = true;
    pthread_cond_broadcast(&changed);
    pthread_mutex_unlock(&lock);
}

static void submit(st_pool *pool, const char *name, double cost, uint64_t flow)
{
    assert_true(st_pool_submit(
        pool, &(st_task){.work = note, .context = (void *)name, .cost = cost, .flow = flow}));
}

/* The pool has four threads: at most two may run long reads, at most two may run jobs, and at least
 * one must stay free for brief work. */
static void long_work_leaves_a_thread_to_brief_work(void **state)
{
    (void)state;
    st_pool *pool = st_pool_new("test", 4, ROOM);
    assert_non_null(pool);
    for (int i = 0; i < 4; i++) {
        send_to_gate(pool, ST_SHARE_LONG);
        send_to_gate(pool, ST_SHARE_JOB);
    }
    await_at_gate(ST_SHARE_LONG, 1);
    await_at_gate(ST_SHARE_JOB, 1);
    submit(pool, "b", 1, 0);
    await_begun(1);
    open_gate();
    st_pool_free(pool);
    assert_in_range(most_at_gate[ST_SHARE_LONG], 1, 2);
    assert_in_range(most_at_gate[ST_SHARE_JOB], 1, 2);
    assert_in_range(most_long, 2, 3);
}

static void one_thread_does_everything(void **state)
{
    (void)state;
    st_pool *pool = st_pool_new("test", 1, ROOM);
    assert_non_null(pool);
    send_to_gate(pool, ST_SHARE_LONG);
    send_to_gate(pool, ST_SHARE_JOB);
    submit(pool, "b", 1, 0);
    open_gate();
    st_pool_free(pool);
    assert_string_equal(order, "b");
    assert_int_equal(most_long, 1);
}

static void a_full_queue_refuses_its_own_share_only(void **state)
{
    (void)state;
    st_pool *pool = st_pool_new("test", 1, 2);
    assert_non_null(pool);
    send_to_gate(pool, ST_SHARE_LONG);
    await_at_gate(ST_SHARE_LONG, 1);
    const st_task task = {
        .work = wait_at_gate, .context = (void *)&shares[ST_SHARE_LONG], .share = ST_SHARE_LONG};
    assert_true(st_pool_submit(pool, &task));
    assert_true(st_pool_submit(pool, &task));
    assert_false(st_pool_submit(pool, &task));
    submit(pool, "b", 1, 0);
    open_gate();
    st_pool_free(pool);
    assert_string_equal(order, "b");
}

/* Makes a pool of one thread, which is blocked until the gate is opened, so that the test can
 * submit further tasks before they run. */
static st_pool *one_at_gate(void)
{
    st_pool *pool = st_pool_new("test", 1, ROOM);
    assert_non_null(pool);
    send_to_gate(pool, ST_SHARE_BRIEF);
    await_at_gate(ST_SHARE_BRIEF, 1);
    return pool;
}

static void short_work_goes_before_long_work(void **state)
{
    (void)state;
    st_pool *pool = one_at_gate();
    submit(pool, "l", 10, 1);
    submit(pool, "m", 3, 2);
    submit(pool, "s", 1, 3);
    open_gate();
    st_pool_free(pool);
    assert_string_equal(order, "sml");
}

static void flows_take_turns(void **state)
{
    (void)state;
    st_pool *pool = one_at_gate();
    for (int i = 0; i < 5; i++) {
        submit(pool, "a", 1, 1);
    }
    submit(pool, "b", 1, 2);
    submit(pool, "b", 1, 2);
    open_gate();
    st_pool_free(pool);
    assert_string_equal(order, "ababaaa");
}

static void a_flow_keeps_its_order(void **state)
{
    (void)state;
    st_pool *pool = one_at_gate();
    submit(pool, "1", 10, 1);
    submit(pool, "2", 1, 1);
    submit(pool, "3", 0, 1);
    open_gate();
    st_pool_free(pool);
    assert_string_equal(order, "123");
}

/* A chain of short tasks, in which each task submits the next one, so that one task of the chain is
 * always waiting. */
typedef struct stream {
    st_pool *pool;
    int left;
} stream;

static void note_and_go_on(void *context)
{
    stream *s = context;
    note("s");
    if (s->left-- > 0) {
        assert_true(st_pool_submit(
            s->pool, &(st_task){.work = note_and_go_on, .context = s, .cost = 1, .flow = 2}));
    }
}

static void long_work_is_not_passed_over_for_ever(void **state)
{
    (void)state;
    st_pool *pool = one_at_gate();
    stream s = {pool, 30};
    submit(pool, "l", 10, 1);
    assert_true(st_pool_submit(
        pool, &(st_task){.work = note_and_go_on, .context = &s, .cost = 1, .flow = 2}));
    open_gate();
    await_begun(32);
    st_pool_free(pool);
    const char *at = strchr(order, 'l');
    assert_non_null(at);
    assert_in_range(at - order, 9, 11);
}

/* How often the pool has called pthread_cond_signal; the linker redirects these calls to
 * __wrap_pthread_cond_signal. */
static _Atomic int signals;
int __real_pthread_cond_signal(pthread_cond_t *condition);
int __wrap_pthread_cond_signal(pthread_cond_t *condition);

int __wrap_pthread_cond_signal(pthread_cond_t *condition)
{
    atomic_fetch_add(&signals, 1);
    return __real_pthread_cond_signal(condition);
}

/* A thread must be woken only when a task is submitted that may begin at once, and not when a task
 * ends. */
static void a_thread_is_woken_only_for_something_to_do(void **state)
{
    (void)state;
    enum { TASKS = ROOM / 2, THREADS = 4 };
    st_pool *pool = st_pool_new("test", THREADS, ROOM);
    assert_non_null(pool);
    atomic_store(&signals, 0);
    for (size_t i = 0; i < TASKS; i++) {
        submit(pool, "a", 1, 1);
        await_begun(i + 1);
    }
    assert_in_range(atomic_load(&signals), 0, TASKS);

    /* Two long reads are blocked, and no more than two may run at once. Submitting further long
     * reads must therefore wake no thread. */
    send_to_gate(pool, ST_SHARE_LONG);
    send_to_gate(pool, ST_SHARE_LONG);
    await_at_gate(ST_SHARE_LONG, 2);
    atomic_store(&signals, 0);
    for (size_t i = 0; i < TASKS / 2; i++) {
        send_to_gate(pool, ST_SHARE_LONG);
    }
    assert_int_equal(atomic_load(&signals), 0);
    open_gate();
    st_pool_free(pool);
}

static void a_flow_is_a_client_with_a_mesh(void **state)
{
    (void)state;
    assert_true(st_pool_flow("ab", "c") == st_pool_flow("ab", "c"));
    assert_true(st_pool_flow("ab", "c") != st_pool_flow("a", "bc"));
    assert_true(st_pool_flow("a", "") != st_pool_flow("", "a"));
}

/* The pool of this test has one running task and one waiting task, and has refused one task. */
static void the_page_of_metrics_has_the_numbers_of_a_pool(void **state)
{
    (void)state;
    static const char *const lines[] = {
        "\nhedge_pool_tasks_waiting{pool=\"work\",share=\"brief\"} 1\n",
        "\nhedge_pool_tasks_waiting_limit{pool=\"work\",share=\"brief\"} 1\n",
        "\nhedge_pool_tasks_running{pool=\"work\",share=\"brief\"} 1\n",
        "\nhedge_pool_tasks_refused_total{pool=\"work\",share=\"brief\"} 1\n",
    };
    st_pool *pool = st_pool_new("test", 1, 1);
    st_store *store = st_store_new(
        &(st_store_options){.undo_budget = 1, .max_meshes = 1, .journal = st_journal_memory()});
    assert_non_null(pool);
    assert_non_null(store);
    api_service *service =
        api_service_new(store, api_routes(), &(api_options){.version = "test", .pool = pool});
    assert_non_null(service);
    send_to_gate(pool, ST_SHARE_BRIEF);
    await_at_gate(ST_SHARE_BRIEF, 1);
    submit(pool, "b", 1, 0);
    assert_false(st_pool_submit(pool, &(st_task){.work = note, .context = (void *)"c"}));
    const api_request request = {
        .method = "GET", .path = "/metrics", .query = "", .request_id = "test"};
    api_exchange *x = api_handle(service, &request, NULL, 0);
    assert_non_null(x);
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        if (strstr(api_answer_of(x)->bytes, lines[i]) == NULL) {
            fail_msg("the page lacks %s", lines[i]);
        }
    }
    api_free(x);
    open_gate();
    st_pool_free(pool);
    api_service_free(service);
    st_store_free(store);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(long_work_leaves_a_thread_to_brief_work, reset),
        cmocka_unit_test_setup(one_thread_does_everything, reset),
        cmocka_unit_test_setup(a_full_queue_refuses_its_own_share_only, reset),
        cmocka_unit_test_setup(short_work_goes_before_long_work, reset),
        cmocka_unit_test_setup(flows_take_turns, reset),
        cmocka_unit_test_setup(a_flow_keeps_its_order, reset),
        cmocka_unit_test_setup(long_work_is_not_passed_over_for_ever, reset),
        cmocka_unit_test_setup(a_thread_is_woken_only_for_something_to_do, reset),
        cmocka_unit_test(a_flow_is_a_client_with_a_mesh),
        cmocka_unit_test_setup(the_page_of_metrics_has_the_numbers_of_a_pool, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
