/* Jobs, which continue after their request is answered: each state of a job, and the effects of a
 * long edit on other requests. There are no threads; a job runs when the test says so. */
#include "tests/api/request.h"

#include "api/header/prefer.h"
#include "api/job/job_table.h"
#include "api/limits.h"
#include "base/mem.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define CUBE      "{\"shape\":\"cube\"}"
#define LARGE     "{\"shape\":\"grid\",\"columns\":200,\"rows\":200}"
#define TRANSFORM "{\"op\":\"transform\",\"matrix\":[2,0,0,1,0,3,0,0,0,0,1,0,0,0,0,1]}"
#define POKE      "{\"op\":\"face_poke\",\"face\":0}"

static const char *const async[] = {"Prefer", "respond-async", NULL};

static api_bench *bench;

static int start(void **state)
{
    (void)state;
    bench = bench_new();
    return 0;
}

static int stop(void **state)
{
    (void)state;
    bench_free(bench);
    return 0;
}

static bench_reply expect(int status, const char *method, const char *target,
                          const char *const *headers, const char *body)
{
    bench_reply r = bench_send(bench, method, target, headers, body);
    if (r.status != status) {
        fail_msg("%s %s: %d instead of %d: %.300s", method, target, r.status, status, r.body);
    }
    return r;
}

static void send(int status, const char *method, const char *target, const char *body)
{
    bench_reply r = expect(status, method, target, NULL, body);
    bench_reply_free(&r);
}

/* Submits a job; `path` becomes the path of the job in the API. */
static void submit(const char *method, const char *target, const char *body, char path[64])
{
    bench_reply r = expect(202, method, target, async, body);
    assert_string_equal(bench_header(&r, "Preference-Applied"), "respond-async");
    assert_string_equal(cJSON_GetObjectItem(r.json, "state")->valuestring, "queued");
    snprintf(path, 64, "%s", bench_header(&r, "Location"));
    assert_memory_equal(path, "/v1/jobs/", 9);
    assert_string_equal(path + 9, cJSON_GetObjectItem(r.json, "id")->valuestring);
    bench_reply_free(&r);
}

static bench_reply job_in(const char *path, const char *state)
{
    bench_reply r = expect(200, "GET", path, NULL, NULL);
    assert_string_equal(cJSON_GetObjectItem(r.json, "state")->valuestring, state);
    return r;
}

/* Returns the member `inner` of the member `outer` of the job that the answer shows. */
static const cJSON *inside(const bench_reply *r, const char *outer, const char *inner)
{
    const cJSON *found = cJSON_GetObjectItem(cJSON_GetObjectItem(r->json, outer), inner);
    if (found == NULL) {
        fail_msg("no %s.%s in %s", outer, inner, r->body);
    }
    return found;
}

static void a_job_keeps_what_the_request_would_have_answered(void **state)
{
    (void)state;
    char path[64];
    submit("POST", "/v1/meshes?id=m", CUBE, path);
    send(404, "GET", "/v1/meshes/m", NULL);
    bench_reply r = job_in(path, "queued");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(r.json, "started")));
    assert_null(cJSON_GetObjectItem(r.json, "result"));
    bench_reply_free(&r);
    bench_run_jobs(bench, 1);
    r = job_in(path, "done");
    assert_int_equal(cJSON_GetObjectItem(r.json, "status")->valueint, 201);
    assert_true(cJSON_GetObjectItem(r.json, "progress")->valuedouble == 1);
    assert_string_equal(cJSON_GetObjectItem(r.json, "location")->valuestring, "/v1/meshes/m");
    assert_string_equal(inside(&r, "result", "id")->valuestring, "m");
    assert_int_equal(inside(&r, "result", "revision")->valueint, 1);
    bench_reply_free(&r);
    send(200, "GET", "/v1/meshes/m", NULL);
    send(204, "DELETE", path, NULL);
    send(404, "GET", path, NULL);
}

static void a_job_that_chose_an_id_says_which(void **state)
{
    (void)state;
    char path[64];
    submit("POST", "/v1/meshes", CUBE, path);
    bench_reply r = job_in(path, "queued");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(r.json, "mesh")));
    bench_reply_free(&r);
    bench_run_jobs(bench, 1);
    r = job_in(path, "done");
    assert_string_equal(cJSON_GetObjectItem(r.json, "mesh")->valuestring,
                        inside(&r, "result", "id")->valuestring);
    bench_reply_free(&r);
}

static void a_job_keeps_its_problem(void **state)
{
    (void)state;
    char path[64];
    submit("POST", "/v1/meshes", "{\"vertices\":[[0,0,0],[1,0,0]],\"faces\":[[0,1]]}", path);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "failed");
    assert_int_equal(cJSON_GetObjectItem(r.json, "status")->valueint, 422);
    assert_string_equal(inside(&r, "problem", "code")->valuestring, "too_few_corners");
    assert_null(cJSON_GetObjectItem(r.json, "result"));
    bench_reply_free(&r);
}

static void what_is_wrong_with_the_request_is_said_at_once(void **state)
{
    (void)state;
    bench_reply r = expect(400, "POST", "/v1/meshes", async, "{\"shape\":\"cub\"}");
    bench_reply_free(&r);
    r = expect(400, "POST", "/v1/meshes?id=a%20b", async, CUBE);
    bench_reply_free(&r);
    send(201, "PUT", "/v1/meshes/m", LARGE);
    const char *const stale[] = {"Prefer", "respond-async", "If-Match", "\"0-0-0-x\"", NULL};
    r = expect(412, "POST", "/v1/meshes/m/edits", stale, TRANSFORM);
    bench_reply_free(&r);
    r = expect(412, "POST", "/v1/meshes/m/copy", stale, NULL);
    bench_reply_free(&r);
    /* the edit succeeds because no job has the exclusive right to write the mesh */
    send(200, "POST", "/v1/meshes/m/edits", POKE);
}

static void preconditions_are_asked_again_at_the_end(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", CUBE);
    bench_reply r = expect(200, "GET", "/v1/meshes/m", NULL, NULL);
    const char *const match[] = {"Prefer", "respond-async", "If-Match", bench_header(&r, "ETag"),
                                 NULL};
    bench_reply job = expect(202, "PUT", "/v1/meshes/m", match, CUBE);
    snprintf(path, sizeof path, "%s", bench_header(&job, "Location"));
    bench_reply_free(&job);
    bench_reply_free(&r);
    send(200, "POST", "/v1/meshes/m/edits", POKE);
    bench_run_jobs(bench, 1);
    job = job_in(path, "failed");
    assert_int_equal(cJSON_GetObjectItem(job.json, "status")->valueint, 412);
    bench_reply_free(&job);
}

static void a_job_that_waits_is_cancelled_at_once(void **state)
{
    (void)state;
    char path[64];
    submit("POST", "/v1/meshes?id=m", CUBE, path);
    bench_reply r = expect(202, "DELETE", path, NULL, NULL);
    assert_string_equal(cJSON_GetObjectItem(r.json, "state")->valuestring, "cancelled");
    bench_reply_free(&r);
    bench_run_jobs(bench, 1);
    r = job_in(path, "cancelled");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(r.json, "problem")));
    bench_reply_free(&r);
    send(404, "GET", "/v1/meshes/m", NULL);
    send(204, "DELETE", path, NULL);
    send(404, "DELETE", path, NULL);
}

static void beyond_the_queue_jobs_are_refused(void **state)
{
    (void)state;
    char path[64];
    bench_limit_jobs(bench, 2);
    submit("POST", "/v1/meshes", CUBE, path);
    submit("POST", "/v1/meshes", CUBE, path);
    bench_reply r = expect(503, "POST", "/v1/meshes", async, CUBE);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "too_many_jobs");
    assert_string_not_equal(bench_header(&r, "Retry-After"), "");
    bench_reply_free(&r);
    /* An edit that waits as a job claims its mesh (no other request may write it). If the queue has
     * no space for the job, the claim must be released. */
    send(201, "PUT", "/v1/meshes/m", LARGE);
    r = expect(503, "POST", "/v1/meshes/m/edits", async, TRANSFORM);
    bench_reply_free(&r);
    send(200, "POST", "/v1/meshes/m/edits", POKE);
}

static void jobs_are_listed_in_pages(void **state)
{
    (void)state;
    char path[64], next[128];
    for (int i = 0; i < 5; i++) {
        submit("POST", "/v1/meshes", CUBE, path);
    }
    snprintf(next, sizeof next, "/v1/jobs?limit=2");
    size_t seen = 0, pages = 0;
    for (bool more = true; more; pages++) {
        bench_reply r = expect(200, "GET", next, NULL, NULL);
        seen += (size_t)cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "items"));
        const cJSON *cursor = cJSON_GetObjectItem(r.json, "next");
        more = cJSON_IsString(cursor);
        if (more) {
            snprintf(next, sizeof next, "/v1/jobs?limit=2&cursor=%s", cursor->valuestring);
        }
        bench_reply_free(&r);
    }
    assert_int_equal(seen, 5);
    assert_int_equal(pages, 3);
    send(400, "GET", "/v1/jobs?cursor=j", NULL);
    send(400, "GET", "/v1/jobs?cursor=m1", NULL);
}

/* Requires that the request is refused because the job `job` has the exclusive right to write the
 * mesh, and that the refusal names this job. */
static void expect_named(const char *job, const char *method, const char *target, const char *body)
{
    bench_reply r = expect(409, method, target, NULL, body);
    const char *detail = cJSON_GetObjectItem(r.json, "detail")->valuestring;
    if (strstr(detail, job) == NULL) {
        fail_msg("%s does not name %s", detail, job);
    }
    bench_reply_free(&r);
}

static void a_long_edit_keeps_writers_out_and_lets_readers_in(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    submit("POST", "/v1/meshes/m/edits", TRANSFORM, path);
    bench_reply r = expect(409, "POST", "/v1/meshes/m/edits", NULL, POKE);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "mesh_busy");
    assert_string_not_equal(bench_header(&r, "Retry-After"), "");
    bench_reply_free(&r);
    expect_named(path, "POST", "/v1/meshes/m/edits", POKE);
    expect_named(path, "POST", "/v1/meshes/m/edits", TRANSFORM);
    expect_named(path, "PUT", "/v1/meshes/m", CUBE);
    send(409, "POST", "/v1/meshes/m/edits", TRANSFORM);
    send(409, "POST", "/v1/meshes/m/undo", NULL);
    send(409, "PATCH", "/v1/meshes/m", "{\"name\":\"x\"}");
    send(409, "PUT", "/v1/meshes/m", CUBE);
    send(200, "GET", "/v1/meshes/m", NULL);
    send(200, "GET", "/v1/meshes/m/vertices/0", NULL);
    send(200, "GET", "/v1/meshes/m/content?format=obj", NULL);
    bench_run_jobs(bench, 1);
    r = job_in(path, "done");
    assert_int_equal(inside(&r, "result", "revision")->valueint, 2);
    bench_reply_free(&r);
    send(200, "POST", "/v1/meshes/m/edits", POKE);
}

static void a_long_edit_is_undone_in_one_step_to_the_same_bits(void **state)
{
    (void)state;
    static const char *const edits[] = {
        TRANSFORM,
        "{\"op\":\"plane_split\",\"point\":[0.001,0,0],\"normal\":[1,0.3,0]}",
        "{\"ops\":[" TRANSFORM "," POKE ",{\"op\":\"edge_split\",\"edge\":7}]}",
    };
    st_store *store = bench_store(bench);
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        char path[64];
        st_mesh *mesh = NULL;
        he_mesh *before = NULL, *after = NULL;
        send(i == 0 ? 201 : 200, "PUT", "/v1/meshes/m", LARGE);
        assert_int_equal(st_find(store, "m", &mesh), ST_OK);
        assert_int_equal(he_mesh_copy(st_read_begin(mesh, NULL), &before, NULL), HE_OK);
        st_read_end(mesh);
        submit("POST", "/v1/meshes/m/edits", edits[i], path);
        bench_run_jobs(bench, 1);
        bench_reply r = job_in(path, "done");
        bench_reply_free(&r);
        const he_mesh *content = st_read_begin(mesh, NULL);
        assert_false(he_mesh_equal_live(before, content));
        assert_int_equal(he_mesh_copy(content, &after, NULL), HE_OK);
        st_read_end(mesh);
        send(200, "POST", "/v1/meshes/m/undo", NULL);
        assert_true(he_mesh_equal_live(before, st_read_begin(mesh, NULL)));
        st_read_end(mesh);
        send(200, "POST", "/v1/meshes/m/redo", NULL);
        assert_true(he_mesh_equal(after, st_read_begin(mesh, NULL)));
        st_read_end(mesh);
        st_release(mesh);
        he_mesh_free(before);
        he_mesh_free(after);
    }
}

static void a_refused_long_edit_gives_the_mesh_back(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    submit("POST", "/v1/meshes/m/edits",
           "{\"ops\":[" TRANSFORM ",{\"op\":\"edge_flip\",\"edge\":0}]}", path);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "failed");
    assert_string_equal(inside(&r, "problem", "pointer")->valuestring, "/ops/1");
    bench_reply_free(&r);
    submit("POST", "/v1/meshes/m/edits", TRANSFORM, path);
    r = expect(202, "DELETE", path, NULL, NULL); /* the job is cancelled before it begins */
    bench_reply_free(&r);
    r = expect(200, "POST", "/v1/meshes/m/edits", NULL, POKE);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 2);
    bench_reply_free(&r);
}

/* The answers to the long edits are ready, but the clients have not read them yet. The mesh must be
 * writable already. */
static void who_has_the_answer_to_a_long_edit_may_write(void **state)
{
    (void)state;
    static const struct {
        int status;
        const char *body;
    } unpublished[] = {
        {412, "{\"expected_revision\":9,\"ops\":[" TRANSFORM "]}"},
        {200, "{\"dry_run\":true,\"ops\":[" TRANSFORM "]}"},
        {422, "{\"ops\":[" TRANSFORM ",{\"op\":\"edge_flip\",\"edge\":0}]}"},
    };
    static const char *const patient[] = {"Prefer", "wait=20", NULL};
    bench_reply replies[3];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    for (size_t i = 0; i < 3; i++) {
        replies[i] = expect(unpublished[i].status, "POST", "/v1/meshes/m/edits", patient,
                            unpublished[i].body);
        send(200, "PATCH", "/v1/meshes/m", "{}");
    }
    for (size_t i = 0; i < 3; i++) {
        bench_reply_free(&replies[i]);
    }
}

static void a_mesh_may_be_deleted_under_a_long_edit(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    submit("POST", "/v1/meshes/m/edits", TRANSFORM, path);
    send(204, "DELETE", "/v1/meshes/m", NULL);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "failed");
    assert_string_equal(inside(&r, "problem", "code")->valuestring, "no_such_mesh");
    bench_reply_free(&r);
}

static void compact_as_a_job_ends_the_undo_stack(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    send(200, "POST", "/v1/meshes/m/edits", "{\"op\":\"face_delete\",\"face\":0}");
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"compact\"}", path);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "done");
    assert_true(cJSON_IsTrue(inside(&r, "result", "replaced")));
    bench_reply_free(&r);
    send(409, "POST", "/v1/meshes/m/undo", NULL);
    r = expect(200, "GET", "/v1/meshes/m/check", NULL, NULL);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(r.json, "valid")));
    bench_reply_free(&r);
}

/* The mesh is small, but the result of the subdivision is large, so the edit must run as a job. */
static void a_mesh_that_grows_large_is_refined_by_a_job(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    submit("POST", "/v1/meshes/m/edits", "{\"op\":\"subdivide\",\"steps\":7}", path);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "done");
    assert_true(cJSON_IsTrue(inside(&r, "result", "replaced")));
    bench_reply_free(&r);
    send(200, "POST", "/v1/meshes/m/undo", NULL);
    r = expect(200, "GET", "/v1/meshes/m/faces/5", NULL, NULL);
    bench_reply_free(&r);
    send(410, "GET", "/v1/meshes/m/faces/6", NULL);
}

/* A filling is charged by the faces that it is going to make: a few are made at once, many by a job
 * that can be cancelled, and too many are refused before any work. The mesh has six faces. */
static void a_hole_is_filled_with_many_faces_by_a_job(void **state)
{
    (void)state;
    static const struct {
        const char *edge_length;
        int status;
    } cases[] = {{"0.1", 200}, {"0.0055", 202}, {"0.0041", 413}, {"1e-9", 413}};
    send(201, "PUT", "/v1/meshes/m", CUBE);
    send(200, "POST", "/v1/meshes/m/edits", "{\"op\":\"face_delete\",\"face\":0}");
    bench_reply r = expect(200, "GET", "/v1/meshes/m/boundaries", NULL, NULL);
    const cJSON *loop = cJSON_GetObjectItem(r.json, "loops")->child;
    const int hole = cJSON_GetObjectItem(loop, "halfedge")->valueint;
    bench_reply_free(&r);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char body[200];
        snprintf(body, sizeof body,
                 "{\"op\":\"hole_fill\",\"halfedge\":%d,\"method\":\"smooth\",\"edge_length\":%s,"
                 "\"dry_run\":true}",
                 hole, cases[i].edge_length);
        r = expect(cases[i].status, "POST", "/v1/meshes/m/edits", NULL, body);
        if (cases[i].status == 202) {
            char path[64];
            snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
            send(202, "DELETE", path, NULL);
            bench_run_jobs(bench, 1);
        } else if (cases[i].status == 413) {
            assert_non_null(strstr(bench_text(&r, "detail"), "edge_length"));
            assert_non_null(strstr(bench_text(&r, "detail"), "100000"));
        }
        bench_reply_free(&r);
    }
    r = expect(200, "GET", "/v1/meshes/m", NULL, NULL);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 2);
    bench_reply_free(&r);
}

/* The refinements would need more ids than exist. The edit must be refused before a job begins, and
 * the mesh must stay writable. */
static void more_steps_than_ids_allow_are_refused_at_once(void **state)
{
    (void)state;
    static const char *const asked[][2] = {
        {"{\"op\":\"subdivide\",\"steps\":12}", ""},
        {"{\"ops\":[{\"op\":\"subdivide\",\"steps\":12}," TRANSFORM "]}", "/ops/0"},
    };
    send(201, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}");
    for (size_t i = 0; i < 2; i++) {
        bench_reply r = expect(413, "POST", "/v1/meshes/m/edits", NULL, asked[i][0]);
        assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "limit_exceeded");
        const cJSON *pointer = cJSON_GetObjectItem(r.json, "pointer");
        assert_string_equal(pointer == NULL ? "" : pointer->valuestring, asked[i][1]);
        bench_reply_free(&r);
        send(200, "POST", "/v1/meshes/m/edits", POKE);
    }
}

static void a_dry_run_changes_nothing_as_a_job_either(void **state)
{
    (void)state;
    char path[64];
    send(201, "PUT", "/v1/meshes/m", LARGE);
    submit("POST", "/v1/meshes/m/edits", "{\"dry_run\":true,\"ops\":[" TRANSFORM "]}", path);
    bench_run_jobs(bench, 1);
    bench_reply r = job_in(path, "done");
    assert_int_equal(inside(&r, "result", "revision")->valueint, 2);
    bench_reply_free(&r);
    r = expect(200, "POST", "/v1/meshes/m/edits", NULL, POKE);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 2);
    bench_reply_free(&r);
}

/* An edit that is estimated to take longer than a second becomes a job, unless the client says how
 * long it waits. */
static void what_is_estimated_above_a_second_becomes_a_job(void **state)
{
    (void)state;
    char body[128];
    unsigned side = 1800; /* the torus has 5 * side^2 vertices and corners */
    assert_true(5.0 * side * side > API_IMPORT_PER_SECOND * API_PATIENCE);
    snprintf(body, sizeof body, "{\"shape\":\"torus\",\"major_segments\":%u,\"minor_segments\":%u}",
             side, side);
    const char *const settings[][3] = {{NULL}, {"Prefer", "wait=0", NULL}};
    for (size_t i = 0; i < 2; i++) {
        bench_reply r = expect(202, "PUT", "/v1/meshes/t", i == 0 ? NULL : settings[i], body);
        assert_string_equal(bench_header(&r, "Preference-Applied"), "");
        char path[64];
        snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
        bench_reply_free(&r);
        r = expect(202, "DELETE", path, NULL, NULL);
        bench_reply_free(&r);
    }
    const char *const patient[] = {"Prefer", "respond-async, wait=20", NULL};
    bench_reply r = expect(201, "PUT", "/v1/meshes/t", patient, CUBE);
    bench_reply_free(&r);
}

static void preferences_are_read(void **state)
{
    (void)state;
    api_prefer p = api_prefer_read(NULL);
    assert_false(p.minimal || p.respond_async);
    assert_true(p.wait < 0);
    p = api_prefer_read("handling=lenient, Wait=12 , respond-async, return=minimal");
    assert_true(p.minimal && p.respond_async && p.wait == 12);
    assert_true(api_prefer_read("wait=").wait < 0);
    assert_true(api_prefer_read("await=3").wait < 0);
    assert_true(api_prefer_read("respond-async; wait=3").wait == 3);
    assert_true(api_prefer_read("wait=99999999999999999999").wait > 1e5);
}

/* --- listening to a job --- */

static int wakes;

static void note_wake(void *context)
{
    (void)context;
    wakes++;
}

static size_t read_some(const api_source *live, char *text, size_t size, int64_t *last)
{
    size_t length = 0;
    while ((*last = live->read(live->self, text + length, size - 1 - length)) > 0) {
        length += (size_t)*last;
    }
    text[length] = '\0';
    return length;
}

/* Opens the event stream of a job; the caller must free the exchange. */
static api_exchange *listen_to(const char *job, const api_source **live)
{
    char path[80];
    snprintf(path, sizeof path, "%s/events", job);
    api_request request = {.method = "GET", .path = path, .query = "", .request_id = "test"};
    api_exchange *x = api_handle(bench_service(bench), &request, NULL, 0);
    assert_non_null(x);
    assert_int_equal(api_answer_of(x)->status, 200);
    *live = api_answer_of(x)->live;
    assert_non_null(*live);
    (*live)->start((*live)->self, note_wake, NULL);
    return x;
}

/* The mesh of a job is deleted, and another mesh is created with the same id. Listeners of the new
 * mesh must get no events about the job. */
static void a_job_is_told_to_followers_of_its_own_mesh_only(void **state)
{
    (void)state;
    for (int cancelled = 0; cancelled < 2; cancelled++) {
        char path[64];
        static char text[100000];
        int64_t last;
        const api_source *old, *anew;
        send(201, "PUT", "/v1/meshes/m", LARGE);
        api_exchange *x = listen_to("/v1/meshes/m", &old);
        submit("POST", "/v1/meshes/m/edits", TRANSFORM, path);
        send(204, "DELETE", "/v1/meshes/m", NULL);
        send(201, "PUT", "/v1/meshes/m", CUBE);
        api_exchange *y = listen_to("/v1/meshes/m", &anew);
        if (cancelled != 0) {
            send(202, "DELETE", path, NULL);
        }
        bench_run_jobs(bench, 1);
        read_some(anew, text, sizeof text, &last);
        assert_int_equal(last, API_READ_WAIT);
        assert_null(strstr(text, "event: job"));
        api_free(x);
        api_free(y);
        send(204, "DELETE", "/v1/meshes/m", NULL);
    }
}

static void a_listener_hears_of_each_state_and_then_the_end(void **state)
{
    (void)state;
    char path[64];
    static char text[100000];
    int64_t last;
    const api_source *live;
    submit("POST", "/v1/meshes?id=m", CUBE, path);
    api_exchange *x = listen_to(path, &live);
    wakes = 0;
    read_some(live, text, sizeof text, &last);
    assert_int_equal(last, API_READ_WAIT);
    assert_memory_equal(text, "event: job\ndata: {", 18);
    assert_non_null(strstr(text, "\"queued\""));
    assert_int_equal(wakes, 0);
    bench_run_jobs(bench, 1);
    assert_int_equal(wakes, 1); /* the listener is not woken again before it has read its events */
    read_some(live, text, sizeof text, &last);
    assert_int_equal(last, 0);
    assert_non_null(strstr(text, "\"state\":\"done\""));
    assert_non_null(strstr(text, "\"result\":{\"id\":\"m\""));
    assert_non_null(strstr(text, "event: bye\ndata: {\"reason\":\"ended\"}"));
    api_free(x);

    /* A listener that connects after the end of the job gets the final event at once. */
    x = listen_to(path, &live);
    read_some(live, text, sizeof text, &last);
    assert_int_equal(last, 0);
    api_free(x);
}

static void a_listener_is_told_that_the_server_stops(void **state)
{
    (void)state;
    char path[64];
    static char text[100000];
    int64_t last;
    const api_source *live;
    submit("POST", "/v1/meshes?id=n", CUBE, path);
    api_exchange *x = listen_to(path, &live);
    read_some(live, text, sizeof text, &last);
    assert_int_equal(last, API_READ_WAIT);
    live->finish(live->self);
    read_some(live, text, sizeof text, &last);
    assert_int_equal(last, 0);
    assert_non_null(strstr(text, "stopping"));
    api_free(x);
    bench_run_jobs(bench, 1); /* a listener whose stream has ended is not woken */
}

/* --- when an allocation fails --- */

static const char *state_of(const char *path, char out[16])
{
    bench_reply r = expect(200, "GET", path, NULL, NULL);
    snprintf(out, 16, "%s", cJSON_GetObjectItem(r.json, "state")->valuestring);
    bench_reply_free(&r);
    return out;
}

/* Each allocation fails in turn, while the job is submitted or while it runs. Either the request is
 * refused, or the job fails and the mesh is unchanged, or both succeed. */
static void starve(const char *method, const char *target, const char *body)
{
    failing f = {.may_succeed = true, .what = target};
    while (failing_next(&f)) {
        failing_pause();
        char path[64] = "", name[16];
        bench_reply r;
        bench = bench_new();
        send(201, "PUT", "/v1/meshes/m", LARGE);
        failing_resume();
        bool sent = bench_try(
            bench, &(bench_request){method, target, async, body, body == NULL ? 0 : strlen(body)},
            &r);
        if (sent) {
            assert_true(r.status == 202 || r.status == 507);
            if (r.status == 202) {
                snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
            }
            bench_reply_free(&r);
        }
        bench_run_jobs(bench, 1);
        failing_pause();
        bool done = path[0] != '\0' && strcmp(state_of(path, name), "done") == 0;
        if (path[0] != '\0' && !done) {
            assert_string_equal(name, "failed");
            r = expect(200, "GET", "/v1/meshes/m", NULL, NULL);
            assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
            bench_reply_free(&r);
        }
        /* Whether the request was refused, or the job failed, or both succeeded, the mesh must be
         * writable afterwards. */
        send(200, "POST", "/v1/meshes/m/edits", POKE);
        bench_free(bench);
        bench = NULL;
        failing_end(&f, done);
        assert_int_equal(failing_blocks(), 0);
    }
}

static void jobs_without_memory(void **state)
{
    (void)state;
    starve("POST", "/v1/meshes/m/edits", TRANSFORM);
    starve("POST", "/v1/meshes/m/edits", "{\"op\":\"compact\"}");
    starve("POST", "/v1/meshes", CUBE);
    starve("POST", "/v1/meshes/m/copy", NULL);
}

#define JOB_TEST(f) cmocka_unit_test_setup_teardown(f, start, stop)

int main(void)
{
    const struct CMUnitTest tests[] = {
        JOB_TEST(a_job_keeps_what_the_request_would_have_answered),
        JOB_TEST(a_job_that_chose_an_id_says_which),
        JOB_TEST(a_job_keeps_its_problem),
        JOB_TEST(what_is_wrong_with_the_request_is_said_at_once),
        JOB_TEST(preconditions_are_asked_again_at_the_end),
        JOB_TEST(a_job_that_waits_is_cancelled_at_once),
        JOB_TEST(beyond_the_queue_jobs_are_refused),
        JOB_TEST(jobs_are_listed_in_pages),
        JOB_TEST(a_long_edit_keeps_writers_out_and_lets_readers_in),
        JOB_TEST(a_long_edit_is_undone_in_one_step_to_the_same_bits),
        JOB_TEST(a_refused_long_edit_gives_the_mesh_back),
        JOB_TEST(who_has_the_answer_to_a_long_edit_may_write),
        JOB_TEST(a_mesh_may_be_deleted_under_a_long_edit),
        JOB_TEST(compact_as_a_job_ends_the_undo_stack),
        JOB_TEST(a_mesh_that_grows_large_is_refined_by_a_job),
        JOB_TEST(a_hole_is_filled_with_many_faces_by_a_job),
        JOB_TEST(more_steps_than_ids_allow_are_refused_at_once),
        JOB_TEST(a_dry_run_changes_nothing_as_a_job_either),
        JOB_TEST(what_is_estimated_above_a_second_becomes_a_job),
        JOB_TEST(a_job_is_told_to_followers_of_its_own_mesh_only),
        JOB_TEST(a_listener_hears_of_each_state_and_then_the_end),
        JOB_TEST(a_listener_is_told_that_the_server_stops),
        cmocka_unit_test(preferences_are_read),
        cmocka_unit_test(jobs_without_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
