/* The OpenAPI document that the service serves is consistent, and agrees with the tables of routes
 * and operations. */
#include "tests/api/request.h"
#include "tests/json_member.h"

#include "algo/shape.h"
#include "api/request/answer_headers.h"
#include "api/describe/routes.h"
#include "api/request/route.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* Returns the object to which a reference "#/components/GROUP/NAME" points. */
static const cJSON *resolve(const cJSON *root, const char *reference)
{
    char group[32], name[64];
    assert_int_equal(sscanf(reference, "#/components/%31[^/]/%63s", group, name), 2);
    return json_member(json_member(json_member(root, "components"), group), name);
}

/* Follows every reference "$ref" below `at`, adds their number to `*references`, and marks the
 * schemas to which they point. */
static void follow(const cJSON *root, cJSON *at, size_t *references)
{
    cJSON *child;
    cJSON_ArrayForEach(child, at)
    {
        if (child->string != NULL && strcmp(child->string, "$ref") == 0) {
            const cJSON *target = resolve(root, child->valuestring);
            ((cJSON *)target)->valueint = 1;
            ++*references;
        }
        follow(root, child, references);
    }
}

static bench_reply description(api_bench *b)
{
    bench_reply r = bench_send(b, "GET", "/v1/openapi.json", NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_non_null(r.json);
    return r;
}

static void references_meet_and_nothing_is_left_over(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = description(b);
    size_t references = 0;
    follow(r.json, r.json, &references);
    assert_true(references > 100);
    const cJSON *schema;
    cJSON_ArrayForEach(schema, json_member(json_member(r.json, "components"), "schemas"))
    {
        if (schema->valueint != 1) {
            fail_msg("nothing refers to the schema %s", schema->string);
        }
    }
    assert_int_equal(cJSON_GetArraySize(json_member(r.json, "servers")), 1);
    assert_true(cJSON_IsArray(json_member(r.json, "security")));
    bench_reply_free(&r);
    bench_free(b);
}

static void shapes_are_those_of_the_table(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = description(b);
    const cJSON *shapes = json_member(resolve(r.json, "#/components/schemas/shape"), "oneOf");
    assert_int_equal(cJSON_GetArraySize(shapes), he_shape_count());
    for (size_t i = 0; i < he_shape_count(); i++) {
        const he_shape *shape = he_shape_at(i);
        const cJSON *part = json_member(cJSON_GetArrayItem(shapes, (int)i), "$ref");
        const cJSON *properties = json_member(resolve(r.json, part->valuestring), "properties");
        assert_string_equal(json_member(json_member(properties, "shape"), "const")->valuestring,
                            shape->name);
        for (size_t p = 0; p < he_shape_params(shape); p++) {
            json_member(json_member(properties, shape->params[p].name), "default");
        }
    }
    bench_reply_free(&r);
    bench_free(b);
}

/* The service must know each member that a request's schema lists: a value of the wrong type must
 * be refused because of its type, and not as an unknown member. */
static void bodies_take_what_their_schemas_list(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply made = bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}");
    assert_int_equal(made.status, 201);
    bench_reply_free(&made);
    static const struct {
        const char *schema, *method, *target;
    } bodies[] = {{"document", "POST", "/v1/meshes"},
                  {"mesh_patch", "PATCH", "/v1/meshes/m"},
                  {"copy", "POST", "/v1/meshes/m/copy"},
                  {"step", "POST", "/v1/meshes/m/undo"}};
    bench_reply r = description(b);
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        char reference[64], body[128];
        snprintf(reference, sizeof reference, "#/components/schemas/%s", bodies[i].schema);
        const cJSON *property;
        cJSON_ArrayForEach(property, json_member(resolve(r.json, reference), "properties"))
        {
            snprintf(body, sizeof body, "{\"%s\":false}", property->string);
            bench_reply a = bench_send(b, bodies[i].method, bodies[i].target, NULL, body);
            /* The refusal shows that the service knows the member and expects another type. */
            assert_int_equal(a.status, 400);
            assert_string_equal(json_member(a.json, "code")->valuestring, "wrong_type");
            bench_reply_free(&a);
        }
    }
    bench_reply_free(&r);
    bench_free(b);
}

/* Returns whether the list of exposed headers, separated by ", ", contains the header `name`. */
static bool is_exposed(const char *name)
{
    size_t length = strlen(name);
    bool found = false;
    for (const char *at = api_exposed_headers; at != NULL && !found; at = strchr(at, ' ')) {
        at += *at == ' ';
        found = strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == '\0');
    }
    return found;
}

/* Requires that scripts in browsers may read each header that the document lists for an answer
 * (Access-Control-Expose-Headers). Returns how many headers the document lists there. */
static unsigned expect_exposed(const cJSON *at)
{
    unsigned count = 0;
    const cJSON *child, *header;
    cJSON_ArrayForEach(child, at)
    {
        if (child->string != NULL && strcmp(child->string, "headers") == 0) {
            cJSON_ArrayForEach(header, child)
            {
                if (!is_exposed(header->string) || !api_header_is_listed(header->string)) {
                    fail_msg("%s is not exposed", header->string);
                }
                count++;
            }
        }
        count += expect_exposed(child);
    }
    return count;
}

static void each_flag_of_a_route_is_a_bit_of_its_own(void **state)
{
    (void)state;
    static const unsigned flags[] = {
        API_WRITES,        API_COSTLY,          API_MAY_CREATE,          API_OWN_ACCEPT,
        API_FIXED,         API_IDEMPOTENCY_KEY, API_IDEMPOTENCY_KEY_NEW, API_LONG,
        API_INTERRUPTS,    API_REHEARSED,       API_EXPENSIVE,           API_STORELESS,
        API_TAG_OF_OTHERS, API_UNLIMITED,       API_MISSING_PAGE,        API_OWN_QUERY};
    unsigned all = 0;
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        assert_int_equal(all & flags[i], 0);
        assert_int_equal(flags[i] & (flags[i] - 1), 0);
        all |= flags[i];
    }
    /* The list above is whole: no row has another flag. */
    for (size_t i = 0; i < api_routes().count; i++) {
        assert_int_equal(api_routes().rows[i].flags & ~all, 0);
    }
}

static const cJSON *not_found_of(const cJSON *root, const char *path)
{
    const cJSON *get = json_member(json_member(json_member(root, "paths"), path), "get");
    return json_member(json_member(get, "responses"), "404");
}

static void only_the_manual_answers_404_with_a_page(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = description(b);
    const cJSON *content = json_member(not_found_of(r.json, "/docs/{asset}"), "content");
    assert_non_null(cJSON_GetObjectItem(content, "text/html"));
    assert_non_null(cJSON_GetObjectItem(not_found_of(r.json, "/"), "$ref"));
    bench_reply_free(&r);
    bench_free(b);
}

static void pages_of_other_origins_may_read_every_header_described(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = bench_expect(200, bench_get(b, "/v1/openapi.json"));
    assert_true(expect_exposed(r.json) > 100);
    assert_true(is_exposed("ETag") && is_exposed("X-Request-Id") && is_exposed("Export-Warnings"));
    assert_false(is_exposed("Request-Id") || is_exposed("X-Request"));
    assert_false(api_header_is_listed("X-New"));
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_told_header *const *told = api_routes().rows[i].headers;
        for (; *told != NULL; told++) {
            assert_true(is_exposed((*told)->name));
        }
    }
    bench_reply_free(&r);
    bench_free(b);
}

/* Returns the parameter `name` of an operation in the answer of GET /v1/operations. */
static const cJSON *parameter_of(const cJSON *operations, const char *operation, const char *name)
{
    const cJSON *op, *param;
    cJSON_ArrayForEach(op, json_member(operations, "operations"))
    {
        cJSON_ArrayForEach(param, json_member(op, "params"))
        {
            if (strcmp(json_member(op, "name")->valuestring, operation) == 0 &&
                strcmp(json_member(param, "name")->valuestring, name) == 0) {
                return param;
            }
        }
    }
    fail_msg("%s has no parameter %s", operation, name);
    return NULL;
}

static bool takes_set(const cJSON *document, const char *schema, const char *member)
{
    const cJSON *schemas = json_member(json_member(document, "components"), "schemas");
    const cJSON *properties = json_member(json_member(schemas, schema), "properties");
    const cJSON *choice;
    cJSON_ArrayForEach(choice, json_member(json_member(properties, member), "oneOf"))
    {
        const cJSON *reference = cJSON_GetObjectItem(choice, "$ref");
        if (reference != NULL && strcmp(reference->valuestring, "#/components/schemas/set") == 0) {
            return true;
        }
    }
    return false;
}

/* A set may be given for each list of elements, but not for a column beside it. */
static void sets_are_described_where_they_are_taken(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply table = bench_expect(200, bench_get(b, "/v1/operations"));
    bench_reply document = bench_expect(200, bench_get(b, "/v1/openapi.json"));
    assert_true(
        cJSON_IsTrue(cJSON_GetObjectItem(parameter_of(table.json, "edge_split", "edge"), "set")));
    assert_true(
        cJSON_IsTrue(cJSON_GetObjectItem(parameter_of(table.json, "edge_weld", "a"), "set")));
    assert_null(cJSON_GetObjectItem(parameter_of(table.json, "edge_weld", "b"), "set"));
    assert_null(cJSON_GetObjectItem(parameter_of(table.json, "vertex_add", "position"), "set"));
    assert_true(takes_set(document.json, "op_edge_split", "edges"));
    assert_true(takes_set(document.json, "op_edge_weld", "a"));
    assert_false(takes_set(document.json, "op_edge_weld", "b"));
    bench_reply_free(&document);
    bench_reply_free(&table);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(references_meet_and_nothing_is_left_over),
        cmocka_unit_test(shapes_are_those_of_the_table),
        cmocka_unit_test(bodies_take_what_their_schemas_list),
        cmocka_unit_test(each_flag_of_a_route_is_a_bit_of_its_own),
        cmocka_unit_test(only_the_manual_answers_404_with_a_page),
        cmocka_unit_test(pages_of_other_origins_may_read_every_header_described),
        cmocka_unit_test(sets_are_described_where_they_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
