/* The examples in the OpenAPI document must equal the answers of the service. */
#include "tests/api/request.h"
#include "tests/json_member.h"

#include "api/describe/examples.h"
#include "api/describe/routes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const api_route *route_of(const char *name)
{
    for (size_t i = 0; i < api_routes().count; i++) {
        if (strcmp(api_routes().rows[i].name, name) == 0) {
            return &api_routes().rows[i];
        }
    }
    fail_msg("an example is of %s, which is no route", name);
    return NULL;
}

static bool is_one_of(const char *name, const char *const *names)
{
    while (*names != NULL && (name == NULL || strcmp(name, *names) != 0)) {
        names++;
    }
    return *names != NULL;
}

/* Replaces values in an answer that differ between runs and machines (ids, times) by those of the
 * example, if both have the same form. */
static void settle(cJSON *answer, const cJSON *example)
{
    static const char *const times[] = {"created",  "modified", "time", "started",
                                        "finished", "expires",  NULL};
    static const char *const ids[] = {"id", NULL};
    static const char *const links[] = {"result_link", NULL};
    static const char *const tickets[] = {"path", NULL};
    static const char *const sizes[] = {"budget", "memory_bytes", "bytes", NULL};
    for (cJSON *a = answer->child; a != NULL && example != NULL; a = a->next) {
        const cJSON *e = example->child;
        while (e != NULL && a->string != NULL && strcmp(a->string, e->string) != 0) {
            e = e->next;
        }
        if (cJSON_IsArray(answer)) {
            e = cJSON_GetArrayItem(example, 0);
            for (const cJSON *b = answer->child; b != a && e != NULL; b = b->next) {
                e = e->next;
            }
        }
        if (e == NULL) {
            continue;
        }
        if (is_one_of(a->string, times) && cJSON_IsString(a) && cJSON_IsString(e)) {
            assert_int_equal(strlen(a->valuestring), strlen(e->valuestring));
            memcpy(a->valuestring, e->valuestring, strlen(e->valuestring));
        } else if (cJSON_IsString(a) && cJSON_IsString(e) && is_one_of(a->string, ids) &&
                   strlen(a->valuestring) == API_JOB_ID) {
            assert_int_equal(strlen(e->valuestring), API_JOB_ID);
            memcpy(a->valuestring, e->valuestring, API_JOB_ID);
        } else if (cJSON_IsString(a) && cJSON_IsString(e) && is_one_of(a->string, links)) {
            assert_int_equal(strlen(a->valuestring), strlen(e->valuestring));
            memcpy(a->valuestring + strlen("/v1/jobs/"), API_EXAMPLE_JOB, API_JOB_ID);
        } else if (cJSON_IsString(a) && cJSON_IsString(e) && is_one_of(a->string, tickets)) {
            assert_int_equal(strlen(a->valuestring), strlen(e->valuestring));
            const char *random = strstr(e->valuestring, "hedge_");
            memcpy(a->valuestring + (random - e->valuestring), random, strlen(random));
        } else if (is_one_of(a->string, sizes) && cJSON_IsNumber(a) && cJSON_IsNumber(e)) {
            assert_true(a->valuedouble > 0);
            cJSON_SetNumberValue(a, e->valuedouble);
        } else {
            settle(a, e);
        }
    }
}

/* Replaces the incarnation of the mesh in the events, since it is random, by that of the
 * example. */
static void settle_ids(char *stream)
{
    static const char fixed[] = "5d1b27c0e4a9f386";
    for (char *id = stream; (id = strstr(id, "id: ")) != NULL; id++) {
        assert_int_equal(id[4 + sizeof fixed - 1], '.');
        memcpy(id + 4, fixed, sizeof fixed - 1);
    }
}

static void compare(const api_example *row, const bench_reply *r)
{
    if (strcmp(row->produces, "text/event-stream") == 0) {
        settle_ids(r->body);
    }
    if (strcmp(row->produces, "application/json") != 0 && row->status < 400) {
        assert_string_equal(r->body, row->response);
        return;
    }
    cJSON *example = cJSON_Parse(row->response);
    assert_non_null(example);
    assert_non_null(r->json);
    cJSON_DeleteItemFromObject(r->json, "request_id");
    settle(r->json, example);
    if (!cJSON_Compare(r->json, example, true)) {
        char *answer = cJSON_PrintUnformatted(r->json);
        print_error("%s %s is answered\n%s\nand not\n%s\n", row->route, row->target, answer,
                    row->response);
        cJSON_free(answer);
        fail();
    }
    cJSON_Delete(example);
}

static void start_job(api_bench *b, const char *method, const char *target, const char *body,
                      char path[64])
{
    const char *const headers[] = {"Prefer", "respond-async", NULL};
    bench_reply r = bench_send(b, method, target, headers, body);
    assert_int_equal(r.status, 202);
    snprintf(path, 64, "%s", bench_header(&r, "Location"));
    bench_reply_free(&r);
}

/* Starts the jobs that the examples are about; `done` and `waiting` become the paths of one that
 * has ended and one that waits. */
static void start_jobs(api_bench *b, char done[64], char waiting[64])
{
    start_job(b, "POST", "/v1/meshes?id=disk", "{\"shape\":\"disk\",\"segments\":3}", done);
    bench_run_jobs(b, 1);
    bench_reply r = bench_send(b, "DELETE", "/v1/meshes/disk", NULL, NULL);
    assert_int_equal(r.status, 204);
    bench_reply_free(&r);
    start_job(b, "PUT", "/v1/meshes/later", "{\"shape\":\"cube\"}", waiting);
}

/* Replaces the job in the target of an example by one of the two that this test started. */
static void name_job(const char *target, const char *done, const char *waiting, char *out,
                     size_t size)
{
    const char *const named[] = {"/v1/jobs/" API_EXAMPLE_JOB, "/v1/jobs/" API_EXAMPLE_WAITING};
    const char *const places[] = {done, waiting};
    snprintf(out, size, "%s", target);
    for (size_t i = 0; i < 2; i++) {
        size_t length = strlen(named[i]);
        if (strncmp(target, named[i], length) == 0) {
            snprintf(out, size, "%s%s", places[i], target + length);
        }
    }
}

static void each_example_is_a_real_answer(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    char done[64], waiting[64];
    start_jobs(b, done, waiting);
    for (size_t i = 0; i < api_example_count(); i++) {
        const api_example *row = api_example_at(i);
        const api_route *route = route_of(row->route);
        /* A refusal is sent as application/problem+json whatever the client accepts, so the request
         * may accept anything. */
        const char *accept = row->status < 400 ? row->produces : "*/*";
        const char *headers[] = {"Accept", accept, "Content-Type", row->consumes, NULL};
        headers[2] = row->consumes == NULL ? NULL : headers[2];
        char target[256];
        name_job(row->target, done, waiting, target, sizeof target);
        bench_reply r = bench_send(b, route->method, target, headers, row->request);
        if (r.status != row->status) {
            fail_msg("%s %s: %d: %s", route->method, row->target, r.status, r.body);
        }
        assert_string_equal(r.route, route->path);
        compare(row, &r);
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* Requires that `body` is the example given for this media type in `content`. */
static void find_in(const cJSON *content, const char *media, const char *body)
{
    const cJSON *shown = json_member(json_member(content, media), "example");
    if (cJSON_IsString(shown)) {
        assert_string_equal(shown->valuestring, body);
    } else {
        cJSON *parsed = cJSON_Parse(body);
        assert_true(cJSON_Compare(shown, parsed, true));
        cJSON_Delete(parsed);
    }
}

static void the_description_shows_them(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    bench_reply r = bench_send(b, "GET", "/v1/openapi.json", NULL, NULL);
    assert_non_null(r.json);
    for (size_t i = 0; i < api_example_count(); i++) {
        const api_example *row = api_example_at(i);
        const api_route *route = route_of(row->route);
        char method[8] = "", status[8];
        for (size_t c = 0; c + 1 < sizeof method && route->method[c] != '\0'; c++) {
            method[c] = (char)(route->method[c] | 32);
        }
        if (row->status >= 400) {
            continue;
        }
        const cJSON *operation =
            json_member(json_member(json_member(r.json, "paths"), route->path), method);
        snprintf(status, sizeof status, "%d", row->status);
        find_in(json_member(json_member(json_member(operation, "responses"), status), "content"),
                row->produces, api_example_response(row->route, row->produces));
        if (row->request != NULL) {
            find_in(json_member(json_member(operation, "requestBody"), "content"), row->consumes,
                    api_example_request(row->route, row->consumes));
        }
    }
    find_in(json_member(
                json_member(json_member(json_member(r.json, "components"), "responses"), "problem"),
                "content"),
            "application/problem+json", api_example_problem());
    bench_reply_free(&r);
    bench_free(b);
}

/* The document shows no examples for these answers, because they are as long as the tables that
 * they print. */
static const char *const too_long[] = {"list_operations", "get_openapi", NULL};

static void no_route_is_without_one(void **state)
{
    (void)state;
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *route = &api_routes().rows[i];
        if ((route->flags & API_FIXED) || is_one_of(route->name, too_long)) {
            continue;
        }
        if (route->response != NULL &&
            api_example_response(route->name, route->produces[0]) == NULL) {
            fail_msg("%s has no example of an answer", route->name);
        }
        if (route->request != NULL &&
            api_example_request(route->name, route->consumes[0]) == NULL) {
            fail_msg("%s has no example of a body", route->name);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_example_is_a_real_answer),
        cmocka_unit_test(the_description_shows_them),
        cmocka_unit_test(no_route_is_without_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
