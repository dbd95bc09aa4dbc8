/* The edit `append` adds a copy of a second mesh to the edited mesh. The second mesh is named by
 * its id and copied in its present state. If it is not available, the edit is refused. */
#include "tests/api/request.h"

#include "api/json/text.h"
#include "api/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define TRIANGLE "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]]}"

static bench_reply put(api_bench *b, const char *target, const char *body)
{
    return bench_send(b, "PUT", target, NULL, body);
}

static int count_of(api_bench *b, const char *mesh, const char *kind)
{
    char target[100];
    (void)snprintf(target, sizeof target, "/v1/meshes/%s", mesh);
    bench_reply r = bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
    const cJSON *counts = cJSON_GetObjectItem(r.json, "counts");
    int count = (int)cJSON_GetObjectItem(counts, kind)->valuedouble;
    bench_done(r);
    return count;
}

static api_bench *begin(void)
{
    api_bench *b = bench_new();
    assert_non_null(b);
    bench_done(bench_expect(201, put(b, "/v1/meshes/box", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, put(b, "/v1/meshes/tile", TRIANGLE)));
    return b;
}

static void the_other_mesh_comes_in_and_its_elements_can_be_named(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply r = bench_expect(
        200,
        bench_post(b, "/v1/meshes/box/edits",
                   "{\"ops\":[{\"op\":\"append\",\"mesh\":\"tile\",\"as\":\"a\"},"
                   "{\"op\":\"vertex_move\",\"vertices\":[\"$a.vertices\"],\"by\":[5,0,0]},"
                   "{\"op\":\"face_delete\",\"face\":\"$a.faces.0\",\"keep_isolated\":true}]}"));
    const cJSON *made = cJSON_GetObjectItem(r.json, "created");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(made, "vertices")), 3);
    bench_done(r);
    assert_int_equal(count_of(b, "box", "vertices"), 11);
    assert_int_equal(count_of(b, "tile", "faces"), 1);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/box/undo", NULL)));
    assert_int_equal(count_of(b, "box", "vertices"), 8);
    bench_free(b);
}

static void a_mesh_may_be_appended_to_itself_as_it_was(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/tile/edits",
                                            "{\"ops\":[{\"op\":\"append\",\"mesh\":\"tile\"},"
                                            "{\"op\":\"append\",\"mesh\":\"tile\"},"
                                            "{\"op\":\"append\",\"mesh\":\"box\"}]}")));
    assert_int_equal(count_of(b, "tile", "faces"), 9);
    assert_int_equal(count_of(b, "tile", "components"), 4);
    bench_free(b);
}

static void a_dry_run_appends_nothing(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_done(
        bench_expect(200, bench_post(b, "/v1/meshes/box/edits",
                                     "{\"op\":\"append\",\"mesh\":\"tile\",\"dry_run\":true}")));
    assert_int_equal(count_of(b, "box", "faces"), 6);
    bench_free(b);
}

static void what_cannot_be_had_is_refused_at_its_place(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *code, *pointer;
    } refused[] = {
        {"{\"op\":\"append\"}", 400, "missing_member", ""},
        {"{\"op\":\"append\",\"mesh\":true}", 400, "wrong_type", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":7}", 422, "no_such_revision", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":null}", 400, "wrong_type", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":\"none\"}", 422, "no_such_mesh", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":\"\"}", 422, "no_such_mesh", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":\"../box\"}", 422, "no_such_mesh", "/mesh"},
        {"{\"op\":\"append\",\"mesh\":\"$a.mesh\"}", 422, "no_such_mesh", "/mesh"},
        {"{\"ops\":[{\"op\":\"append\",\"mesh\":\"tile\"},{\"op\":\"append\",\"mesh\":\"gone\"}]}",
         422, "no_such_mesh", "/ops/1/mesh"},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        bench_reply r =
            bench_expect(refused[i].status, bench_post(b, "/v1/meshes/box/edits", refused[i].body));
        assert_string_equal(bench_text(&r, "code"), refused[i].code);
        assert_string_equal(bench_text(&r, "pointer"), refused[i].pointer);
        bench_done(r);
    }
    assert_int_equal(count_of(b, "box", "faces"), 6);
    bench_free(b);
}

static void no_request_names_more_meshes_than_it_may(void **state)
{
    (void)state;
    api_bench *b = begin();
    api_text body = {0};
    api_text_add_format(&body, "{\"ops\":[");
    for (int i = 0; i <= API_MAX_NAMED_MESHES; i++) {
        char target[64];
        (void)snprintf(target, sizeof target, "/v1/meshes/t%d", i);
        bench_done(bench_expect(201, put(b, target, TRIANGLE)));
        api_text_add_format(&body, "%s{\"op\":\"append\",\"mesh\":\"t%d\"}", i > 0 ? "," : "", i);
    }
    api_text_add(&body, "]}", sizeof "]}");
    bench_reply r = bench_expect(413, bench_post(b, "/v1/meshes/box/edits", body.bytes));
    assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
    bench_done(r);
    assert_int_equal(count_of(b, "box", "faces"), 6);
    api_text_clear(&body);
    bench_free(b);
}

static void attributes_of_one_name_and_two_types_are_refused(void **state)
{
    (void)state;
    static const char *const bodies[2] = {
        "{\"type\":\"float\",\"components\":1}",
        "{\"type\":\"float\",\"components\":3}",
    };
    api_bench *b = begin();
    bench_done(bench_expect(201, put(b, "/v1/meshes/box/attributes/vertices/heat", bodies[0])));
    bench_done(bench_expect(201, put(b, "/v1/meshes/tile/attributes/vertices/heat", bodies[1])));
    bench_reply r = bench_expect(
        422, bench_post(b, "/v1/meshes/box/edits", "{\"op\":\"append\",\"mesh\":\"tile\"}"));
    assert_string_equal(bench_text(&r, "code"), "attribute_clash");
    bench_done(r);
    bench_free(b);
}

/* The attributes of the appended mesh count toward the maximum number of attributes of the mesh. */
static void no_mesh_gets_more_attributes_than_it_may(void **state)
{
    (void)state;
    api_bench *b = begin();
    for (int i = 0; i < API_MAX_ATTRIBUTES; i++) {
        char target[100];
        (void)snprintf(target, sizeof target, "/v1/meshes/%s/attributes/vertices/a%d",
                       i % 2 ? "box" : "tile", i);
        bench_done(bench_expect(201, put(b, target, "{\"type\":\"bool\",\"components\":1}")));
    }
    bench_done(
        bench_expect(200, bench_post(b, "/v1/meshes/box/edits",
                                     "{\"op\":\"append\",\"mesh\":\"tile\",\"dry_run\":true}")));
    bench_done(bench_expect(201, put(b, "/v1/meshes/box/attributes/vertices/b",
                                     "{\"type\":\"bool\",\"components\":1}")));
    bench_reply r = bench_expect(
        413, bench_post(b, "/v1/meshes/box/edits", "{\"op\":\"append\",\"mesh\":\"tile\"}"));
    assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
    bench_done(r);
    bench_free(b);
}

/* The appended mesh is so large that the edit makes its result outside the mesh's lock. Whether the
 * large mesh is appended to itself or to a small mesh, `append` must copy its state before the
 * edit. */
static void a_large_mesh_takes_in_and_is_taken_in(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_done(bench_expect(
        201, put(b, "/v1/meshes/wide", "{\"shape\":\"grid\",\"columns\":300,\"rows\":300}")));
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/wide/edits", "{\"op\":\"append\",\"mesh\":\"wide\"}")));
    assert_int_equal(count_of(b, "wide", "faces"), 2 * 300 * 300);
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/tile/edits", "{\"op\":\"append\",\"mesh\":\"wide\"}")));
    assert_int_equal(count_of(b, "tile", "faces"), 2 * 300 * 300 + 1);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_other_mesh_comes_in_and_its_elements_can_be_named),
        cmocka_unit_test(a_mesh_may_be_appended_to_itself_as_it_was),
        cmocka_unit_test(a_dry_run_appends_nothing),
        cmocka_unit_test(what_cannot_be_had_is_refused_at_its_place),
        cmocka_unit_test(no_request_names_more_meshes_than_it_may),
        cmocka_unit_test(attributes_of_one_name_and_two_types_are_refused),
        cmocka_unit_test(no_mesh_gets_more_attributes_than_it_may),
        cmocka_unit_test(a_large_mesh_takes_in_and_is_taken_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
