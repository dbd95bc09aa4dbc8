/* Long reads that run as jobs. After the job the client fetches the answer, which must have the
 * bytes, media type and entity tag of a direct answer, whether it is JSON, JSON lines, octets or a
 * file. */
#include "tests/api/request.h"

#include "base/mem.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PATH = 128 };

static void get_string(const bench_reply *r, const char *name, char out[PATH])
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(r->json, name);
    if (!cJSON_IsString(member)) {
        fail_msg("no text %s: %.300s", name, r->body);
    }
    snprintf(out, PATH, "%s", member->valuestring);
}

static api_bench *bench_of_sphere(void)
{
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"icosphere\"}")));
    bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", NULL,
                                            "{\"op\":\"face_delete\",\"face\":0}")));
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m/attributes/faces/a", NULL,
                                            "{\"type\":\"uint32\"}")));
    return b;
}

/* A request that reads. If `accept` is NULL, it has no header Accept, so it accepts anything. */
typedef struct reading {
    const char *method, *target, *body, *accept;
    /* set if the job shows a link to its answer instead of the answer itself, because the answer is
     * a whole mesh or is not JSON */
    bool linked;
} reading;

static const reading readings[] = {
    {"GET", "/v1/meshes/m", NULL, NULL, false},
    {"GET", "/v1/meshes/m?revision=1", NULL, NULL, false},
    {"GET", "/v1/meshes/m/content", NULL, NULL, true},
    {"GET", "/v1/meshes/m/content", NULL, "model/stl", true},
    {"GET", "/v1/meshes/m/content?format=obj", NULL, NULL, true},
    {"GET", "/v1/meshes/m/content?format=glb&revision=1", NULL, NULL, true},
    {"GET", "/v1/meshes/m/geometry", NULL, NULL, true},
    {"GET", "/v1/meshes/m/progressive?revision=1", NULL, NULL, true},
    {"GET", "/v1/meshes/m/vertices?limit=5", NULL, NULL, false},
    {"GET", "/v1/meshes/m/faces", NULL, "application/x-ndjson", true},
    {"GET", "/v1/meshes/m/faces", NULL, "application/octet-stream", true},
    {"GET", "/v1/meshes/m/attributes/faces/a", NULL, NULL, false},
    {"GET", "/v1/meshes/m/attributes/faces/a", NULL, "application/octet-stream", true},
    {"GET", "/v1/meshes/m/boundaries", NULL, NULL, false},
    {"GET", "/v1/meshes/m/components", NULL, NULL, false},
    {"GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL, false},
    {"POST", "/v1/meshes/m/query", "{\"queries\":[{\"get\":{\"edge\":3}},{\"ray\":1}]}", NULL,
     false},
    {"POST", "/v1/meshes/m/query",
     "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"vertices\":\"all\"}}]}",
     "application/octet-stream", true},
    {"POST", "/v1/meshes/m/compare", "{\"with\":1,\"bound\":0.1}", NULL, false},
    {"POST", "/v1/meshes/m/traverse", "{\"walk\":\"rings\",\"from\":{\"vertex\":5},\"depth\":2}",
     NULL, false},
    {"POST", "/v1/meshes/m/deform", "{\"op\":\"deform\",\"vertex\":5,\"by\":[0,0,1]}", NULL, true},
};

/* Sends a request that reads, with If-None-Match: `known` unless `known` is NULL. */
static bench_reply send_known(api_bench *b, const reading *r, bool async, const char *known)
{
    const char *headers[9] = {"Content-Type", "application/json"};
    size_t count = 2;
    if (known != NULL) {
        headers[count++] = "If-None-Match";
        headers[count++] = known;
    }
    if (r->accept != NULL) {
        headers[count++] = "Accept";
        headers[count++] = r->accept;
    }
    if (async) {
        headers[count++] = "Prefer";
        headers[count++] = "respond-async";
    }
    return bench_send(b, r->method, r->target, headers, r->body);
}

static bench_reply send(api_bench *b, const reading *r, bool async)
{
    return send_known(b, r, async, NULL);
}

static void expect_same(const bench_reply *given, const bench_reply *wanted)
{
    static const char *const names[] = {"Content-Type", "ETag", "Content-Disposition",
                                        "Export-Warnings"};
    assert_int_equal(given->length, wanted->length);
    assert_memory_equal(given->body, wanted->body, wanted->length);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_string_equal(bench_header(given, names[i]), bench_header(wanted, names[i]));
    }
}

static void read_as_a_job(api_bench *b, const reading *r)
{
    char path[PATH], link[PATH + 8];
    bench_reply wanted = bench_expect(200, send(b, r, false));
    bench_reply begun = bench_expect(202, send(b, r, true));
    assert_string_equal(bench_header(&begun, "Preference-Applied"), "respond-async");
    snprintf(path, sizeof path, "%s", bench_header(&begun, "Location"));
    snprintf(link, sizeof link, "%s/result", path);
    bench_done(begun);
    bench_reply early = bench_expect(202, bench_get(b, link));
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(early.json, "result_link")));
    bench_done(early);
    bench_run_jobs(b, 1);
    bench_reply job = bench_expect(200, bench_get(b, path));
    char told[PATH];
    get_string(&job, "state", told);
    assert_string_equal(told, "done");
    get_string(&job, "result_link", told);
    assert_string_equal(told, link);
    const cJSON *result = cJSON_GetObjectItemCaseSensitive(job.json, "result");
    assert_int_equal(cJSON_IsNull(result), r->linked);
    assert_true(r->linked || cJSON_Compare(result, wanted.json, true));
    bench_reply given = bench_expect(200, bench_get(b, link));
    expect_same(&given, &wanted);
    bench_done(given);
    bench_done(job);
    bench_done(wanted);
}

static void each_long_read_can_be_a_job_with_the_answer_it_would_have_given(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    for (size_t i = 0; i < sizeof readings / sizeof *readings; i++) {
        print_message("%s %s\n", readings[i].method, readings[i].target);
        read_as_a_job(b, &readings[i]);
    }
    bench_free(b);
}

/* Starts a job; `path` becomes the path of the job in the API. */
static void begin(api_bench *b, const char *target, char path[PATH])
{
    const reading r = {"GET", target, NULL, NULL, true};
    bench_reply begun = bench_expect(202, send(b, &r, true));
    snprintf(path, PATH, "%s", bench_header(&begun, "Location"));
    bench_done(begun);
}

static void a_read_that_waits_is_no_job(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    static const char *const patient[] = {"Prefer", "respond-async, wait=5", NULL};
    bench_done(bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/content", patient, NULL)));
    static const char *const async[] = {"Prefer", "respond-async", NULL};
    bench_done(bench_expect(200, bench_send(b, "GET", "/v1/meshes/m/faces/1", async, NULL)));
    bench_free(b);
}

static void expect_no_jobs(api_bench *b)
{
    bench_reply r = bench_expect(200, bench_get(b, "/v1/jobs"));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "items")), 0);
    bench_done(r);
}

static void what_is_refused_is_refused_before_there_is_a_job(void **state)
{
    (void)state;
    static const char octets[] = "application/octet-stream", lines[] = "application/x-ndjson";
    static const struct {
        reading read;
        const char *said; /* text that the problem document of the refusal must contain */
    } cases[] = {
        {{"GET", "/v1/meshes/none/geometry", NULL, NULL, false}, "none"},
        {{"GET", "/v1/meshes/m?none=1", NULL, NULL, false}, "none"},
        {{"GET", "/v1/meshes/m?revision=9", NULL, NULL, false}, "revision"},
        {{"GET", "/v1/meshes/m/geometry?since=1", NULL, NULL, false}, "layout"},
        {{"GET", "/v1/meshes/m/vertices?cursor=none", NULL, NULL, false}, "cursor"},
        {{"GET", "/v1/meshes/m/vertices?limit=2", NULL, lines, false}, "limit"},
        {{"GET", "/v1/meshes/m/vertices?revision=1&limit=2", NULL, lines, false}, "limit"},
        {{"GET", "/v1/meshes/m/attributes/faces/b", NULL, NULL, false}, "\\\"b\\\""},
        {{"GET", "/v1/meshes/m/attributes/faces/b", NULL, octets, false}, "\\\"b\\\""},
        {{"GET", "/v1/meshes/m/attributes/faces/a?revision=2", NULL, NULL, false},
         "no_such_attribute"},
        {{"GET", "/v1/meshes/m/attributes/faces/a?ids=0", NULL, NULL, false}, "face 0"},
        {{"GET", "/v1/meshes/m/attributes/faces/a?ids=x", NULL, NULL, false}, "ids"},
        {{"GET", "/v1/meshes/m/attributes/faces/a?cursor=x", NULL, NULL, false}, "cursor"},
        {{"POST", "/v1/meshes/m/query", "{", NULL, false}, "malformed_json"},
        {{"POST", "/v1/meshes/m/query", "{\"ask\":[]}", NULL, false}, "/ask"},
        {{"POST", "/v1/meshes/m/query?revision=1", "{}", NULL, false}, "queries"},
        {{"POST", "/v1/meshes/m/query", "{\"queries\":3}", NULL, false}, "/queries"},
        {{"POST", "/v1/meshes/m/query", "{\"queries\":[{\"get\":{\"edge\":3}}]}", octets, false},
         "not_acceptable"},
        {{"POST", "/v1/meshes/m/query",
          "{\"queries\":[{\"relation\":\"none\",\"of\":{\"faces\":\"all\"}}]}", octets, false},
         "/queries/0/relation"},
        {{"POST", "/v1/meshes/m/query",
          "{\"queries\":[{\"measure\":\"area\",\"of\":{\"faces\":[1,0]}}]}", octets, false},
         "/queries/0/of/faces/1"},
        {{"POST", "/v1/meshes/m/traverse", "{\"walk\":\"away\"}", NULL, false}, "/walk"},
        {{"POST", "/v1/meshes/m/traverse?revision=1", "{\"walk\":\"loop\"}", NULL, false}, "from"},
        {{"POST", "/v1/meshes/m/traverse",
          "{\"walk\":\"path\",\"from\":{\"halfedge\":3},\"path\":[\"next\",\"up\"]}", NULL, false},
         "/path/1"},
        {{"POST", "/v1/meshes/m/traverse", "{\"walk\":\"loop\",\"from\":{\"face\":3}}", NULL,
          false},
         "/from"},
        {{"POST", "/v1/meshes/m/traverse", "{\"walk\":\"rings\",\"from\":{\"vertex\":3}}", NULL,
          false},
         "depth"},
        {{"POST", "/v1/meshes/m/traverse",
          "{\"walk\":\"breadth_first\",\"from\":{\"vertex\":3},\"limit\":0}", NULL, false},
         "/limit"},
        {{"POST", "/v1/meshes/m/traverse",
          "{\"walk\":\"shortest_path\",\"from\":{\"vertex\":3},\"to\":{\"vertex\":4},"
          "\"by\":\"air\"}",
          NULL, false},
         "/by"},
        {{"POST", "/v1/meshes/m/traverse",
          "{\"walk\":\"edge_ring\",\"from\":{\"edge\":3},\"to\":4}", NULL, false},
         "/to"},
        {{"POST", "/v1/meshes/m/traverse", "{\"walk\":\"edge_loop\",\"from\":{\"edge\":4000000}}",
          NULL, false},
         "/from/edge"},
    };
    api_bench *b = bench_of_sphere();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        print_message("%s %s\n", cases[i].read.target, cases[i].read.body);
        bench_reply wanted = send(b, &cases[i].read, false);
        assert_in_range(wanted.status, 400, 499);
        bench_reply r = bench_expect(wanted.status, send(b, &cases[i].read, true));
        if (strstr(r.body, cases[i].said) == NULL) {
            fail_msg("no word of %s: %s", cases[i].said, r.body);
        }
        assert_string_equal(r.body, wanted.body);
        bench_done(wanted);
        bench_done(r);
    }
    expect_no_jobs(b);
    bench_free(b);
}

/* If the client names the entity tag of the answer, it must get a 304 at once and no job, even for
 * an earlier revision, which would have to be restored before it can be read. */
static void what_the_client_has_is_told_at_once_instead_of_by_a_job(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    size_t told = 0;
    for (size_t i = 0; i < sizeof readings / sizeof *readings; i++) {
        char tag[PATH];
        bench_reply r = bench_expect(200, send(b, &readings[i], false));
        snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
        bench_done(r);
        if (tag[0] != '\0') {
            print_message("%s %s\n", readings[i].target, tag);
            r = bench_expect(304, send_known(b, &readings[i], true, tag));
            assert_string_equal(bench_header(&r, "ETag"), tag);
            bench_done(r);
            told++;
        }
    }
    /* answers to POST have no entity tag */
    assert_int_equal(told, sizeof readings / sizeof *readings - 5);
    expect_no_jobs(b);
    bench_free(b);
}

/* An answer that lists only the changes since a revision has an entity tag of its own. A client
 * that has this answer must get a 304 at once: the service computes the tag without making the
 * answer. */
static void changed_rows_that_the_client_has_are_told_at_once(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    char tag[PATH], target[PATH];
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/geometry"));
    uint64_t layout = 0;
    for (int i = 7; i >= 0; i--) {
        layout = layout << 8 | (unsigned char)r.body[80 + i];
    }
    bench_done(r);
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":1}")));
    snprintf(target, sizeof target, "/v1/meshes/m/geometry?since=3&layout=%llu",
             (unsigned long long)layout);
    const reading changes = {"GET", target, NULL, NULL, true};
    r = bench_expect(200, send(b, &changes, false));
    snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
    bench_done(r);
    assert_non_null(strstr(tag, "-3\""));
    bench_done(bench_expect(304, send_known(b, &changes, true, tag)));
    /* The entity tag of the answer with the changes must not match the answer with the whole
     * arrays, so a job begins. A `since` later than the newest revision is refused when the arrays
     * are read, whatever tag the client names. */
    bench_done(bench_expect(202, send_known(b, &readings[6], true, tag)));
    const char *later = strchr(target, '?') + 1;
    memcpy(target + (later - target), "since=9", 7);
    bench_done(bench_expect(400, send_known(b, &changes, false, "*")));
    bench_free(b);
}

/* The client guesses the entity tag of a revision that is made while its job waits. The result of
 * the job must be the whole answer and not a 304, because the request was accepted before. */
static void the_result_of_a_job_is_the_answer_though_its_tag_was_named(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    for (size_t i = 0; i < sizeof readings / sizeof *readings; i++) {
        const reading *r = &readings[i];
        char tag[PATH], path[PATH], link[PATH + 8];
        bool present = strstr(r->target, "revision") == NULL;
        bench_reply now = bench_expect(200, send(b, r, false));
        snprintf(tag, sizeof tag, "%s", bench_header(&now, "ETag"));
        bench_done(now);
        /* the entity tag of the arrays of a mesh is partly random */
        bool slots = strstr(r->target, "geometry") != NULL;
        if (tag[0] == '\0' || !present || slots) {
            continue;
        }
        char *revision = strchr(strchr(tag, '-') + 1, '-') + 1;
        uint64_t at = strtoull(revision, NULL, 10);
        char next[PATH];
        snprintf(next, sizeof next, "%.*s%llu%s", (int)(revision - tag), tag,
                 (unsigned long long)at + 1, strchr(revision, '-'));
        bench_reply begun = bench_expect(202, send_known(b, r, true, next));
        snprintf(path, sizeof path, "%s", bench_header(&begun, "Location"));
        bench_done(begun);
        bench_done(bench_expect(
            200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":1}")));
        bench_run_jobs(b, 1);
        snprintf(link, sizeof link, "%s/result", path);
        bench_reply given = bench_expect(200, bench_get(b, link));
        assert_string_equal(bench_header(&given, "ETag"), next);
        assert_true(given.length > 0);
        bench_done(given);
    }
    bench_free(b);
}

static void expect_no_result(api_bench *b, const char *path, const char *why)
{
    char link[PATH + 8];
    snprintf(link, sizeof link, "%s/result", path);
    bench_reply r = bench_expect(404, bench_get(b, link));
    char told[PATH];
    get_string(&r, "code", told);
    assert_string_equal(told, "no_such_result");
    get_string(&r, "detail", told);
    assert_non_null(strstr(told, why));
    bench_done(r);
    r = bench_expect(200, bench_get(b, path));
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(r.json, "result_link")));
    bench_done(r);
}

static void a_job_without_an_answer_has_no_result(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    char failed[PATH], cancelled[PATH];
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=quads", "{\"shape\":\"cube\"}")));
    begin(b, "/v1/meshes/quads/progressive", failed);
    begin(b, "/v1/meshes/m/geometry", cancelled);
    bench_done(bench_expect(202, bench_send(b, "DELETE", cancelled, NULL, NULL)));
    bench_run_jobs(b, 2);
    expect_no_result(b, failed, "failed");
    expect_no_result(b, cancelled, "cancelled");
    bench_done(bench_expect(404, bench_get(b, "/v1/jobs/none/result")));
    bench_free(b);
}

static void a_result_that_the_client_has_is_not_sent_again(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    char path[PATH], link[PATH + 8], tag[PATH];
    begin(b, "/v1/meshes/m/content?format=obj", path);
    bench_run_jobs(b, 1);
    snprintf(link, sizeof link, "%s/result", path);
    bench_reply r = bench_expect(200, bench_get(b, link));
    snprintf(tag, sizeof tag, "%s", bench_header(&r, "ETag"));
    bench_done(r);
    const char *const known[] = {"If-None-Match", tag, NULL};
    bench_done(bench_expect(304, bench_send(b, "GET", link, known, NULL)));
    bench_free(b);
}

/* A client that has begun to read the result of a job can read all of it, even if the job is
 * deleted meanwhile. */
static void a_result_outlives_its_job_while_it_is_read(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    char path[PATH], link[PATH + 8];
    begin(b, "/v1/meshes/m/content?format=obj", path);
    bench_run_jobs(b, 1);
    snprintf(link, sizeof link, "%s/result", path);
    api_step step;
    const api_request request = {.method = "GET", .path = link, .query = "", .request_id = "r"};
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    assert_int_equal(api_end(x), API_READY);
    bench_done(bench_expect(204, bench_send(b, "DELETE", path, NULL, NULL)));
    bench_done(bench_expect(404, bench_get(b, link)));
    const api_answer *answer = api_answer_of(x);
    bench_reply wanted = bench_expect(200, bench_get(b, "/v1/meshes/m/content?format=obj"));
    assert_int_equal(answer->length, wanted.length);
    assert_memory_equal(answer->bytes, wanted.body, wanted.length);
    bench_done(wanted);
    api_free(x);
    bench_free(b);
}

/* The job begins after the memory of the request's headers has been overwritten, so it must have
 * copied them. */
static void a_job_has_copies_of_its_headers(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    char accept[] = "model/stl", prefer[] = "respond-async", path[PATH], link[PATH + 8];
    const char *const headers[] = {"Accept", accept, "Prefer", prefer, NULL};
    bench_reply r = bench_expect(202, bench_send(b, "GET", "/v1/meshes/m/content", headers, NULL));
    memcpy(accept, "model/obj", sizeof accept);
    memset(prefer, '?', sizeof prefer - 1);
    snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
    bench_done(r);
    bench_run_jobs(b, 1);
    snprintf(link, sizeof link, "%s/result", path);
    r = bench_expect(200, bench_get(b, link));
    assert_string_equal(bench_header(&r, "Content-Type"), "model/stl");
    bench_done(r);
    bench_free(b);
}

/* --- memory --- */

static void a_starved_job_has_failed_or_its_whole_answer(void **state)
{
    (void)state;
    api_bench *b = bench_of_sphere();
    bench_reply wanted = bench_expect(200, bench_get(b, "/v1/meshes/m/content?format=obj"));
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        char path[PATH], link[PATH + 8];
        begin(b, "/v1/meshes/m/content?format=obj", path);
        failing_resume();
        bench_run_jobs(b, 1);
        failing_pause();
        snprintf(link, sizeof link, "%s/result", path);
        bench_reply r = bench_get(b, link);
        assert_true(failing_end(&f, r.status == 200) || r.status == 404);
        if (r.status == 200) {
            assert_int_equal(r.length, wanted.length);
            assert_memory_equal(r.body, wanted.body, wanted.length);
        }
        bench_done(r);
        bench_done(bench_expect(204, bench_send(b, "DELETE", path, NULL, NULL)));
    }
    bench_done(wanted);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_long_read_can_be_a_job_with_the_answer_it_would_have_given),
        cmocka_unit_test(a_read_that_waits_is_no_job),
        cmocka_unit_test(what_is_refused_is_refused_before_there_is_a_job),
        cmocka_unit_test(what_the_client_has_is_told_at_once_instead_of_by_a_job),
        cmocka_unit_test(changed_rows_that_the_client_has_are_told_at_once),
        cmocka_unit_test(the_result_of_a_job_is_the_answer_though_its_tag_was_named),
        cmocka_unit_test(a_job_without_an_answer_has_no_result),
        cmocka_unit_test(a_result_that_the_client_has_is_not_sent_again),
        cmocka_unit_test(a_result_outlives_its_job_while_it_is_read),
        cmocka_unit_test(a_job_has_copies_of_its_headers),
        cmocka_unit_test(a_starved_job_has_failed_or_its_whole_answer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
