/* GET .../check reports the defects of a mesh, uses the thresholds in the request, and can run as a
 * job. */
#include "tests/api/request.h"

#include "base/mem.h"
#include "tests/failing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void put(api_bench *b, const char *document)
{
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, document);
    if (r.status != 201 && r.status != 200) {
        fail_msg("%d: %s", r.status, r.body);
    }
    bench_reply_free(&r);
}

static bench_reply check(api_bench *b, const char *query)
{
    char target[256];
    snprintf(target, sizeof target, "/v1/meshes/m/check%s", query);
    bench_reply r = bench_send(b, "GET", target, NULL, NULL);
    if (r.status != 200) {
        fail_msg("%s: %d: %s", query, r.status, r.body);
    }
    return r;
}

static int total(const bench_reply *r, const char *code)
{
    const cJSON *count = cJSON_GetObjectItem(cJSON_GetObjectItem(r->json, "totals"), code);
    return count == NULL ? -1 : count->valueint;
}

static double threshold(const bench_reply *r, const char *name)
{
    return cJSON_GetObjectItem(cJSON_GetObjectItem(r->json, "thresholds"), name)->valuedouble;
}

/* Returns the first defect in the answer whose code is `code`. */
static const cJSON *first(const bench_reply *r, const char *code)
{
    const cJSON *defect;
    cJSON_ArrayForEach(defect, cJSON_GetObjectItem(r->json, "defects"))
    {
        if (strcmp(cJSON_GetObjectItem(defect, "code")->valuestring, code) == 0) {
            return defect;
        }
    }
    fail_msg("no %s: %s", code, r->body);
    return NULL;
}

static void expect_first(const bench_reply *r, const char *code, const char *kind, int id,
                         int other)
{
    const cJSON *defect = first(r, code), *named = cJSON_GetObjectItem(defect, "other");
    assert_string_equal(cJSON_GetObjectItem(defect, "kind")->valuestring, kind);
    assert_int_equal(cJSON_GetObjectItem(defect, "id")->valueint, id);
    assert_int_equal(named == NULL ? -1 : named->valueint, other);
    assert_true(strlen(cJSON_GetObjectItem(defect, "detail")->valuestring) > 0);
}

/* The mesh has two intersecting triangles, a twisted quadrilateral, and two vertices at one
 * position. */
static const char mess[] =
    "{\"vertices\":[[0,0,0],[2,0,0],[0,2,0],[0.5,0.5,-1],[0.5,0.5,1],[3,3,0],[9,0,0],[10,0,1],"
    "[10,1,0],[9,1,1],[2,0,0]],\"faces\":[[0,1,2],[3,4,5],[6,7,8,9]]}";

static void each_defect_is_counted_and_named(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, mess);
    bench_reply r = check(b, "?self_intersections=true");
    assert_int_equal(total(&r, "problems"), 0);
    assert_int_equal(total(&r, "isolated_vertex"), 1);
    expect_first(&r, "isolated_vertex", "vertex", 10, -1);
    assert_int_equal(total(&r, "duplicate_position"), 1);
    expect_first(&r, "duplicate_position", "vertex", 10, 1);
    assert_int_equal(total(&r, "nonplanar_face"), 1);
    expect_first(&r, "nonplanar_face", "face", 2, -1);
    assert_true(fabs(cJSON_GetObjectItem(first(&r, "nonplanar_face"), "value")->valuedouble - 0.5) <
                0.3);
    assert_int_equal(total(&r, "self_intersection"), 1);
    expect_first(&r, "self_intersection", "face", 0, 1);
    assert_int_equal(total(&r, "small_component"), 0);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(r.json, "complete")));
    bench_reply_free(&r);
    bench_free(b);
}

static void self_intersections_are_looked_for_on_request(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, mess);
    bench_reply r = check(b, "");
    assert_int_equal(total(&r, "self_intersection"), -1);
    bench_reply_free(&r);
    r = check(b, "?self_intersections=false");
    assert_int_equal(total(&r, "self_intersection"), -1);
    bench_reply_free(&r);
    bench_free(b);
}

static void thresholds_are_of_the_box_or_given(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"cube\",\"size\":10}");
    bench_reply r = check(b, "");
    double diagonal = 10 * sqrt(3);
    assert_true(fabs(threshold(&r, "merge") / diagonal - 1e-9) < 1e-21);
    assert_true(fabs(threshold(&r, "flat") / diagonal - 1e-4) < 1e-16);
    assert_true(fabs(threshold(&r, "small") / diagonal - 1e-2) < 1e-14);
    assert_int_equal(total(&r, "small_component"), 0);
    bench_reply_free(&r);
    r = check(b, "?merge=10&flat=0.5&small=2e1");
    assert_true(threshold(&r, "merge") == 10 && threshold(&r, "flat") == 0.5 &&
                threshold(&r, "small") == 20);
    assert_int_equal(total(&r, "zero_length_edge"), 12);
    /* 4 of the 8 vertices of the cube count as duplicates: they are within the merge distance of
     * an earlier vertex that is no duplicate itself */
    assert_int_equal(total(&r, "duplicate_position"), 4);
    assert_int_equal(total(&r, "small_component"), 1);
    bench_reply_free(&r);
    static const char *const bad[] = {
        "?merge=-1",  "?flat=x",      "?small=1e999", "?merge=",  "?flat=nan",
        "?small=1,5", "?merge=0x1p3", "?merge=+1",    "?tight=1", "?merge=1&merge=1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char target[64];
        snprintf(target, sizeof target, "/v1/meshes/m/check%s", bad[i]);
        r = bench_send(b, "GET", target, NULL, NULL);
        assert_int_equal(r.status, 400);
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void an_earlier_revision_is_checked_as_it_was(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, mess);
    bench_reply r =
        bench_send(b, "POST", "/v1/meshes/m/edits", NULL, "{\"op\":\"face_delete\",\"face\":1}");
    assert_int_equal(r.status, 200);
    bench_reply_free(&r);
    r = check(b, "?self_intersections=true");
    assert_int_equal(total(&r, "self_intersection"), 0);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 2);
    bench_reply_free(&r);
    r = check(b, "?self_intersections=true&revision=1");
    assert_int_equal(total(&r, "self_intersection"), 1);
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_reply_free(&r);
    bench_free(b);
}

static void the_first_hundred_of_each_are_listed(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"grid\",\"columns\":15,\"rows\":15}");
    bench_reply r = check(b, "?merge=100");
    int listed[2] = {0, 0};
    const cJSON *defect;
    cJSON_ArrayForEach(defect, cJSON_GetObjectItem(r.json, "defects"))
    {
        const char *code = cJSON_GetObjectItem(defect, "code")->valuestring;
        listed[0] += strcmp(code, "duplicate_position") == 0;
        listed[1] += strcmp(code, "degenerate_face") == 0;
    }
    assert_int_equal(listed[0], 100);
    assert_int_equal(listed[1], 100);
    assert_int_equal(total(&r, "duplicate_position"), 255);
    assert_int_equal(total(&r, "degenerate_face"), 225);
    bench_reply_free(&r);
    bench_free(b);
}

static void a_check_can_be_a_job(void **state)
{
    (void)state;
    static const char *const async[] = {"Prefer", "respond-async", NULL};
    api_bench *b = bench_new();
    put(b, mess);
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/check?self_intersections=true", async, NULL);
    assert_int_equal(r.status, 202);
    char target[128];
    snprintf(target, sizeof target, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
    bench_run_jobs(b, 1);
    r = bench_send(b, "GET", target, NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_string_equal(cJSON_GetObjectItem(r.json, "state")->valuestring, "done");
    assert_true(cJSON_GetObjectItem(r.json, "progress")->valuedouble == 1);
    const cJSON *result = cJSON_GetObjectItem(r.json, "result");
    assert_non_null(result);
    assert_int_equal(
        cJSON_GetObjectItem(cJSON_GetObjectItem(result, "totals"), "self_intersection")->valueint,
        1);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- memory --- */

static void a_starved_check_says_so(void **state)
{
    (void)state;
    const char *target = "/v1/meshes/m/check?self_intersections=true";
    api_bench *b = bench_new();
    put(b, mess);
    /* If the failed allocation was for something optional, the request succeeds: the answer must be
     * complete. */
    failing f = {.may_succeed = true};
    while (failing_next(&f)) {
        bench_reply r;
        bool any = bench_try(b, &(bench_request){"GET", target, NULL, NULL, 0}, &r);
        failing_end(&f, any && r.status == 200);
        if (any) {
            assert_true(r.status == 200 || r.status == 507);
            bench_reply_free(&r);
        }
        /* A result that was cut short by the failed allocation must not be cached: the next answer
         * is complete. */
        bench_reply again = check(b, "?self_intersections=true");
        assert_int_equal(total(&again, "self_intersection"), 1);
        bench_reply_free(&again);
        put(b, mess);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_defect_is_counted_and_named),
        cmocka_unit_test(self_intersections_are_looked_for_on_request),
        cmocka_unit_test(thresholds_are_of_the_box_or_given),
        cmocka_unit_test(an_earlier_revision_is_checked_as_it_was),
        cmocka_unit_test(the_first_hundred_of_each_are_listed),
        cmocka_unit_test(a_check_can_be_a_job),
        cmocka_unit_test(a_starved_check_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
