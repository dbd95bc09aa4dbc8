/* Many spatial queries at once. The tree of bounding boxes is built once per revision, and requests
 * that come meanwhile wait for it. Another thread writes, but each answer must be that of the
 * revision that it names. */
#include "tests/api/request.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <cmocka.h>

enum { READERS = 3, QUESTIONS = 25, EDITS = 12 };

/* The grid is so large that the job pool, and not a worker, builds the trees. */
#define GRID    "{\"shape\":\"grid\",\"columns\":80,\"rows\":80,\"width\":8,\"height\":8}"
#define UP      "{\"op\":\"transform\",\"matrix\":[1,0,0,0, 0,1,0,0, 0,0,1,1, 0,0,0,1]}"
#define NEAREST "{\"queries\":[{\"closest\":[0,0,-3]}]}"

/* --- readers and a writer --- */

typedef struct reader {
    api_bench *b;
    const char *question; /* body of the POST that asks the question */
    bool by_distance;
    const char *strange; /* what judge() says of the first wrong answer */
} reader;

/* Returns what is wrong with an answer, or NULL. Each edit raises the grid by 1, so at revision r
 * the grid lies at the height r - 1. */
static const char *judge(const reader *r, const cJSON *answer, double *revision)
{
    const cJSON *asked = cJSON_GetObjectItem(answer, "revision");
    const cJSON *result = cJSON_GetArrayItem(cJSON_GetObjectItem(answer, "results"), 0);
    if (asked == NULL || result == NULL) {
        return "no results";
    }
    if (asked->valuedouble < *revision) {
        return "the revision fell";
    }
    *revision = asked->valuedouble;
    if (r->by_distance) {
        const cJSON *distance = cJSON_GetObjectItem(result->child, "distance");
        return distance != NULL && fabs(distance->valuedouble - *revision - 2) < 1e-9
                   ? NULL
                   : "another distance";
    }
    return cJSON_GetObjectItem(result, "total")->valuedouble == 0 ? NULL : "pairs that meet";
}

static void *ask(void *context)
{
    reader *r = context;
    double revision = 0;
    for (int i = 0; i < QUESTIONS && r->strange == NULL; i++) {
        bench_reply reply;
        if (!bench_try(r->b,
                       &(bench_request){"POST", "/v1/meshes/m/query", NULL, r->question,
                                        strlen(r->question)},
                       &reply) ||
            reply.status != 200) {
            r->strange = "no answer";
            return NULL;
        }
        reply.json = cJSON_ParseWithLength(reply.body, reply.length);
        r->strange = judge(r, reply.json, &revision);
        bench_reply_free(&reply);
    }
    return NULL;
}

static void answers_are_of_the_revision_they_name_while_others_write(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, GRID);
    assert_int_equal(r.status, 201);
    bench_reply_free(&r);
    reader readers[READERS] = {
        {b, NEAREST, true, NULL},
        {b, "{\"queries\":[{\"ray\":{\"origin\":[0.1,0.2,-3],\"direction\":[0,0,1]}}]}", true,
         NULL},
        {b, "{\"queries\":[{\"self_intersections\":{}}]}", false, NULL}};
    pthread_t threads[READERS];
    for (int i = 0; i < READERS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, ask, &readers[i]), 0);
    }
    for (int i = 0; i < EDITS; i++) {
        r = bench_send(b, "POST", "/v1/meshes/m/edits", NULL, UP);
        assert_int_equal(r.status, 200);
        bench_reply_free(&r);
    }
    for (int i = 0; i < READERS; i++) {
        pthread_join(threads[i], NULL);
        if (readers[i].strange != NULL) {
            fail_msg("%s: %s", readers[i].question, readers[i].strange);
        }
    }
    bench_free(b);
}

/* --- two requests that both need the tree first --- */

/* The linker replaces calls of the functions below by calls of the wrappers in this file (see the
 * Makefile). */
st_derived *__real_st_derived_begin(st_mesh *mesh, st_derived_kind kind);
st_derived *__wrap_st_derived_begin(st_mesh *mesh, st_derived_kind kind);
void __real_st_derived_end(st_mesh *mesh, st_derived_kind kind);
void __wrap_st_derived_end(st_mesh *mesh, st_derived_kind kind);
void __real_st_derived_wait(st_mesh *mesh, st_derived_kind kind);
void __wrap_st_derived_wait(st_mesh *mesh, st_derived_kind kind);

/* If `closed` is set, the first of two requests stops right before it builds the tree of bounding
 * boxes, until the second request waits for the tree or has been answered. So the test can produce
 * each order of events without sleeping. */
static struct {
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool closed;
    bool begun, met;
    atomic_bool making; /* the first request is about to build the tree of bounding boxes */
    /* The following members are protected by the lock of `place`, where the tree will be stored. */
    st_derived *place;
    bool held;
    int waited;
    /* a flag that the test sets when the second request comes, to cancel the first one; NULL if the
     * first one is not cancelled */
    bool *leaves;
    /* a flag that the test sets as soon as the second request waits, to cancel it; NULL if it is
     * not cancelled */
    bool *gives_up;
} gate = {.lock = PTHREAD_MUTEX_INITIALIZER, .changed = PTHREAD_COND_INITIALIZER};

static void open_gate(bool *which)
{
    pthread_mutex_lock(&gate.lock);
    *which = true;
    pthread_cond_broadcast(&gate.changed);
    pthread_mutex_unlock(&gate.lock);
}

static void pass(const bool *which)
{
    pthread_mutex_lock(&gate.lock);
    while (!*which) {
        pthread_cond_wait(&gate.changed, &gate.lock);
    }
    pthread_mutex_unlock(&gate.lock);
}

st_derived *__wrap_st_derived_begin(st_mesh *mesh, st_derived_kind kind)
{
    st_derived *place = __real_st_derived_begin(mesh, kind);
    if (gate.closed) {
        gate.place = place;
    }
    return place;
}

void __wrap_st_derived_end(st_mesh *mesh, st_derived_kind kind)
{
    bool first = gate.closed && gate.place->value != NULL && !gate.held;
    gate.held |= first;
    __real_st_derived_end(mesh, kind);
    if (first) {
        atomic_store(&gate.making, true);
        open_gate(&gate.begun);
        pass(&gate.met);
        if (gate.leaves != NULL) {
            *gate.leaves = false;
        }
    }
}

void __wrap_st_derived_wait(st_mesh *mesh, st_derived_kind kind)
{
    if (gate.closed) {
        gate.waited++;
        if (gate.gives_up == NULL) {
            open_gate(&gate.met);
        } else {
            *gate.gives_up = false;
        }
    }
    __real_st_derived_wait(mesh, kind);
}

/* Cancels a request while it builds the tree of bounding boxes or waits for it, but not before. */
static bool give_up(void *context, const char *phase, double done)
{
    (void)phase;
    (void)done;
    return *(const bool *)context || !atomic_load(&gate.making);
}

typedef struct asker {
    api_service *service;
    bool patient, second;
    int status;
    char body[512];
} asker;

static void *ask_first(void *context)
{
    asker *a = context;
    api_request request = {.method = "POST",
                           .path = "/v1/meshes/m/query",
                           .query = "",
                           .request_id = "test",
                           .headers = {[API_HEADER_CONTENT_TYPE] = "application/json"},
                           .has_length = true,
                           .length = strlen(NEAREST),
                           .has_body = true};
    api_step step;
    if (a->second) {
        pass(&gate.begun);
    }
    api_exchange *x = api_begin(a->service, &request, &step);
    size_t used;
    step = api_body(x, NEAREST, strlen(NEAREST), &used);
    step = api_end(x);
    if (step == API_WORK) {
        api_set_progress(x, give_up, &a->patient);
        api_work(x);
    }
    const api_answer *answer = api_answer_of(x);
    a->status = answer->status;
    if (answer->bytes != NULL && answer->length < (int64_t)sizeof a->body) {
        memcpy(a->body, answer->bytes, (size_t)answer->length);
    }
    api_free(x);
    if (a->second) {
        open_gate(&gate.met);
    }
    return NULL;
}

static void ask_twice(bool patient, bool second_gives_up, asker askers[2])
{
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, GRID);
    assert_int_equal(r.status, 201);
    bench_reply_free(&r);
    gate.begun = gate.met = gate.held = false;
    atomic_store(&gate.making, false);
    gate.waited = 0;
    gate.leaves = patient ? NULL : &askers[0].patient;
    gate.gives_up = second_gives_up ? &askers[1].patient : NULL;
    gate.closed = true;
    api_service *service =
        api_service_new(bench_store(b), api_routes(), &(api_options){.version = "test"});
    assert_non_null(service);
    pthread_t threads[2];
    for (int i = 0; i < 2; i++) {
        askers[i] = (asker){.service = service, .patient = true, .second = i == 1};
        assert_int_equal(pthread_create(&threads[i], NULL, ask_first, &askers[i]), 0);
    }
    for (int i = 0; i < 2; i++) {
        pthread_join(threads[i], NULL);
    }
    gate.closed = false;
    api_service_free(service);
    bench_free(b);
}

static void the_second_asker_waits_for_the_tree_of_the_first(void **state)
{
    (void)state;
    asker askers[2];
    ask_twice(true, false, askers);
    assert_int_equal(askers[0].status, 200);
    assert_int_equal(askers[1].status, 200);
    assert_string_equal(askers[0].body, askers[1].body);
    assert_true(gate.waited > 0);
}

static void the_second_asker_makes_the_tree_that_the_first_gave_up(void **state)
{
    (void)state;
    asker askers[2];
    ask_twice(false, false, askers);
    assert_int_not_equal(askers[0].status, 200);
    assert_int_equal(askers[1].status, 200);
    assert_true(gate.waited > 0);
}

/* The second request is cancelled while it waits for the tree that the first one builds. It must be
 * answered at once: the test lets the first request continue only after that answer. */
static void who_waits_for_a_tree_may_give_up(void **state)
{
    (void)state;
    asker askers[2];
    ask_twice(true, true, askers);
    assert_int_equal(askers[0].status, 200);
    assert_int_equal(askers[1].status, 503);
    assert_true(gate.waited > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_of_the_revision_they_name_while_others_write),
        cmocka_unit_test(the_second_asker_waits_for_the_tree_of_the_first),
        cmocka_unit_test(the_second_asker_makes_the_tree_that_the_first_gave_up),
        cmocka_unit_test(who_waits_for_a_tree_may_give_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
