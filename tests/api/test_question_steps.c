/* Searches in space are charged for what they look at: a fan of thousands is searched whole, and a
 * short request that asks for much work is refused by the limit that it meets. */
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
    put_fan(b, "/v1/meshes/m", 10000, 1);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_true(cJSON_IsTrue(in(r.json, "complete")));
    assert_int_equal(in(in(r.json, "totals"), "self_intersection")->valueint, 0);
    bench_reply_free(&r);
    bench_free(b);
}

static void expect_steps(const char *detail, const char *of)
{
    char steps[48];
    snprintf(steps, sizeof steps, " %d steps that a %s may take", (int)API_MAX_STEPS, of);
    if (strstr(detail, steps) == NULL || strstr(detail, "Prefer: respond-async") == NULL) {
        fail_msg("%s", detail);
    }
}

static void a_check_beyond_its_steps_is_refused_and_names_the_limit_and_a_job(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put_fan(b, "/v1/meshes/m", 3001, 1201);
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
    put_fan(b, "/v1/meshes/m", 3001, 1201);
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

/* 15 KB of questions, each of which searches the whole mesh. */
static void many_searches_in_one_request_are_refused_by_the_limit(void **state)
{
    (void)state;
    enum { ASKED = 500 };
    api_bench *b = bench_new();
    put_fan(b, "/v1/meshes/m", 2500, 1);
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
    put_fan(b, "/v1/meshes/m", 3001, 1201);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_fan_of_thousands_is_searched_whole),
        cmocka_unit_test(a_check_beyond_its_steps_is_refused_and_names_the_limit_and_a_job),
        cmocka_unit_test(a_check_beyond_its_steps_is_a_job_where_the_client_takes_one),
        cmocka_unit_test(many_searches_in_one_request_are_refused_by_the_limit),
        cmocka_unit_test(a_search_that_was_refused_has_used_up_the_steps_of_its_request),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
