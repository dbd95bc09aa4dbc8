/* Limits for each client: requests per second and bytes per second of a token or an address;
 * connections; jobs. The test sets the time of the clock. */
#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The SHA-256 hashes of the tokens "test" and "prueba". */
#define TEST   "sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"
#define PRUEBA "sha256:655e786674d9d3e77bc05ed1de37b4b6bc89f788829f9f3c679e7687b410c89b"
#define ALICE  "alice admin " TEST
#define BOB    "bob admin " PRUEBA

static uint64_t clock_now = 5000000;

uint64_t __wrap_st_clock_micros(void);
uint64_t __wrap_st_clock_micros(void)
{
    return clock_now;
}

static void pass_seconds(uint64_t seconds)
{
    clock_now += seconds * 1000000;
}

static api_bench *bench_of(const char *file, uint64_t requests, uint64_t bytes)
{
    const api_limits addresses = {
        .most = {[API_LIMIT_REQUESTS] = requests, [API_LIMIT_BYTES] = bytes}};
    return bench_new_limited(file, &addresses, 2);
}

static void expect(api_bench *b, int status, const char *target)
{
    bench_done(bench_expect(status, bench_get(b, target)));
}

static void expect_code(bench_reply r, int status, const char *code, const char *detail)
{
    r = bench_expect(status, r);
    assert_non_null(r.json);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    const char *said = cJSON_GetObjectItem(r.json, "detail")->valuestring;
    if (strstr(said, detail) == NULL) {
        fail_msg("\"%s\" does not say \"%s\"", said, detail);
    }
    bench_done(r);
}

static void an_address_has_its_requests_and_then_waits(void **state)
{
    (void)state;
    api_bench *b = bench_of(NULL, 2, 0);
    for (int i = 0; i < 4; i++) {
        bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes"));
        char left[40];
        snprintf(left, sizeof left, "\"requests\";r=%d;t=%d", 3 - i, (i + 2) / 2);
        assert_string_equal(bench_header(&r, "RateLimit"), left);
        assert_string_equal(bench_header(&r, "RateLimit-Policy"), "\"requests\";q=4;w=2");
        bench_done(r);
    }
    bench_reply r = bench_expect(429, bench_get(b, "/v1/meshes"));
    assert_string_equal(bench_header(&r, "Retry-After"), "1");
    assert_string_equal(bench_header(&r, "RateLimit"), "\"requests\";r=0;t=2");
    assert_string_equal(bench_header(&r, "Content-Type"), "application/problem+json");
    expect_code(r, 429, "rate_limit", "the address is limited to 2 requests a second");
    /* The limit applies to every request, even to an unknown path or method, except to requests for
     * monitoring such as /livez. */
    expect(b, 429, "/nowhere");
    expect(b, 429, "/v1/openapi.json");
    expect_code(bench_send(b, "BREW", "/v1/meshes", NULL, NULL), 429, "rate_limit", "2 requests");
    expect(b, 200, "/livez");
    r = bench_expect(200, bench_get(b, "/readyz"));
    assert_string_equal(bench_header(&r, "RateLimit"), "");
    bench_done(r);
    bench_use_address(b, 7, false);
    expect(b, 200, "/v1/meshes");
    bench_use_address(b, 0, false);
    expect(b, 429, "/v1/meshes");
    pass_seconds(1);
    expect(b, 200, "/v1/meshes");
    expect(b, 200, "/v1/meshes");
    expect(b, 429, "/v1/meshes");
    const api_limited *limited = api_service_limited(bench_service(b));
    assert_int_equal(api_limited_get(limited, API_CLIENT_ADDRESS, API_LIMIT_REQUESTS), 6);
    assert_int_equal(api_limited_get(limited, API_CLIENT_TOKEN, API_LIMIT_REQUESTS), 0);
    bench_free(b);
}

static void a_body_is_not_read_of_a_request_that_is_not_let_in(void **state)
{
    (void)state;
    api_bench *b = bench_of(NULL, 1, 0);
    api_step step;
    const api_request request = {.method = "PUT",
                                 .path = "/v1/meshes/m",
                                 .query = "",
                                 .request_id = "r",
                                 .has_length = true,
                                 .length = 1 << 20,
                                 .has_body = true,
                                 .headers = {[API_HEADER_CONTENT_TYPE] = "application/json"}};
    expect(b, 200, "/v1/meshes");
    expect(b, 200, "/v1/meshes");
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    assert_int_equal(step, API_READY);
    assert_int_equal(api_answer_of(x)->status, 429);
    assert_true(api_answer_of(x)->close); /* the connection closes because the body was not read */
    assert_int_equal(api_answer_of(x)->shown.position, 0);
    api_free(x);
    bench_free(b);
}

static void bytes_are_counted_both_ways_and_a_debt_is_waited_for(void **state)
{
    (void)state;
    api_bench *b = bench_of(NULL, 0, 100);
    static const char cube[] = "{\"shape\":\"cube\"}";
    bench_reply r = bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, cube));
    assert_string_equal(bench_header(&r, "RateLimit-Policy"),
                        "\"bytes\";q=200;w=2;qu=\"content-bytes\"");
    assert_string_equal(bench_header(&r, "RateLimit"), "\"bytes\";r=200;t=0");
    const uint64_t taken = sizeof cube - 1 + r.length;
    bench_done(r);
    assert_true(taken > 200); /* the answer took more bytes than the rate limit's bucket held */
    const uint64_t wait = (taken - 200) / 100 + 1;
    r = bench_expect(429, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(strtoull(bench_header(&r, "Retry-After"), NULL, 10), wait);
    assert_true(strncmp(bench_header(&r, "RateLimit"), "\"bytes\";r=0;t=", 14) == 0);
    expect_code(r, 429, "rate_limit", "the address is limited to 100 bytes a second");
    for (int i = 0; i < 50; i++) {
        /* a refused request takes nothing from the rate limit's bucket */
        expect(b, 429, "/v1/meshes/m");
    }
    pass_seconds(wait);
    bench_done(
        bench_expect(304, bench_send(b, "GET", "/v1/meshes/m",
                                     (const char *const[]){"If-None-Match", "*", NULL}, NULL)));
    bench_free(b);
}

static void a_body_is_charged_as_it_comes_and_a_stream_as_it_is_sent(void **state)
{
    (void)state;
    api_bench *b = bench_of(NULL, 0, 100);
    static const char part[] = "                                                  "; /* 50 bytes */
    api_step step;
    size_t used;
    const api_request request = {.method = "PUT",
                                 .path = "/v1/meshes/m",
                                 .query = "",
                                 .request_id = "r",
                                 .has_body = true,
                                 .headers = {[API_HEADER_CONTENT_TYPE] = "application/json"}};
    expect(b, 200, "/livez");
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_int_equal(step, API_MORE);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(api_body(x, part, 50, &used), API_MORE);
    }
    bench_done(bench_expect(204, bench_send(b, "OPTIONS", "/v1/meshes", NULL, NULL)));
    assert_int_equal(api_body(x, part, 50, &used), API_MORE);
    expect(b, 429, "/v1/meshes/none");
    pass_seconds(10);
    bench_done(bench_expect(404, bench_send(b, "HEAD", "/v1/meshes/none", NULL, NULL)));
    pass_seconds(10);
    api_charge(x,
               200); /* api_charge() counts the 200 bytes of an answer against the client's limit */
    expect(b, 429, "/v1/meshes");
    api_free(x);
    pass_seconds(10);
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    pass_seconds(10);
    int streams = 0, status = 200;
    for (; status == 200 && streams < 20; streams++) {
        bench_reply r = bench_get(b, "/v1/meshes/m/events");
        status = r.status;
        bench_done(r);
    }
    assert_int_equal(status, 429); /* the first and last messages of a stream are counted, too */
    assert_true(streams > 1);
    bench_free(b);
}

static void a_token_has_a_bucket_of_its_own_wherever_it_comes_from(void **state)
{
    (void)state;
    api_bench *b = bench_of(ALICE " requests=1\n" BOB " requests=2\n", 3, 0);
    bench_use_token(b, "test");
    expect(b, 200, "/v1/meshes");
    bench_use_address(b, 5, false);
    expect(b, 200, "/v1/meshes");
    expect_code(bench_get(b, "/v1/meshes"), 429, "rate_limit",
                "the token is limited to 1 requests a second");
    /* a request to a route that needs no token counts for the address of the client */
    expect(b, 200, "/v1/openapi.json");
    bench_use_token(b, "prueba");
    for (int i = 0; i < 4; i++) {
        expect(b, 200, "/v1/meshes");
    }
    expect(b, 429, "/v1/meshes");
    /* A request without a token, or with an unknown one, is counted for the address of the
     * client. */
    bench_use_address(b, 6, false);
    bench_use_token(b, NULL);
    for (int i = 0; i < 6; i++) {
        bench_use_token(b, i % 2 == 0 ? "wrong" : NULL);
        expect(b, 401, "/v1/meshes");
    }
    expect(b, 429, "/v1/meshes");
    bench_use_token(b, "wrong");
    expect(b, 429, "/v1/meshes");
    bench_use_token(b, "prueba");
    pass_seconds(1);
    expect(b, 200, "/v1/meshes");
    bench_free(b);
}

static void a_reload_limits_at_once_and_forgets_no_debt(void **state)
{
    (void)state;
    api_bench *b = bench_of(ALICE " requests=2\n" BOB "\n", 0, 0);
    bench_use_token(b, "test");
    for (int i = 0; i < 4; i++) {
        expect(b, 200, "/v1/meshes");
    }
    expect(b, 429, "/v1/meshes");
    bench_use_token(b, "prueba");
    expect(b, 200, "/v1/meshes");
    bench_change_tokens(b, ALICE " requests=3\n" BOB " requests=1\n");
    bench_done(bench_expect(200, bench_post(b, "/v1/admin/reload", NULL)));
    expect(b, 200, "/v1/meshes");
    /* the request to reload was counted before the new limit began to apply */
    expect(b, 200, "/v1/meshes");
    expect(b, 429, "/v1/meshes");
    bench_use_token(b, "test");
    expect(b, 200, "/v1/meshes");
    expect(b, 200, "/v1/meshes");
    expect(b, 429, "/v1/meshes");
    bench_free(b);
}

static void a_connection_beyond_its_address_s_is_told_so(void **state)
{
    (void)state;
    const api_limits addresses = {.most = {[API_LIMIT_CONNECTIONS] = 3}};
    api_bench *b = bench_new_limited(ALICE, &addresses, 1);
    bench_use_token(b, "test");
    bench_use_address(b, 1, true);
    bench_reply r = bench_expect(429, bench_get(b, "/v1/meshes"));
    assert_string_equal(bench_header(&r, "Retry-After"), "1");
    expect_code(r, 429, "too_many_connections", "is limited to 3 open connections");
    expect(b, 200, "/livez");
    bench_use_address(b, 1, false);
    expect(b, 200, "/v1/meshes");
    const api_limited *limited = api_service_limited(bench_service(b));
    assert_int_equal(api_limited_get(limited, API_CLIENT_ADDRESS, API_LIMIT_CONNECTIONS), 1);
    bench_free(b);
}

static void a_token_s_jobs_are_counted_while_they_wait_or_run(void **state)
{
    (void)state;
    static const char *const async[] = {"Prefer", "respond-async", NULL};
    api_bench *b = bench_of(ALICE " jobs=2\n" BOB "\n", 0, 0);
    bench_use_token(b, "test");
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    const char *const check = "/v1/meshes/m/vertices";
    bench_done(bench_expect(202, bench_send(b, "GET", check, async, NULL)));
    bench_done(bench_expect(202, bench_send(b, "GET", check, async, NULL)));
    bench_reply r = bench_expect(429, bench_send(b, "GET", check, async, NULL));
    assert_string_equal(bench_header(&r, "Retry-After"), "1");
    expect_code(r, 429, "too_many_jobs_of_token",
                "the token may have at most 2 jobs that wait or run");
    /* the limit applies only to requests that become jobs */
    bench_done(bench_expect(200, bench_get(b, check)));
    bench_use_token(b, "prueba");
    bench_done(bench_expect(202, bench_send(b, "GET", check, async, NULL)));
    bench_run_jobs(b, 1);
    bench_use_token(b, "test");
    bench_done(bench_expect(202, bench_send(b, "GET", check, async, NULL)));
    bench_done(bench_expect(429, bench_send(b, "GET", check, async, NULL)));
    const api_limited *limited = api_service_limited(bench_service(b));
    assert_int_equal(api_limited_get(limited, API_CLIENT_TOKEN, API_LIMIT_JOBS), 2);
    bench_run_jobs(b, BENCH_JOBS);
    bench_free(b);
}

static void a_mesh_counts_for_the_token_that_made_it(void **state)
{
    (void)state;
    static const char cube[] = "{\"shape\":\"cube\"}";
    static const char grid[] = "{\"shape\":\"grid\",\"columns\":40,\"rows\":40}";
    api_bench *b = bench_of(ALICE " meshes=2 mesh-bytes=20000\n" BOB "\n", 0, 0);
    bench_use_token(b, "test");
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, cube)));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes", cube)));
    expect_code(bench_post(b, "/v1/meshes", cube), 507, "quota",
                "this token may have 2 meshes, and has 2 already");
    expect_code(bench_post(b, "/v1/meshes/m/copy", NULL), 507, "quota", "2 meshes");
    expect_code(bench_send(b, "PUT", "/v1/meshes/m", NULL, grid), 507, "quota",
                "the meshes of this token may take 20000 bytes");
    /* The quota of the token that created a mesh also limits what other tokens write to it; the
     * message must not say how large that token's quota is. */
    bench_use_token(b, "prueba");
    expect_code(bench_send(b, "PUT", "/v1/meshes/m", NULL, grid), 507, "quota",
                "the token that created this mesh");
    expect_code(bench_post(b, "/v1/meshes/m/edits",
                           "{\"ops\":[{\"op\":\"subdivide\",\"scheme\":\"linear\"},"
                           "{\"op\":\"subdivide\",\"scheme\":\"linear\"},"
                           "{\"op\":\"subdivide\",\"scheme\":\"linear\"}]}"),
                507, "quota", "the token that created this mesh");
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_done(r);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes", grid)));
    bench_change_tokens(b, ALICE " meshes=3\n" BOB "\n");
    bench_done(bench_expect(200, bench_post(b, "/v1/admin/reload", NULL)));
    bench_use_token(b, "test");
    bench_done(bench_expect(200, bench_send(b, "PUT", "/v1/meshes/m", NULL, grid)));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes", cube)));
    bench_done(bench_expect(507, bench_post(b, "/v1/meshes", cube)));
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes", cube)));
    const api_limited *limited = api_service_limited(bench_service(b));
    assert_int_equal(api_limited_get(limited, API_CLIENT_TOKEN, API_LIMIT_MESHES), 3);
    assert_int_equal(api_limited_get(limited, API_CLIENT_TOKEN, API_LIMIT_MESH_BYTES), 3);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_address_has_its_requests_and_then_waits),
        cmocka_unit_test(a_body_is_not_read_of_a_request_that_is_not_let_in),
        cmocka_unit_test(bytes_are_counted_both_ways_and_a_debt_is_waited_for),
        cmocka_unit_test(a_body_is_charged_as_it_comes_and_a_stream_as_it_is_sent),
        cmocka_unit_test(a_token_has_a_bucket_of_its_own_wherever_it_comes_from),
        cmocka_unit_test(a_reload_limits_at_once_and_forgets_no_debt),
        cmocka_unit_test(a_connection_beyond_its_address_s_is_told_so),
        cmocka_unit_test(a_token_s_jobs_are_counted_while_they_wait_or_run),
        cmocka_unit_test(a_mesh_counts_for_the_token_that_made_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
