/* Reading, copying and listing earlier revisions of a mesh. */
#include "tests/api/history.h"
#include "tests/failing.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* --- reading earlier revisions --- */

static void elements_are_those_of_the_revision(void **state)
{
    (void)state;
    static const struct {
        const char *target;
        int status;
    } rows[] = {
        {"/v1/meshes/m/vertices/8", 200},
        {"/v1/meshes/m/vertices/8?revision=1", 404}, /* revision 2 creates this vertex */
        {"/v1/meshes/m/vertices/8?revision=2", 200},
        {"/v1/meshes/m/faces/1?revision=2", 200},
        {"/v1/meshes/m/faces/1?revision=3", 410},
        {"/v1/meshes/m/faces/1?revision=4", 200},
        {"/v1/meshes/m/faces/1/edges?revision=3", 410},
        {"/v1/meshes/m/vertices/8/faces?revision=3&cw=true", 200},
        {"/v1/meshes/m/vertices?revision=3&limit=2", 200},
        {"/v1/meshes/m/boundaries?revision=3", 200},
        {"/v1/meshes/m/components?revision=3&by=edge", 200},
        {"/v1/meshes/m/check?revision=3", 200},
        {"/v1/meshes/m/content?revision=3&format=ply", 200},
        {"/v1/meshes/m?revision=5", 404},
        {"/v1/meshes/m?revision=0", 400},
        {"/v1/meshes/m?revision=x", 400},
        {"/v1/meshes/m/edits?revision=2", 400},
    };
    api_bench *b = history_begin();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bench_done(bench_expect(rows[i].status, bench_get(b, rows[i].target)));
    }
    bench_reply r = bench_expect(404, bench_get(b, "/v1/meshes/m?revision=5"));
    assert_string_equal(history_code(&r), "no_such_revision");
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m?revision=3"));
    const cJSON *counts = cJSON_GetObjectItem(r.json, "counts");
    assert_int_equal(history_number(r.json, "revision"), 3);
    assert_int_equal(history_number(counts, "faces"), 8);
    assert_int_equal(history_number(counts, "boundary_loops"), 1);
    bench_done(r);
    /* The counts of elements at revision 3 must not be cached as those of the present state. */
    r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(history_number(cJSON_GetObjectItem(r.json, "counts"), "faces"), 9);
    bench_done(r);
    bench_free(b);
}

static void a_tag_names_the_revision_that_was_read(void **state)
{
    (void)state;
    static const char *const targets[] = {"?revision=2", "/vertices/8?revision=2",
                                          "/faces?limit=2&revision=2", "/content?revision=2",
                                          "/boundaries?revision=2"};
    api_bench *b = history_begin();
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        char target[TARGET], etag[100];
        snprintf(target, sizeof target, "/v1/meshes/m%s", targets[i]);
        bench_reply r = bench_expect(200, bench_get(b, target));
        snprintf(etag, sizeof etag, "%s", bench_header(&r, "ETag"));
        assert_non_null(strstr(etag, "-2-"));
        bench_done(r);
        const char *const known[] = {"If-None-Match", etag, NULL};
        bench_done(bench_expect(304, bench_send(b, "GET", target, known, NULL)));
        /* The entity tag of revision 2 must not match a GET that names no revision, because such a
         * GET reads the present state. */
        *strstr(target, "revision=2") = '\0';
        target[strlen(target) - 1] = '\0';
        bench_done(bench_expect(200, bench_send(b, "GET", target, known, NULL)));
    }
    bench_free(b);
}

/* A state that can no longer be reached by undo or redo can still be copied to a new mesh. */
static void an_earlier_revision_can_be_copied(void **state)
{
    (void)state;
    api_bench *b = history_begin();
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":2}")));
    bench_reply r = bench_expect(201, history_post(b, "copy?revision=3", "{\"id\":\"c\"}"));
    assert_int_equal(history_number(cJSON_GetObjectItem(r.json, "counts"), "faces"), 8);
    assert_int_equal(history_number(r.json, "revision"), 1);
    bench_done(r);
    bench_reply then = bench_expect(200, bench_get(b, "/v1/meshes/m/faces?revision=3"));
    r = bench_expect(200, bench_get(b, "/v1/meshes/c/faces"));
    assert_true(cJSON_Compare(cJSON_GetObjectItem(r.json, "items"),
                              cJSON_GetObjectItem(then.json, "items"), true));
    bench_done(then);
    bench_done(r);
    bench_free(b);
}

/* --- the list of revisions --- */

static void the_history_tells_what_each_revision_did(void **state)
{
    (void)state;
    api_bench *b = history_begin();
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    const cJSON *entry = cJSON_GetObjectItem(r.json, "entries")->child;
    static const struct {
        const char *action, *op;
        int created, deleted, inverts;
    } rows[] = {{"undo", "face_delete", 1, 0, 3},
                {"edit", "face_delete", 0, 1, 0},
                {"edit", "face_poke", 3, 0, 0}};
    for (size_t i = 0; i < 3; i++, entry = entry->next) {
        assert_string_equal(cJSON_GetObjectItem(entry, "action")->valuestring, rows[i].action);
        assert_string_equal(cJSON_GetObjectItem(entry, "ops")->child->valuestring, rows[i].op);
        assert_int_equal(history_number(cJSON_GetObjectItem(entry, "created"), "faces"),
                         rows[i].created);
        assert_int_equal(history_number(cJSON_GetObjectItem(entry, "deleted"), "faces"),
                         rows[i].deleted);
        assert_int_equal(cJSON_HasObjectItem(entry, "inverts"), rows[i].inverts != 0);
        if (rows[i].inverts != 0) {
            assert_int_equal(history_number(entry, "inverts"), rows[i].inverts);
        }
        assert_int_equal(cJSON_IsTrue(cJSON_GetObjectItem(entry, "undoable")), i == 2);
    }
    assert_null(entry);
    bench_done(r);
    bench_free(b);
}

static bench_reply name_revision(api_bench *b, unsigned revision, const char *body)
{
    static const char *const patch[] = {"Content-Type", "application/merge-patch+json", NULL};
    char target[60];
    snprintf(target, sizeof target, "/v1/meshes/m/edits/%u", revision);
    return bench_send(b, "PATCH", target, patch, body);
}

static void names_of_revisions_are_text_that_can_be_seen(void **state)
{
    (void)state;
    static const struct {
        const char *name, *code;
    } wrong[] = {{"\\u0007", "U+0007"},   {"a\\u001b[2J", "U+001B"}, {"\x7f", "U+007F"},
                 {"a\xc2\x85", "U+0085"}, {"\\u202egpj", "U+202E"},  {"\\u202A", "U+202A"},
                 {"x\\u2066y", "U+2066"}, {"\\u2069", "U+2069"}};
    api_bench *b = history_begin();
    char body[100];
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(body, sizeof body, "{\"name\":\"%s\"}", wrong[i].name);
        bench_reply r = bench_expect(400, name_revision(b, 2, body));
        assert_non_null(strstr(r.body, "/name"));
        assert_non_null(strstr(r.body, wrong[i].code));
        bench_done(r);
    }
    bench_done(bench_expect(
        200, name_revision(b, 2,
                           "{\"name\":\"d\xc3\xa9j\xc3\xa0 \xe2\x80\x94 \xc2\xa0\xe2\x81\x84\"}")));
    bench_reply r = bench_expect(410, name_revision(b, 1, "{\"name\":\"x\"}"));
    assert_non_null(strstr(r.body, "revision 1 cannot have a name: it is the first revision, or "));
    bench_done(r);
    bench_free(b);
}

static void a_page_of_the_history_goes_on_where_it_was(void **state)
{
    (void)state;
    api_bench *b = history_begin();
    char target[400];
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits?limit=2&since=1"));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "entries")), 2);
    snprintf(target, sizeof target, "/v1/meshes/m/edits?limit=2&cursor=%s",
             cJSON_GetObjectItem(r.json, "next")->valuestring);
    bench_done(r);
    bench_done(bench_expect(200, history_post(b, "edits", "{\"op\":\"face_poke\",\"face\":2}")));
    r = bench_expect(200, bench_get(b, target));
    const cJSON *entries = cJSON_GetObjectItem(r.json, "entries");
    assert_int_equal(cJSON_GetArraySize(entries), 1);
    assert_int_equal(history_number(entries->child, "revision"), 2);
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(r.json, "next")));
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits?since=4"));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "entries")), 1);
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits?since=99"));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(r.json, "entries")), 0);
    bench_done(r);
    bench_free(b);
}

/* --- memory --- */

static void every_allocation_of_a_reader_may_fail(void **state)
{
    (void)state;
    static const char *const targets[] = {
        "/v1/meshes/m?revision=2",       "/v1/meshes/m/faces/2?revision=3",
        "/v1/meshes/m/faces?revision=2", "/v1/meshes/m/boundaries?revision=3",
        "/v1/meshes/m/edits?since=2",    "/v1/meshes/m/content?revision=1&format=off"};
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        failing f = {.what = targets[i]};
        while (failing_next(&f)) {
            failing_pause();
            api_bench *b = history_begin();
            failing_resume();
            bench_reply r;
            bool answered = bench_try(b, &(bench_request){"GET", targets[i], NULL, NULL, 0}, &r);
            failing_end(&f, answered && r.status == 200);
            if (answered) {
                assert_true(r.status == 200 || r.status == 507 || r.status == 503);
                bench_reply_free(&r);
            }
            bench_done(bench_expect(200, bench_get(b, targets[i])));
            bench_free(b);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elements_are_those_of_the_revision),
        cmocka_unit_test(a_tag_names_the_revision_that_was_read),
        cmocka_unit_test(an_earlier_revision_can_be_copied),
        cmocka_unit_test(the_history_tells_what_each_revision_did),
        cmocka_unit_test(names_of_revisions_are_text_that_can_be_seen),
        cmocka_unit_test(a_page_of_the_history_goes_on_where_it_was),
        cmocka_unit_test(every_allocation_of_a_reader_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
