/* Threads that may compute for long leave the processors to those that serve connections. */
#define _GNU_SOURCE /* for gettid */
#include "unit/fixture.h"

#include "system/parallel.h"
#include "system/thread_pool.h"
#include "system/thread_start.h"

#include <pthread.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

/* What a thread says of itself. */
typedef struct thread_facts {
    int niceness;
    char name[16];
    pid_t id;
} thread_facts;

static void look(void *context)
{
    thread_facts *out = context;
    out->id = gettid();
    out->niceness = getpriority(PRIO_PROCESS, (id_t)out->id);
    prctl(PR_GET_NAME, out->name);
}

static void the_threads_of_a_pool_are_nicer(void **state)
{
    (void)state;
    thread_facts here, there = {0};
    look(&here);
    st_pool *pool = st_pool_new("some-pool", 1, 1);
    assert_non_null(pool);
    assert_true(st_pool_submit(pool, &(st_task){.work = look, .context = &there}));
    st_pool_free(pool); /* runs what is queued */
    assert_string_equal(there.name, "some-pool");
    assert_int_equal(there.niceness, here.niceness + ST_NICER);
    look(&there);
    assert_int_equal(there.niceness, here.niceness);
}

/* Two parts that wait for each other, so that they run on two threads. */
typedef struct parts {
    pthread_barrier_t both;
    thread_facts facts[2];
} parts;

static he_status run_part(void *context, uint32_t part, he_error *err)
{
    parts *all = context;
    (void)err;
    pthread_barrier_wait(&all->both);
    look(&all->facts[part]);
    return HE_OK;
}

static void the_threads_that_help_are_nicer(void **state)
{
    (void)state;
    thread_facts here;
    parts all;
    look(&here);
    pthread_barrier_init(&all.both, NULL, 2);
    st_parallel *hands = st_parallel_new(1);
    assert_non_null(hands);
    const he_parallel *host = st_parallel_host(hands);
    assert_int_equal(host->run(host->self, 2, run_part, &all, NULL, NULL), HE_OK);
    for (int i = 0; i < 2; i++) {
        bool is_here = all.facts[i].id == here.id;
        assert_int_equal(all.facts[i].niceness, here.niceness + (is_here ? 0 : ST_NICER));
    }
    assert_true(all.facts[0].id != all.facts[1].id);
    st_parallel_free(hands);
    pthread_barrier_destroy(&all.both);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_threads_of_a_pool_are_nicer),
        cmocka_unit_test(the_threads_that_help_are_nicer),
    };
    return cmocka_run_group_tests_name("srv_nicer", tests, NULL, NULL);
}
