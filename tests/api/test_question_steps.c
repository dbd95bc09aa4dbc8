/* The budget of a request is charged for each bounding box and triangle that a spatial search
 * visits. A search among thousands of triangles around one vertex must be completed, but a short
 * request that would cause very much work must be refused. */
#include "tests/api/fan.h"

#include "api/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define QUERY "/v1/meshes/m/query"

static const cJSON *in(const cJSON *object, const char *name)
{
    const cJSON *member = cJSON_GetObjectItemCaseSensitive(object, name);
    if (member == NULL) {
        fail_msg("there is no %s", name);
    }
    return member;
}

static void a_flat_fan_of_thousands_is_searched_whole(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    fan_put(b, "/v1/meshes/m", 10000, 1);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_true(cJSON_IsTrue(in(r.json, "complete")));
    assert_int_equal(in(in(r.json, "totals"), "self_intersection")->valueint, 0);
    bench_reply_free(&r);
    bench_free(b);
}

static void expect_steps(const char *detail, const char *of)
{
    char steps[64];
    snprintf(steps, sizeof steps, " %d computing steps that all questions of a %s ",
             (int)API_MAX_STEPS, of);
    if (strstr(detail, steps) == NULL || strstr(detail, "Prefer: respond-async") == NULL) {
        fail_msg("%s", detail);
    }
}

static void a_check_beyond_its_steps_is_refused_and_names_the_limit_and_a_job(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    fan_put(b, "/v1/meshes/m", 2001, 801);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL);
    assert_int_equal(r.status, 413);
    assert_string_equal(in(r.json, "code")->valuestring, "limit_exceeded");
    expect_steps(in(r.json, "detail")->valuestring, "request");
    bench_reply_free(&r);
    bench_free(b);
}

static void a_check_beyond_its_steps_is_a_job_where_the_client_takes_one(void **state)
{
    (void)state;
    static const char *const patient[] = {"Prefer", "respond-async, wait=60", NULL};
    api_bench *b = bench_new();
    fan_put(b, "/v1/meshes/m", 2001, 801);
    bench_reply r =
        bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", patient, NULL);
    assert_int_equal(r.status, 202);
    char path[128];
    snprintf(path, sizeof path, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
    bench_run_jobs(b, 1);
    r = bench_expect(200, bench_get(b, path));
    assert_string_equal(in(r.json, "state")->valuestring, "done");
    const cJSON *report = in(r.json, "result");
    print_message("note: %.0f pairs\n", in(in(report, "totals"), "self_intersection")->valuedouble);
    assert_true(in(in(report, "totals"), "self_intersection")->valuedouble > 1000);
    bench_reply_free(&r);
    bench_free(b);
}

/* The request has 15 KB of questions, each of which searches the whole mesh. */
static void many_searches_in_one_request_are_refused_by_the_limit(void **state)
{
    (void)state;
    enum { ASKED = 500 };
    api_bench *b = bench_new();
    fan_put(b, "/v1/meshes/m", 2500, 1);
    fan_text body = fan_text_new(32 * (ASKED + 1));
    fan_add(&body, "{\"queries\":[");
    for (int i = 0; i < ASKED; i++) {
        fan_add(&body, "%s{\"self_intersections\":{}}", i == 0 ? "" : ",");
    }
    fan_add(&body, "]}");
    bench_reply first = bench_expect(200, bench_post(b, QUERY, body.bytes));
    bench_reply second = bench_expect(200, bench_post(b, QUERY, body.bytes));
    int complete = 0, refused = 0;
    const cJSON *result;
    cJSON_ArrayForEach(result, in(first.json, "results"))
    {
        const cJSON *code = cJSON_GetObjectItemCaseSensitive(result, "code");
        if (code == NULL) {
            assert_int_equal(refused, 0);
            complete += cJSON_IsTrue(in(result, "complete"));
            continue;
        }
        assert_string_equal(code->valuestring, "limit_exceeded");
        assert_int_equal(in(result, "status")->valueint, 413);
        assert_non_null(strstr(in(result, "detail")->valuestring, "\"self_intersections\""));
        expect_steps(in(result, "detail")->valuestring, "request");
        refused++;
    }
    assert_true(complete > 100 && refused > 100);
    assert_string_equal(first.body, second.body);
    bench_reply_free(&first);
    bench_reply_free(&second);
    free(body.bytes);
    bench_free(b);
}

static void a_search_that_was_refused_has_used_up_the_steps_of_its_request(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    fan_put(b, "/v1/meshes/m", 2001, 801);
    bench_reply r =
        bench_expect(200, bench_post(b, QUERY,
                                     "{\"queries\":[{\"self_intersections\":{}},"
                                     "{\"self_intersections\":{}},{\"closest\":[0,0,1]}]}"));
    const cJSON *result;
    cJSON_ArrayForEach(result, in(r.json, "results"))
    {
        assert_string_equal(in(result, "code")->valuestring, "limit_exceeded");
    }
    bench_reply_free(&r);
    bench_free(b);
}

/* --- questions about the whole mesh --- */

static bench_reply ask(api_bench *b, const char *target, const char *accept, const char *wait,
                       const char *body)
{
    const char *const headers[] = {
        "Content-Type", "application/json", "Accept", accept, "Prefer", wait, NULL};
    return bench_send(b, "POST", target, headers, body);
}

static void expect_result(api_bench *b, const bench_reply *begun, const bench_reply *wanted)
{
    char link[128];
    snprintf(link, sizeof link, "%s/result", bench_header(begun, "Location"));
    bench_run_jobs(b, 1);
    bench_reply r = bench_expect(200, bench_get(b, link));
    assert_int_equal(r.length, wanted->length);
    assert_memory_equal(r.body, wanted->body, wanted->length);
    bench_done(r);
}

/* A question becomes a job if it takes longer than the client waits. The client waits for 0 s here;
 * with the default wait, only a mesh of a million faces would take that long. */
static void questions_about_all_are_jobs_where_they_take_longer_than_the_client_waits(void **state)
{
    (void)state;
    static const char json[] = "application/json", octets[] = "application/octet-stream";
    static const char walks[] = "/v1/meshes/m/traverse";
    static const struct {
        const char *target, *accept, *body;
    } cases[] = {
        /* the first question builds the tree of bounding boxes */
        {QUERY, json, "{\"queries\":[{\"closest\":[2,0,0]}]}"},
        {QUERY, json, "{\"queries\":[{\"self_intersections\":{}}]}"},
        {QUERY, json, "{\"queries\":[{\"measure\":\"area\",\"of\":{\"faces\":\"all\"}}]}"},
        {QUERY, octets, "{\"queries\":[{\"measure\":\"dihedral\",\"of\":{\"edges\":\"all\"}}]}"},
        {QUERY, octets, "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edges\":\"all\"}}]}"},
        {walks, json, "{\"walk\":\"breadth_first\",\"from\":{\"vertex\":0}}"},
        {walks, json, "{\"walk\":\"rings\",\"from\":{\"vertex\":0},\"depth\":1000}"},
        {walks, json,
         "{\"walk\":\"shortest_path\",\"from\":{\"vertex\":0},\"to\":{\"vertex\":99}}"},
    };
    api_bench *b = bench_new();
    bench_done(bench_expect(
        201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"icosphere\",\"subdivisions\":5}")));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *target = cases[i].target, *accept = cases[i].accept, *body = cases[i].body;
        print_message("%s %s\n", target, body);
        bench_reply begun = bench_expect(202, ask(b, target, accept, "wait=0", body));
        bench_reply wanted = bench_expect(200, ask(b, target, accept, "wait=60", body));
        expect_result(b, &begun, &wanted);
        bench_done(wanted);
        bench_done(begun);
    }
    /* The tree of bounding boxes now exists, and a question about few elements takes no time. */
    bench_done(bench_expect(200, ask(b, QUERY, json, "wait=0", cases[0].body)));
    bench_done(bench_expect(200, ask(b, walks, json, "wait=0",
                                     "{\"walk\":\"rings\",\"from\":{\"vertex\":0},\"depth\":2}")));
    bench_free(b);
}

/* The mesh has 92,162 elements, and each question computes a number for each of its 20,480 faces,
 * which the answer lists. At 76 such questions the estimated time of the request exceeds a second,
 * so it becomes a job. */
static void seconds_of_passes_over_a_mesh_add_up(void **state)
{
    (void)state;
    static const struct {
        int passes, status;
    } cases[] = {{70, 200}, {85, 202}};
    api_bench *b = bench_new();
    bench_done(bench_expect(
        201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"icosphere\",\"subdivisions\":5}")));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static const char pass[] = "{\"measure\":\"area\",\"of\":{\"faces\":\"all\"}}";
        char body[8192] = "{\"queries\":[";
        for (int n = 1; n <= cases[i].passes; n++) {
            size_t used = strlen(body);
            snprintf(body + used, sizeof body - used, "%s%s", pass,
                     n < cases[i].passes ? "," : "]}");
        }
        bench_done(bench_expect(cases[i].status, bench_post(b, QUERY, body)));
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_fan_of_thousands_is_searched_whole),
        cmocka_unit_test(a_check_beyond_its_steps_is_refused_and_names_the_limit_and_a_job),
        cmocka_unit_test(a_check_beyond_its_steps_is_a_job_where_the_client_takes_one),
        cmocka_unit_test(many_searches_in_one_request_are_refused_by_the_limit),
        cmocka_unit_test(a_search_that_was_refused_has_used_up_the_steps_of_its_request),
        cmocka_unit_test(questions_about_all_are_jobs_where_they_take_longer_than_the_client_waits),
        cmocka_unit_test(seconds_of_passes_over_a_mesh_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
