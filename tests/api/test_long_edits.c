/* Long edits while other things happen to their mesh: what the listeners hear, and what the history
 * contains afterwards. */
#include "tests/api/stream.h"

#include "api/job/job_table.h"
#include "tests/model/random.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

static int send(api_bench *b, const char *method, const char *target, const char *body)
{
    bench_reply r = bench_send(b, method, target, NULL, body);
    int status = r.status;
    bench_reply_free(&r);
    return status;
}

/* Submits a job and requires that it is accepted (202); the caller must free the exchange. */
static api_exchange *submit(api_bench *b, const char *path, const char *body)
{
    api_request request = {
        .method = "POST",
        .path = path,
        .query = "",
        .request_id = "test",
        .headers =
            {[API_HEADER_CONTENT_TYPE] = "application/json", [API_HEADER_PREFER] = "respond-async"},
        .has_length = true,
        .length = strlen(body),
        .has_body = true};
    api_exchange *x = api_handle(bench_service(b), &request, body, strlen(body));
    assert_int_equal(api_answer_of(x)->status, 202);
    return x;
}

static void assert_job(listener *l, const char *state)
{
    assert_string_equal(stream_next(l, false), "job");
    assert_string_equal(stream_text(l, "state"), state);
    assert_int_equal(strlen(stream_text(l, "id")), API_JOB_ID);
    assert_int_equal(stream_number(l, "progress"), strcmp(state, "done") == 0);
    assert_int_equal(cJSON_GetArraySize(l->data), 3);
}

static void jobs_of_a_mesh_are_told_as_they_begin_and_end(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":0}";
    api_bench *b = bench_new();
    assert_int_equal(send(b, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}"), 201);
    assert_int_equal(send(b, "POST", "/v1/meshes/m/edits", poke), 200);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    assert_string_equal(stream_next(l, false), "");
    api_free(submit(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":1}"));
    bench_run_jobs(b, 1);
    assert_job(l, "running");
    assert_string_equal(stream_next(l, false), "edit");
    assert_int_equal(stream_number(l, "revision"), 3);
    assert_job(l, "done");
    /* Three more jobs: one fails, one creates another mesh, and one is cancelled before it
     * begins. */
    api_free(submit(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":99}"));
    bench_run_jobs(b, 1);
    assert_job(l, "running");
    assert_job(l, "failed");
    api_free(submit(b, "/v1/meshes/m/copy", "{}"));
    bench_run_jobs(b, 1);
    assert_job(l, "running");
    assert_job(l, "done");
    api_exchange *x = submit(b, "/v1/meshes/m/edits", poke);
    const char *path = "";
    for (size_t i = 0; i < api_answer_of(x)->header_count; i++) {
        const api_header *header = &api_answer_of(x)->headers[i];
        path = strcmp(header->name, "Location") == 0 ? header->value : path;
    }
    assert_int_equal(send(b, "DELETE", path, NULL), 202);
    api_free(x);
    assert_job(l, "cancelled");
    bench_run_jobs(b, 1);
    assert_string_equal(stream_next(l, false), "");
    /* The mesh is deleted while a job waits. The event stream of the mesh ends, without an event
     * about the end of the job. */
    api_free(submit(b, "/v1/meshes/m/edits", poke));
    assert_int_equal(send(b, "DELETE", "/v1/meshes/m", NULL), 204);
    bench_run_jobs(b, 1);
    assert_string_equal(stream_next(l, false), "bye");
    assert_string_equal(stream_next(l, false), "");
    stream_close(l);
    bench_free(b);
}

/* --- long edits, attributes and undo steps together --- */

enum { REVISIONS = 80, SOME = 6 };

/* Creates a mesh so large that an edit of all its elements works on a copy, which then replaces the
 * mesh. */
static void put_large(api_bench *b)
{
    int status =
        send(b, "PUT", "/v1/meshes/m", "{\"shape\":\"grid\",\"columns\":200,\"rows\":200}");
    assert_true(status == 200 || status == 201);
}

static void run_job(api_bench *b, md_random *random)
{
    char body[200];
    (void)snprintf(body, sizeof body,
                   "{\"ops\":[{\"op\":\"plane_split\",\"point\":[0.%03u,0.001,0],"
                   "\"normal\":[1,0.%u,0]},{\"op\":\"face_poke\",\"face\":%u}]}",
                   md_below(random, 400), md_below(random, 10), md_below(random, 40000));
    api_free(submit(b, "/v1/meshes/m/edits", body));
    assert_int_equal(send(b, "POST", "/v1/meshes/m/undo", NULL), 409);
    bench_run_jobs(b, 1);
}

static void write_attribute(api_bench *b, md_random *random)
{
    char target[80], body[120];
    (void)snprintf(target, sizeof target, "/v1/meshes/m/attributes/faces/a%u", md_below(random, 2));
    switch (md_below(random, 4)) {
    case 0:
        (void)snprintf(body, sizeof body, "{\"type\":\"%s\"}",
                       md_below(random, 2) == 0 ? "bool" : "float");
        (void)send(b, "PUT", target, body);
        return;
    case 1:
        (void)send(b, "DELETE", target, NULL);
        return;
    default:
        (void)snprintf(body, sizeof body, "{\"ids\":[%u],\"value\":%s}", md_below(random, 40000),
                       md_below(random, 2) == 0 ? "true" : "0.5");
        (void)send(b, "PATCH", target, body);
        return;
    }
}

static void do_something(api_bench *b, md_random *random, int turn)
{
    char body[80];
    switch (turn == 0 ? 0 : md_below(random, 6)) {
    case 0:
        run_job(b, random);
        return;
    case 1:
        (void)snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%u}",
                       md_below(random, 40000));
        (void)send(b, "POST", "/v1/meshes/m/edits", body);
        return;
    case 2:
    case 3:
        write_attribute(b, random);
        return;
    default:
        (void)snprintf(body, sizeof body, "{\"steps\":%u}", md_from(random, 1, 3));
        (void)send(b, "POST", md_below(random, 3) == 0 ? "/v1/meshes/m/redo" : "/v1/meshes/m/undo",
                   body);
        return;
    }
}

/* Stores a copy of each revision after the revision `known`. The copy of the newest one must equal
 * the mesh. Some of the earlier revisions are read again and compared with their stored copies. */
static uint64_t note_revisions(api_bench *b, he_mesh *copies[REVISIONS], uint64_t known)
{
    st_mesh *mesh = stream_mesh(b);
    st_mesh_info info;
    const he_mesh *content = st_read_begin(mesh, &info);
    assert_true(info.revision < REVISIONS);
    if (info.revision > known) {
        assert_int_equal(he_mesh_copy(content, &copies[info.revision], NULL), HE_OK);
    }
    st_read_end(mesh);
    for (uint64_t r = 1; r < info.revision; r++) {
        if (r <= known && (r + known) % SOME != 0) {
            continue;
        }
        st_snapshot *snapshot;
        assert_int_equal(st_snapshot_at(mesh, r, &snapshot), ST_OK);
        const he_mesh *past = st_snapshot_content(snapshot, NULL);
        if (r > known) {
            assert_int_equal(he_mesh_copy(past, &copies[r], NULL), HE_OK);
        } else {
            assert_true(he_mesh_equal_live(past, copies[r]));
        }
        st_snapshot_release(snapshot);
    }
    st_release(mesh);
    return info.revision;
}

static void long_edits_attributes_and_steps_are_told_and_kept(void **state)
{
    (void)state;
    md_random random = {seed_of_run()};
    he_mesh *copies[REVISIONS] = {NULL};
    mirror copy = {0};
    api_bench *b = bench_new();
    put_large(b);
    listener *l = stream_open(b, "/v1/meshes/m/events", "", NULL);
    stream_dump(b, &copy);
    uint64_t known = note_revisions(b, copies, 0);
    unsigned anew = 0;
    for (int turn = 0; turn < 24; turn++) {
        do_something(b, &random, turn);
        anew += stream_follow(b, l, &copy);
        stream_require(b, &copy, "a turn");
        known = note_revisions(b, copies, known);
    }
    printf("note: %u revisions, taken anew %u times\n", (unsigned)known, anew);
    for (size_t i = 0; i < REVISIONS; i++) {
        he_mesh_free(copies[i]);
    }
    stream_close(l);
    mirror_clear(&copy);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_of_a_mesh_are_told_as_they_begin_and_end),
        cmocka_unit_test(long_edits_attributes_and_steps_are_told_and_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
