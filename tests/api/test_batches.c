/* An edit that is a list of ten thousand operations: it is parsed one operation at a time, makes
 * one revision and one undo step, is applied completely or not at all, and a dry run predicts its
 * result. */
#include "tests/api/request.h"

#include "api/json/text.h"
#include "api/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MANY = 10000 };

/* Writes a list of `count` edge splits, each of an edge that the previous split made. If `last` is
 * not NULL, it replaces the last split. */
static void write_chain(api_text *body, const char *before, size_t count, const char *last)
{
    api_text_empty(body);
    api_text_add_format(body, "{%s\"ops\":[", before);
    api_text_add_string(body, "{\"op\":\"edge_split\",\"edge\":0,\"as\":\"s0\"}");
    for (size_t i = 1; i < count; i++) {
        if (i + 1 == count && last != NULL) {
            api_text_add_format(body, ",%s", last);
        } else {
            api_text_add_format(
                body, ",{\"op\":\"edge_split\",\"edge\":\"$s%zu.edges.0\",\"as\":\"s%zu\"}", i - 1,
                i);
        }
    }
    api_text_add(body, "]}", sizeof "]}");
    assert_false(body->failed);
}

static api_bench *begin(void)
{
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"icosahedron\"}")));
    bench_done(bench_expect(
        200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":3}")));
    return b;
}

/* Returns a copy of the mesh, including the number of ids that it has issued. */
static he_mesh *copy_of(api_bench *b)
{
    st_store *store = bench_store(b);
    st_mesh *mesh = NULL;
    he_mesh *copy = NULL;
    assert_int_equal(st_find(store, "m", &mesh), ST_OK);
    const he_mesh *content = st_read_begin(mesh, NULL);
    assert_int_equal(he_mesh_copy(content, &copy, NULL), HE_OK);
    st_read_end(mesh);
    st_release(mesh);
    return copy;
}

typedef struct state_of {
    he_mesh *mesh;
    bench_reply content, faces, history;
} state_of;

static state_of take(api_bench *b)
{
    return (state_of){copy_of(b), bench_expect(200, bench_get(b, "/v1/meshes/m/content")),
                      bench_expect(200, bench_get(b, "/v1/meshes/m/faces?limit=10000")),
                      bench_expect(200, bench_get(b, "/v1/meshes/m/edits"))};
}

/* Requires that the mesh, the answers about it and its history equal those that `before`
 * recorded. */
static void expect_same(api_bench *b, state_of *before)
{
    state_of now = take(b);
    assert_true(he_mesh_equal(before->mesh, now.mesh));
    for (int kind = 0; kind < HE_KIND_COUNT; kind++) {
        assert_int_equal(he_mesh_issued(before->mesh, (he_kind)kind),
                         he_mesh_issued(now.mesh, (he_kind)kind));
    }
    assert_string_equal(before->content.body, now.content.body);
    assert_string_equal(before->faces.body, now.faces.body);
    assert_string_equal(before->history.body, now.history.body);
    he_mesh_free(now.mesh);
    bench_done(now.content);
    bench_done(now.faces);
    bench_done(now.history);
}

static void state_free(state_of *state)
{
    he_mesh_free(state->mesh);
    bench_done(state->content);
    bench_done(state->faces);
    bench_done(state->history);
}

static int number_of(const bench_reply *r, const char *member)
{
    return cJSON_GetObjectItem(r->json, member)->valueint;
}

static void ten_thousand_are_one_revision_and_one_step(void **state)
{
    (void)state;
    api_bench *b = begin();
    api_text body = {0};
    write_chain(&body, "", MANY, NULL);
    bench_reply before = bench_expect(200, bench_get(b, "/v1/meshes/m/content"));
    bench_reply r = bench_expect(200, bench_post(b, "/v1/meshes/m/edits", body.bytes));
    assert_int_equal(number_of(&r, "revision"), 3);
    const cJSON *results = cJSON_GetObjectItem(r.json, "results"), *result;
    assert_int_equal(cJSON_GetArraySize(results), MANY);
    cJSON_ArrayForEach(result, results)
    {
        assert_string_equal(cJSON_GetObjectItem(result, "op")->valuestring, "edge_split");
        assert_true(cJSON_IsNumber(cJSON_GetObjectItem(result, "vertex")));
    }
    const cJSON *created = cJSON_GetObjectItem(r.json, "created");
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(created, "vertices")), MANY);
    bench_reply_free(&r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    assert_int_equal(number_of(&r, "undo"), 2);
    bench_reply_free(&r);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/content"));
    assert_string_equal(r.body, before.body);
    bench_reply_free(&r);
    bench_reply_free(&before);
    bench_free(b);
    api_text_clear(&body);
}

static void the_last_of_ten_thousand_undoes_all_before_it(void **state)
{
    (void)state;
    static const struct {
        const char *last;
        int status;
        const char *code, *pointer;
    } cases[] = {
        {"{\"op\":\"edge_split\",\"edge\":4000000}", 422, "no_such_element", "/ops/9999"},
        {"{\"op\":\"edge_collapse\",\"edge\":\"$s9998.edges.7\"}", 422, "no_such_element",
         "/ops/9999/edge"},
        {"{\"op\":\"edge_split\",\"edge\":\"$s9999.edges.0\"}", 400, "bad_reference",
         "/ops/9999/edge"},
        {"{\"op\":\"edge_split\",\"edge\":1,\"as\":\"s17\"}", 400, "repeated_name", "/ops/9999/as"},
        {"{\"op\":\"edge_split\",\"edge\":1,\"t\":\"half\"}", 400, "wrong_type", "/ops/9999/t"},
        {"{\"op\":\"edge_split\",\"edge\":1,\"edge\":2}", 400, "duplicate_member",
         "/ops/9999/edge"},
        {"{\"op\":\"edge_split\",\"egde\":1}", 400, "unknown_member", "/ops/9999/egde"},
        {"7", 400, "wrong_type", "/ops/9999"},
        {"{\"op\":\"edge_split\",\"edge\":01}", 400, "malformed_json", "/ops/9999/edge"},
    };
    api_bench *b = begin();
    state_of before = take(b);
    api_text body = {0};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_chain(&body, "", MANY, cases[i].last);
        bench_reply r =
            bench_expect(cases[i].status, bench_post(b, "/v1/meshes/m/edits", body.bytes));
        assert_string_equal(bench_text(&r, "code"), cases[i].code);
        assert_string_equal(bench_text(&r, "pointer"), cases[i].pointer);
        bench_reply_free(&r);
        expect_same(b, &before);
    }
    state_free(&before);
    bench_free(b);
    api_text_clear(&body);
}

static void a_dry_run_tells_the_answer_and_changes_nothing(void **state)
{
    (void)state;
    api_bench *b = begin();
    state_of before = take(b);
    api_text body = {0};
    write_chain(&body, "\"dry_run\":true,", MANY, NULL);
    bench_reply dry = bench_expect(200, bench_post(b, "/v1/meshes/m/edits", body.bytes));
    assert_string_equal(bench_header(&dry, "ETag"), "");
    expect_same(b, &before);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(dry.json, "dry_run")));
    cJSON_DeleteItemFromObject(dry.json, "dry_run");
    write_chain(&body, "", MANY, NULL);
    bench_reply real = bench_expect(200, bench_post(b, "/v1/meshes/m/edits", body.bytes));
    assert_true(cJSON_Compare(dry.json, real.json, true));
    bench_reply_free(&dry);
    bench_reply_free(&real);
    state_free(&before);
    bench_free(b);
    api_text_clear(&body);
}

static void the_list_may_stand_anywhere_in_its_document(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *pointer;
    } cases[] = {
        {" { \"ops\" : [ ] , \"dry_run\" : true } ", 400, "/ops"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":1}],\"dry_run\":true}", 200, NULL},
        {"{\"dry_run\":true,\"ops\":[{\"op\":\"face_poke\",\"face\":1} , "
         "{\"op\":\"face_poke\",\"face\":2}]}",
         200, NULL},
        {"{\"dry_run\":true,\"\\u006fp\\u0073\":[{\"op\":\"face_poke\",\"face\":1}]}", 200, NULL},
        {"{\"dry_run\":true,\"op\\n\":[]}", 400, ""},
        {"{\"ops\":{\"ops\":[]}}", 400, "/ops"},
        {"{\"ops\":7}", 400, "/ops"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":1}],\"ops\":[]}", 400, "/ops"},
        {"{\"op\":\"vertex_move\",\"ops\":[{\"op\":\"face_poke\",\"face\":1}]}", 400, "/op"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":1},[]]}", 400, "/ops/1"},
        {"{\"ops\":[{\"op\":\"face_poke\",\"face\":1}]", 400, ""},
        {"[{\"ops\":[]}]", 400, ""},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench_reply r =
            bench_expect(cases[i].status, bench_post(b, "/v1/meshes/m/edits", cases[i].body));
        if (cases[i].pointer != NULL && cases[i].pointer[0] != '\0') {
            assert_string_equal(bench_text(&r, "pointer"), cases[i].pointer);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* --- memory --- */

static size_t held, most;

static void *count(void *context, void *memory, size_t size)
{
    (void)context;
    size_t *block = memory == NULL ? NULL : (size_t *)memory - 2;
    held -= block == NULL ? 0 : *block;
    if (size == 0) {
        free(block);
        return NULL;
    }
    block = realloc(block, size + 2 * sizeof *block);
    assert_non_null(block);
    *block = size;
    held += size;
    most = held > most ? held : most;
    return block + 2;
}

/* Returns the peak of the memory that a request with the list of operations `body` allocates, less
 * what stays allocated after its answer. */
static size_t peak_of(api_bench *b, const api_text *body)
{
    most = held;
    size_t before = held;
    bench_reply r;
    assert_true(bench_try(
        b, &(bench_request){"POST", "/v1/meshes/m/edits", NULL, body->bytes, body->length}, &r));
    assert_int_equal(r.status, 200);
    bench_reply_free(&r);
    return most - before;
}

/* A list is parsed one operation at a time, so its memory must stay near the size of its text and
 * its results. A parser that built a tree of all JSON values would need fifteen times the size of
 * the text. */
static void a_list_costs_its_text_and_its_results(void **state)
{
    (void)state;
    static const he_mem_hook hook = {count, NULL};
    he_mem_set_hook(&hook);
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    api_text body = {0};
    api_text_add_string(&body, "{\"dry_run\":true,\"ops\":[");
    for (int i = 0; i < 60000; i++) {
        api_text_add_format(&body,
                            "%s{\"op\":\"vertex_move\",\"vertices\":[0,1,2,3,4,5,6,7],"
                            "\"by\":[0,0,0]}",
                            i == 0 ? "" : ",");
    }
    api_text_add_string(&body, "]}");
    assert_false(body.failed);
    assert_true(body.length < API_MAX_EDITS);
    size_t peak = peak_of(b, &body);
    print_message("note: 60,000 operations in %.1f MB: at most %.1f MB beside the mesh\n",
                  (double)body.length / 1e6, (double)peak / 1e6);
    assert_true(peak < 3 * body.length);

    api_text_empty(&body);
    write_chain(&body, "\"dry_run\":true,", MANY, NULL);
    body.length = strlen(body.bytes);
    peak = peak_of(b, &body);
    print_message("note: 10,000 named edge splits: %.1f MB of text, at most %.1f MB\n",
                  (double)body.length / 1e6, (double)peak / 1e6);
    assert_true(peak < (size_t)48 << 20);
    api_text_clear(&body);
    bench_free(b);
    assert_int_equal(held, 0);
    he_mem_set_hook(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ten_thousand_are_one_revision_and_one_step),
        cmocka_unit_test(the_last_of_ten_thousand_undoes_all_before_it),
        cmocka_unit_test(a_dry_run_tells_the_answer_and_changes_nothing),
        cmocka_unit_test(the_list_may_stand_anywhere_in_its_document),
        cmocka_unit_test(a_list_costs_its_text_and_its_results),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
