/* Names that people see: which ones are refused, and that a stored mesh keeps a name that would be
 * refused now. */
#include "store/write.h"
#include "tests/api/request.h"
#include "tests/kept_journal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* A name in JSON and in a query, and the character for which it is refused. */
static const struct {
    const char *json, *query, *character;
} wrong[] = {
    {"\\u0007", "%07", "U+0007"},           {"a\\u001b[2J", "a%1B%5B2J", "U+001B"},
    {"a\\nb", "a%0Ab", "U+000A"},           {"\x7f", "%7F", "U+007F"},
    {"a\xc2\x85", "a%C2%85", "U+0085"},     {"\\u202egpj", "%E2%80%AEgpj", "U+202E"},
    {"a\\u2028b", "a%E2%80%A8b", "U+2028"}, {"\\u2029", "%E2%80%A9", "U+2029"},
    {"x\\u2066y", "x%E2%81%A6y", "U+2066"}, {"\\u2069", "%E2%81%A9", "U+2069"},
};

/* A name with letters of several scripts, which run in both directions. */
static const char *const right =
    "d\xc3\xa9j\xc3\xa0 \xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d \xe2\x80\x94 3";

static void expect_refusal(size_t i, const char *pointer, bench_reply r)
{
    r = bench_expect(400, r);
    assert_non_null(strstr(r.body, wrong[i].character));
    assert_non_null(strstr(r.body, pointer));
    bench_done(r);
}

static void names_of_meshes_are_text_that_can_be_seen(void **state)
{
    (void)state;
    static const char *const patch[] = {"Content-Type", "application/merge-patch+json", NULL};
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_post(b, "/v1/meshes?id=m&name=first", "{\"shape\":\"cube\"}")));
    bench_reply before = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char body[100], target[100];
        snprintf(body, sizeof body, "{\"name\":\"%s\"}", wrong[i].json);
        expect_refusal(i, "\"/name\"", bench_send(b, "PATCH", "/v1/meshes/m", patch, body));
        expect_refusal(i, "\"/name\"", bench_post(b, "/v1/meshes/m/copy", body));
        snprintf(body, sizeof body, "{\"shape\":\"cube\",\"name\":\"%s\"}", wrong[i].json);
        expect_refusal(i, "\"/name\"", bench_post(b, "/v1/meshes", body));
        expect_refusal(i, "\"/name\"", bench_send(b, "PUT", "/v1/meshes/m", NULL, body));
        snprintf(target, sizeof target, "/v1/meshes?name=%s", wrong[i].query);
        expect_refusal(i, "bad_parameter", bench_post(b, target, "{\"shape\":\"cube\"}"));
        /* A search may contain any text: it finds the meshes that have such names already. */
        snprintf(target, sizeof target, "/v1/meshes?sort=name&contains=%s", wrong[i].query);
        bench_done(bench_expect(200, bench_get(b, target)));
    }
    bench_reply after = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_string_equal(after.body, before.body);
    bench_done(after);
    bench_done(before);
    char body[100];
    snprintf(body, sizeof body, "{\"name\":\"%s\"}", right);
    bench_reply r = bench_expect(200, bench_send(b, "PATCH", "/v1/meshes/m", patch, body));
    assert_string_equal(bench_text(&r, "name"), right);
    bench_done(r);
    bench_free(b);
}

static void a_stored_mesh_keeps_a_name_that_would_be_refused(void **state)
{
    (void)state;
    static const char *const name = "old\x07\xe2\x80\xaegpj\xe2\x80\xac";
    kept_journal *journal = kept_journal_new();
    st_journal kept = kept_journal_open(journal);
    api_bench *b = bench_new_over(&kept);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    st_mesh *mesh = NULL;
    assert_int_equal(st_find(bench_store(b), "m", &mesh), ST_OK);
    st_write w;
    assert_int_equal(st_write_begin(mesh, NULL, &w), ST_OK);
    st_write_rename(&w, name);
    assert_int_equal(st_write_commit(&w, NULL), ST_OK);
    st_release(mesh);
    bench_free(b);

    kept = kept_journal_open(journal);
    b = bench_new_over(&kept);
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_string_equal(bench_text(&r, "name"), name);
    bench_done(r);
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}")));
    r = bench_expect(201, bench_post(b, "/v1/meshes/m/copy", "{\"id\":\"c\"}"));
    assert_string_equal(bench_text(&r, "name"), name);
    bench_done(r);
    bench_free(b);
    kept_journal_free(journal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_meshes_are_text_that_can_be_seen),
        cmocka_unit_test(a_stored_mesh_keeps_a_name_that_would_be_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
