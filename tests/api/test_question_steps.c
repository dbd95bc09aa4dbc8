/* Searches in space are charged for what they look at: a fan of thousands is searched whole, and a
 * short request that asks for much work is refused by the limit that it meets. */
#include "tests/api/request.h"

#include "api/limits.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define QUERY "/v1/meshes/m/query"

typedef struct text {
    char *bytes;
    size_t length, room;
} text;

static text text_new(size_t room)
{
    text t = {malloc(room), 0, room};
    assert_non_null(t.bytes);
    return t;
}

static void add(text *t, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    t->length += (size_t)vsnprintf(t->bytes + t->length, t->room - t->length, format, list);
    va_end(list);
    assert_true(t->length < t->room);
}

/* A vertex with triangles to `spokes` places around it; every stride-th is the next corner. */
static void put_fan(api_bench *b, int spokes, int stride)
{
    text t = text_new(128 * (size_t)spokes);
    add(&t, "{\"vertices\":[[0,0,0]");
    for (int i = 0; i < spokes; i++) {
        double turn = 2 * 3.141592653589793 * fmod((double)i * stride, spokes) / spokes;
        add(&t, ",[%.17g,%.17g,%.17g]", cos(turn), sin(turn), cos(turn) / 3);
    }
    add(&t, "],\"faces\":[");
    for (int i = 0; i < spokes; i++) {
        add(&t, "%s[0,%d,%d]", i == 0 ? "" : ",", i + 1, (i + 1) % spokes + 1);
    }
    add(&t, "]}");
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, t.bytes);
    assert_true(r.status == 201 || r.status == 200);
    bench_reply_free(&r);
    free(t.bytes);
}

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
    put_fan(b, 10000, 1);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_true(cJSON_IsTrue(in(r.json, "complete")));
    assert_int_equal(in(in(r.json, "totals"), "self_intersection")->valueint, 0);
    bench_reply_free(&r);
    bench_free(b);
}

/* What a search would look at beyond the budget it does not, and says so. */
static void a_search_that_is_cut_short_is_not_complete(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put_fan(b, 3001, 1201);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_true(cJSON_IsFalse(in(r.json, "complete")));
    assert_true(in(in(r.json, "totals"), "self_intersection")->valuedouble > 1000);
    bench_reply_free(&r);
    bench_free(b);
}

/* 15 KB of questions, each of which searches the whole mesh. */
static void many_searches_in_one_request_are_refused_by_the_limit(void **state)
{
    (void)state;
    enum { ASKED = 500 };
    api_bench *b = bench_new();
    put_fan(b, 2500, 1);
    text body = text_new(32 * (ASKED + 1));
    add(&body, "{\"queries\":[");
    for (int i = 0; i < ASKED; i++) {
        add(&body, "%s{\"self_intersections\":{}}", i == 0 ? "" : ",");
    }
    add(&body, "]}");
    bench_reply first = bench_expect(200, bench_post(b, QUERY, body.bytes));
    bench_reply second = bench_expect(200, bench_post(b, QUERY, body.bytes));
    int complete = 0, refused = 0;
    char steps[32];
    snprintf(steps, sizeof steps, " %d steps", (int)API_MAX_STEPS);
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
        assert_non_null(strstr(in(result, "detail")->valuestring, steps));
        refused++;
    }
    assert_true(complete > 100 && refused > 100);
    assert_string_equal(first.body, second.body);
    bench_reply_free(&first);
    bench_reply_free(&second);
    free(body.bytes);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_fan_of_thousands_is_searched_whole),
        cmocka_unit_test(a_search_that_is_cut_short_is_not_complete),
        cmocka_unit_test(many_searches_in_one_request_are_refused_by_the_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
