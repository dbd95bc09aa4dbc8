/* Tests of the table of jobs with real threads: cancelling a job must free its memory, the end of a
 * job must be shown only when it is durable, and stopping the server must end all jobs. */
#include "tests/slow_journal.h"
#include "tests/unit/fixture.h"

#include "api/describe/routes.h"
#include "api/job/job_table.h"
#include "api/request/api.h"
#include "store/idempotency.h"
#include "store/publish/durability_wait.h"
#include "system/clock.h"
#include "system/memory.h"
#include "system/thread_pool.h"

#include <pthread.h>

#define LARGE      "{\"shape\":\"torus\",\"major_segments\":1500,\"minor_segments\":1500}"
#define MIDDLE     "{\"shape\":\"torus\",\"major_segments\":250,\"minor_segments\":250}"
#define HUGE_TORUS "{\"shape\":\"torus\",\"major_segments\":3500,\"minor_segments\":3500}"
#define CUBE       "{\"shape\":\"cube\"}"

/* --- the server --- */

static slow_journal slow;
static st_store *store;
static st_pool *pool;
static api_job_table *jobs;
static api_service *service;

static const char *key; /* the Idempotency-Key that the next requests send, or NULL */

static bool submit(void *context, const st_task *task)
{
    return st_pool_submit(context, task);
}

static int start_over(const st_journal *journal, double keep)
{
    pool = st_pool_new("test", 2, 4);
    store = st_store_new(&(st_store_options){
        .undo_budget = 64 << 20,
        .max_meshes = 100,
        .journal = *journal,
    });
    jobs = api_job_table_new(
        &(api_job_table_options){.store = store, .submit = submit, .pool = pool, .keep = keep});
    service = api_service_new(store, api_routes(), &(api_options){.version = "test", .jobs = jobs});
    return 0;
}

static int start_keeping(double keep)
{
    const st_journal journal = slow_journal_open(&slow);
    return start_over(&journal, keep);
}

static int start(void **state)
{
    (void)state;
    start_keeping(API_JOB_SECONDS);
    slow_journal_advance(&slow, UINT64_MAX);
    return 0;
}

/* Starts a server whose journal makes nothing durable until the test calls slow_journal_advance. */
static int start_behind(void **state)
{
    (void)state;
    return start_keeping(API_JOB_SECONDS);
}

static int stop(void **state)
{
    (void)state;
    api_job_table_stop(jobs);
    st_pool_free(pool);
    api_job_table_free(jobs);
    api_service_free(service);
    st_store_free(store);
    return 0;
}

/* Sends a request with Prefer: respond-async. Returns the status, and writes the id of the new job
 * to `id`. */
static int post(const char *path, const char *body, char id[API_JOB_ID + 1])
{
    api_request request = {.method = "POST",
                           .path = path,
                           .query = "",
                           .request_id = "test",
                           .headers = {[API_HEADER_CONTENT_TYPE] = "application/json",
                                       [API_HEADER_IDEMPOTENCY_KEY] = key,
                                       [API_HEADER_PREFER] = "respond-async"},
                           .has_length = true,
                           .length = strlen(body),
                           .has_body = true};
    api_exchange *x = api_handle(service, &request, body, strlen(body));
    const api_answer *answer = api_answer_of(x);
    int status = answer->status;
    for (size_t i = 0; i < answer->header_count; i++) {
        if (strcmp(answer->headers[i].name, "Location") == 0) {
            snprintf(id, API_JOB_ID + 1, "%s", answer->headers[i].value + strlen("/v1/jobs/"));
        }
    }
    api_free(x);
    return status;
}

static void take_facts(void *context, const api_job *job)
{
    *(api_job *)context = *job;
}

/* Returns the parameters with which a client without a token looks up the job with this id. */
static api_job_wanted wanted(const char *id)
{
    return (api_job_wanted){.viewer = NULL, .id = id};
}

static api_job look(const char *id)
{
    api_job job = {.number = 0};
    sched_yield(); /* the tests call this function in loops, while the threads of the jobs need the
                      processor, too */
    assert_true(api_job_find(jobs, wanted(id), take_facts, &job));
    return job;
}

static api_job wait_for(const char *id, api_job_state state)
{
    api_job job;
    do {
        job = look(id);
    } while (job.state < state);
    return job;
}

/* Returns how many different values of progress a job shows before it ends. */
static size_t watch_a_job(void)
{
    char id[API_JOB_ID + 1];
    double last = 0;
    size_t values = 0;
    assert_int_equal(post("/v1/meshes", LARGE, id), 202);
    for (api_job job = look(id); job.state < API_JOB_DONE; job = look(id)) {
        assert_true(job.progress >= last);
        values += job.progress > last;
        last = job.progress;
    }
    assert_int_equal(look(id).state, API_JOB_DONE);
    return values;
}

/* On a busy machine a job may end before the test has read its progress often enough, so the test
 * tries several jobs. */
static void progress_is_seen_and_never_falls(void **state)
{
    (void)state;
    size_t values = 0;
    for (int tries = 0; tries < 10 && values < 20; tries++) {
        values = watch_a_job();
    }
    assert_true(values >= 20);
    print_message("note: %zu values seen\n", values);
}

enum { KEPT_BYTES = 64 * 1024 };

/* Cancels a job when it has reached this progress. Returns false if the job ended before that. */
static bool cancel_at(int percent)
{
    char id[API_JOB_ID + 1];
    bool forgotten = false;
    uint64_t before = st_memory_used();
    assert_int_equal(post("/v1/meshes", MIDDLE, id), 202);
    api_job job = wait_for(id, API_JOB_RUNNING);
    while (job.state == API_JOB_RUNNING && job.progress * 100 < percent) {
        job = look(id);
    }
    uint64_t asked = st_clock_micros();
    assert_int_equal(api_job_remove(jobs, wanted(id), &forgotten, take_facts, &job), ST_OK);
    if (forgotten || wait_for(id, API_JOB_DONE).state == API_JOB_DONE) {
        return false;
    }
    print_message("note: cancelled at %d %%, ended in %.1f ms\n", percent,
                  (double)(st_clock_micros() - asked) / 1000);
    assert_int_equal(look(id).state, API_JOB_CANCELLED);
    assert_int_equal(api_job_remove(jobs, wanted(id), &forgotten, take_facts, &job), ST_OK);
    assert_true(forgotten);
    /* The thread that ran the job releases the last reference to it, so the memory is freed a
     * little later. A few blocks of the job may be kept for the next requests (spare.h); the mesh
     * that it was making is a hundred times larger. */
    while (st_memory_used() > before + KEPT_BYTES) {
        assert_false(api_job_find(jobs, wanted(id), take_facts, &job));
    }
    return true;
}

static void cancelling_gives_the_memory_back(void **state)
{
    (void)state;
    int percent = 0;
    while (percent < 100 && cancel_at(percent)) {
        percent += 20;
    }
    assert_int_equal(st_store_count(store), percent < 100 ? 1 : 0);
}

static void beyond_the_queue_jobs_are_refused(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1];
    int status = 202, taken = -1;
    while (status == 202) {
        status = post("/v1/meshes", HUGE_TORUS, id);
        taken++;
    }
    assert_int_equal(status, 503);
    assert_true(taken >= 4);
}

static void an_end_is_shown_when_it_is_durable(void **state)
{
    (void)state;
    char first[API_JOB_ID + 1], second[API_JOB_ID + 1];
    assert_int_equal(post("/v1/meshes", CUBE, first), 202);
    api_job job;
    do {
        job = look(first);
    } while (job.state != API_JOB_RUNNING || strcmp(job.phase, "storing") != 0);
    /* Even a refusal may depend on a state that is not durable yet, so the end of the second job,
     * which is refused, must wait, too. */
    assert_int_equal(post("/v1/meshes", "{\"vertices\":[],\"faces\":[[0,1,2]]}", second), 202);
    while (strcmp(look(second).phase, "storing") != 0) {
    }
    assert_int_equal(look(first).state, API_JOB_RUNNING);
    slow_journal_advance(&slow, UINT64_MAX);
    assert_int_equal(wait_for(first, API_JOB_DONE).status, 201);
    assert_int_equal(wait_for(second, API_JOB_DONE).state, API_JOB_FAILED);
    assert_int_equal(look(second).status, 422);
}

static void what_is_never_durable_was_not_done(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1], late[API_JOB_ID + 1];
    assert_int_equal(post("/v1/meshes", CUBE, id), 202);
    while (strcmp(look(id).phase, "storing") != 0) {
    }
    st_waits_stop(st_store_waits(store));
    assert_int_equal(post("/v1/meshes", CUBE, late), 202);
    const char *const ids[] = {id, late};
    for (int i = 0; i < 2; i++) {
        api_job job = wait_for(ids[i], API_JOB_DONE);
        assert_int_equal(job.state, API_JOB_FAILED);
        assert_int_equal(job.status, 503);
        assert_true(job.length > 0);
        assert_string_equal(job.location, "");
    }
}

static void copy_body(void *context, const api_job *job)
{
    snprintf(context, 1000, "%.*s", (int)job->length, job->body == NULL ? "" : job->body);
}

static void a_job_whose_record_is_lost_has_failed_for_that_reason(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1], body[1000];
    assert_int_equal(post("/v1/meshes", CUBE, id), 202);
    while (strcmp(look(id).phase, "storing") != 0) {
    }
    const st_loss loss = {.from = 1, .to = 1, .status = ST_FULL, .reason = "the disk is full"};
    slow_journal_lose(&slow, &loss);
    assert_int_equal(look(id).state, API_JOB_RUNNING);
    slow_journal_advance(&slow, 1);
    api_job job = wait_for(id, API_JOB_DONE);
    assert_int_equal(job.state, API_JOB_FAILED);
    assert_int_equal(job.status, 507);
    assert_string_equal(job.location, "");
    assert_true(api_job_find(jobs, wanted(id), copy_body, body));
    assert_non_null(strstr(body, "\"code\":\"store_full\""));
    assert_non_null(strstr(body, loss.reason));
}

static void the_record_of_a_job_carries_its_key(void **state)
{
    (void)state;
    static const char *const edits[] = {
        "{\"op\":\"face_poke\",\"face\":0}",
        "{\"op\":\"transform\",\"matrix\":[2,0,0,1,0,3,0,0,0,0,1,0,0,0,0,1]}",
        "{\"op\":\"compact\"}",
    };
    char id[API_JOB_ID + 1], path[API_JOB_LOCATION + 8];
    key = "create";
    assert_int_equal(post("/v1/meshes", MIDDLE, id), 202);
    api_job job = wait_for(id, API_JOB_DONE);
    assert_string_equal(slow.key, key);
    snprintf(path, sizeof path, "%s/edits", job.location);
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        char name[] = "edit0";
        name[4] = (char)('0' + i);
        key = name;
        assert_int_equal(post(path, edits[i], id), 202);
        assert_int_equal(wait_for(id, API_JOB_DONE).state, API_JOB_DONE);
        assert_string_equal(slow.key, key);
        key = NULL;
    }
}

static int delete_mesh(const char *path)
{
    api_request request = {
        .method = "DELETE",
        .path = path,
        .query = "",
        .request_id = "test",
        .headers = {[API_HEADER_IDEMPOTENCY_KEY] = key, [API_HEADER_PREFER] = "respond-async"}};
    api_exchange *x = api_handle(service, &request, NULL, 0);
    int status = api_answer_of(x)->status;
    api_free(x);
    return status;
}

static void a_mesh_may_go_while_a_job_changes_it(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1], path[API_JOB_LOCATION + 8];
    unsigned lost = 0;
    for (int percent = 0; percent < 100; percent += 20) {
        assert_int_equal(post("/v1/meshes", MIDDLE, id), 202);
        api_job made = wait_for(id, API_JOB_DONE);
        snprintf(path, sizeof path, "%s/edits", made.location);
        assert_int_equal(
            post(path, "{\"op\":\"transform\",\"matrix\":[2,0,0,1,0,3,0,0,0,0,1,0,0,0,0,1]}", id),
            202);
        api_job job = wait_for(id, API_JOB_RUNNING);
        while (job.state == API_JOB_RUNNING && job.progress * 100 < percent) {
            job = look(id);
        }
        assert_int_equal(delete_mesh(made.location), 204);
        job = wait_for(id, API_JOB_DONE);
        assert_int_equal(job.status, job.state == API_JOB_DONE ? 200 : 404);
        lost += job.state == API_JOB_FAILED;
        assert_int_equal(st_store_count(store), 0);
    }
    print_message("note: %u of 5 jobs lost their mesh\n", lost);
}

static void what_ended_is_forgotten_in_time(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1];
    api_job job;
    start_keeping(0);
    slow_journal_advance(&slow, UINT64_MAX);
    assert_int_equal(post("/v1/meshes", CUBE, id), 202);
    while (api_job_find(jobs, wanted(id), take_facts, &job)) {
        assert_true(job.state <= API_JOB_RUNNING);
    }
    stop(NULL);
}

static void only_so_many_are_kept(void **state)
{
    (void)state;
    char id[API_JOB_ID + 1], first[API_JOB_ID + 1];
    assert_int_equal(post("/v1/meshes", "{\"vertices\":[],\"faces\":[[0,1,2]]}", first), 202);
    wait_for(first, API_JOB_DONE);
    for (int i = 0; i < API_JOBS_KEPT; i++) {
        assert_int_equal(post("/v1/meshes", "{\"vertices\":[],\"faces\":[[0,1,2]]}", id), 202);
        wait_for(id, API_JOB_DONE);
    }
    api_job job;
    assert_false(api_job_find(jobs, wanted(first), take_facts, &job));
    assert_true(api_job_find(jobs, wanted(id), take_facts, &job));
}

static void a_stop_ends_what_waits_and_what_runs(void **state)
{
    (void)state;
    char ids[4][API_JOB_ID + 1];
    for (int i = 0; i < 4; i++) {
        assert_int_equal(post("/v1/meshes", HUGE_TORUS, ids[i]), 202);
    }
    api_job_table_stop(jobs);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(wait_for(ids[i], API_JOB_DONE).state, API_JOB_CANCELLED);
    }
    char id[API_JOB_ID + 1];
    assert_int_equal(post("/v1/meshes", CUBE, id), 503);
}

#define BOARD_TEST(f) cmocka_unit_test_setup_teardown(f, start, stop)

/* --- records of jobs --- */

static st_status refuses; /* status that each attempt to record a job gives */
static unsigned notes;

static st_status take_note(void *self, const st_note *what, uint64_t *position)
{
    (void)self;
    (void)what;
    *position = 1;
    notes += refuses == ST_OK;
    return refuses;
}

static int start_noting(void **state)
{
    (void)state;
    st_journal journal = slow_journal_open(&slow);
    journal.note = take_note;
    start_over(&journal, API_JOB_SECONDS);
    slow_journal_advance(&slow, UINT64_MAX);
    return 0;
}

/* The start of a job must be recorded in the journal. If the journal is too far behind, the request
 * must be refused; if the disk is full, the job must be kept in memory only. */
static void a_job_that_cannot_be_noted(void **state)
{
    (void)state;
    static const struct {
        st_status refuses;
        int status;
    } rows[] = {
        {ST_OK, 202}, {ST_BEHIND, 503}, {ST_FULL, 202}, {ST_FAILED, 202}, {ST_NO_MEMORY, 507}};
    api_job job;
    bool forgotten;
    char id[API_JOB_ID + 1];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        refuses = rows[i].refuses;
        notes = 0;
        assert_int_equal(post("/v1/meshes", CUBE, id), rows[i].status);
        if (rows[i].status == 202) {
            assert_int_equal(wait_for(id, API_JOB_DONE).status, 201);
        }
        assert_int_equal(notes, refuses == ST_OK ? 2 : 0);
    }
    /* A recorded job must not be deleted from memory unless its deletion can be recorded, too. */
    refuses = ST_OK;
    assert_int_equal(post("/v1/meshes", CUBE, id), 202);
    (void)wait_for(id, API_JOB_DONE);
    refuses = ST_BEHIND;
    assert_int_equal(api_job_remove(jobs, wanted(id), &forgotten, take_facts, &job), ST_BEHIND);
    (void)look(id);
    refuses = ST_OK;
    assert_int_equal(api_job_remove(jobs, wanted(id), &forgotten, take_facts, &job), ST_OK);
    assert_true(forgotten);
    assert_false(api_job_find(jobs, wanted(id), take_facts, &job));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_job_that_cannot_be_noted, start_noting, stop),
        BOARD_TEST(progress_is_seen_and_never_falls),
        BOARD_TEST(cancelling_gives_the_memory_back),
        BOARD_TEST(beyond_the_queue_jobs_are_refused),
        cmocka_unit_test_setup_teardown(an_end_is_shown_when_it_is_durable, start_behind, stop),
        cmocka_unit_test_setup_teardown(what_is_never_durable_was_not_done, start_behind, stop),
        cmocka_unit_test_setup_teardown(a_job_whose_record_is_lost_has_failed_for_that_reason,
                                        start_behind, stop),
        BOARD_TEST(the_record_of_a_job_carries_its_key),
        BOARD_TEST(a_mesh_may_go_while_a_job_changes_it),
        BOARD_TEST(only_so_many_are_kept),
        BOARD_TEST(a_stop_ends_what_waits_and_what_runs),
        cmocka_unit_test(what_ended_is_forgotten_in_time),
    };
    st_memory_install(0);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
