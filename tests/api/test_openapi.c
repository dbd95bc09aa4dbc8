/* The served description holds together and says what the tables say. */
#include "tests/api/request.h"

#include "algo/shape.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const cJSON *member(const cJSON *object, const char *name)
{
    const cJSON *found = cJSON_GetObjectItemCaseSensitive(object, name);
    if (found == NULL) {
        fail_msg("there is no \"%s\"", name);
    }
    return found;
}

/* "#/components/GROUP/NAME" */
static const cJSON *resolve(const cJSON *root, const char *reference)
{
    char group[32], name[64];
    assert_int_equal(sscanf(reference, "#/components/%31[^/]/%63s", group, name), 2);
    return member(member(member(root, "components"), group), name);
}

/* Follow every reference below `at`, and mark what is reached. */
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
    cJSON_ArrayForEach(schema, member(member(r.json, "components"), "schemas"))
    {
        if (schema->valueint != 1) {
            fail_msg("nothing refers to the schema %s", schema->string);
        }
    }
    assert_int_equal(cJSON_GetArraySize(member(r.json, "servers")), 1);
    assert_true(cJSON_IsArray(member(r.json, "security")));
    bench_reply_free(&r);
    bench_free(b);
}

static void shapes_are_those_of_the_table(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = description(b);
    const cJSON *shapes = member(resolve(r.json, "#/components/schemas/shape"), "oneOf");
    assert_int_equal(cJSON_GetArraySize(shapes), he_shape_count());
    for (size_t i = 0; i < he_shape_count(); i++) {
        const he_shape *shape = he_shape_at(i);
        const cJSON *properties = member(cJSON_GetArrayItem(shapes, (int)i), "properties");
        assert_string_equal(member(member(properties, "shape"), "const")->valuestring, shape->name);
        for (size_t p = 0; p < he_shape_params(shape); p++) {
            member(member(properties, shape->params[p].name), "default");
        }
    }
    bench_reply_free(&r);
    bench_free(b);
}

/* Members that a body may not have would be a lie in its schema. */
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
        cJSON_ArrayForEach(property, member(resolve(r.json, reference), "properties"))
        {
            snprintf(body, sizeof body, "{\"%s\":false}", property->string);
            bench_reply a = bench_send(b, bodies[i].method, bodies[i].target, NULL, body);
            /* Known, and of another type. */
            assert_int_equal(a.status, 400);
            assert_string_equal(member(a.json, "code")->valuestring, "wrong_type");
            bench_reply_free(&a);
        }
    }
    bench_reply_free(&r);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(references_meet_and_nothing_is_left_over),
        cmocka_unit_test(shapes_are_those_of_the_table),
        cmocka_unit_test(bodies_take_what_their_schemas_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
