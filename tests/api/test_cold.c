/* Requests about cold meshes, which are on the disk and not in memory. The answers must equal those
 * before the restart of the service, and a damaged mesh can be deleted or replaced. */
#include "tests/api/request.h"
#include "tests/kept_journal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static kept_journal *journal;

static api_bench *restart(api_bench *b)
{
    if (b != NULL) {
        bench_free(b);
    }
    const st_journal kept = kept_journal_open(journal);
    return bench_new_over(&kept);
}

static void poke(api_bench *b, const char *id, int face)
{
    char target[64], body[64];
    snprintf(target, sizeof target, "/v1/meshes/%s/edits", id);
    snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
    bench_done(bench_expect(200, bench_post(b, target, body)));
}

static api_bench *begin(void)
{
    journal = kept_journal_new();
    api_bench *b = restart(NULL);
    bench_done(
        bench_expect(201, bench_post(b, "/v1/meshes?id=m&name=first", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=n", "{\"shape\":\"cube\"}")));
    for (int face = 1; face < 5; face++) {
        poke(b, "m", face);
    }
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    return b;
}

static void end(api_bench *b)
{
    bench_free(b);
    kept_journal_free(journal);
}

static void expect_code(int status, const char *code, bench_reply r)
{
    r = bench_expect(status, r);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    bench_done(r);
}

static api_bench *expect_same_after_restart(api_bench *b, const char *target)
{
    bench_reply was = bench_expect(200, bench_get(b, target));
    char *body = strdup(was.body), *tag = strdup(bench_header(&was, "ETag"));
    bench_done(was);
    b = restart(b);
    bench_reply is = bench_expect(200, bench_get(b, target));
    assert_string_equal(is.body, body);
    assert_string_equal(bench_header(&is, "ETag"), tag);
    bench_done(is);
    free(body);
    free(tag);
    return b;
}

static void what_is_read_is_what_it_was(void **state)
{
    (void)state;
    static const char *const targets[] = {
        "/v1/meshes/m",         "/v1/meshes/m/content",          "/v1/meshes/m/edits",
        "/v1/meshes/m/faces/1", "/v1/meshes/m/faces/1/vertices", "/v1/meshes/m/content?revision=3",
        "/v1/meshes/m/check",   "/v1/meshes/m/vertices?limit=3"};
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        b = expect_same_after_restart(b, targets[i]);
    }
    end(b);
}

static void a_cold_mesh_is_changed_like_any_other(void **state)
{
    (void)state;
    static const struct {
        const char *method, *target, *body;
        int status;
    } cases[] = {
        {"POST", "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}", 200},
        {"POST", "/v1/meshes/m/redo", NULL, 409},
        {"POST", "/v1/meshes/m/undo", "{\"steps\":4}", 200},
        {"POST", "/v1/meshes/m/redo", "{\"steps\":2}", 200},
        {"PATCH", "/v1/meshes/m", "{\"name\":\"second\"}", 200},
        {"PUT", "/v1/meshes/m/attributes/faces/kind", "{\"type\":\"float\",\"default\":1}", 201},
        {"POST", "/v1/meshes/m/copy", "{\"id\":\"c\"}", 201},
        {"POST", "/v1/meshes/n/edits", "{\"op\":\"append\",\"mesh\":\"m\"}", 200},
        {"POST", "/v1/meshes/n/edits", "{\"op\":\"append\",\"mesh\":\"x\"}", 422},
        {"POST", "/v1/meshes/n/compare", "{\"with\":\"m\"}", 200},
        {"POST", "/v1/meshes/n/compare", "{\"with\":\"x\"}", 422},
        {"POST", "/v1/meshes?id=c", "{\"shape\":\"cube\"}", 409},
        {"PUT", "/v1/meshes/c", "{\"shape\":\"cube\"}", 200},
        {"PUT", "/v1/meshes/d", "{\"shape\":\"cube\"}", 201},
        {"DELETE", "/v1/meshes/c", NULL, 204},
        {"GET", "/v1/meshes/c", NULL, 404},
        {"POST", "/v1/meshes/c/edits", "{\"op\":\"compact\"}", 404},
        {"GET", "/v1/meshes/m/faces/99", NULL, 404},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        b = restart(b);
        bench_done(bench_expect(
            cases[i].status, bench_send(b, cases[i].method, cases[i].target, NULL, cases[i].body)));
    }
    end(b);
}

static void clients_show_themselves_at_a_cold_mesh(void **state)
{
    (void)state;
    static const struct {
        const char *method, *body;
        int status;
        const char *says;
    } cases[] = {
        {"PUT", "{\"client\":\"a\",\"name\":\"A\"}", 200,
         "{\"clients\":[{\"client\":\"a\",\"name\":\"A\"}]}"},
        {"PUT", "{\"client\":\"a\",\"leaves\":true}", 200, "{\"clients\":[]}"},
        {"GET", NULL, 200, "{\"clients\":[]}"},
        {"PUT", "{\"client\":7}", 400, "/client"},
        {"PUT", "{\"client\":", 400, "JSON"},
        {"PUT", NULL, 400, "missing_body"},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        b = restart(b);
        bench_reply r =
            bench_expect(cases[i].status, bench_send(b, cases[i].method, "/v1/meshes/m/presence",
                                                     NULL, cases[i].body));
        if (strstr(r.body, cases[i].says) == NULL) {
            fail_msg("%s: %s", cases[i].body == NULL ? "no body" : cases[i].body, r.body);
        }
        bench_done(r);
    }
    b = restart(b);
    expect_code(404, "no_such_mesh",
                bench_send(b, "PUT", "/v1/meshes/x/presence", NULL, "{\"client\":\"a\"}"));
    end(b);
}

static void octets_of_an_attribute_are_counted_when_the_mesh_is_there(void **state)
{
    (void)state;
    static const char *const octets[] = {"Content-Type", "application/octet-stream", NULL};
    static const struct {
        const char *id;
        size_t rows;
        int status;
    } cases[] = {{"n", 8, 201}, {"n", 7, 422}, {"n", 9, 422}, {"nosuch", 8, 404}};
    static const float rows[9] = {1, 2, 3};
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char target[80];
        snprintf(target, sizeof target, "/v1/meshes/%s/attributes/vertices/a%zu?type=float",
                 cases[i].id, i);
        b = restart(b);
        bench_done(bench_expect(
            cases[i].status,
            bench_send_bytes(b, &(bench_request){"PUT", target, octets, (const char *)rows,
                                                 cases[i].rows * sizeof *rows})));
    }
    end(b);
}

static void preconditions_hold_of_a_cold_mesh(void **state)
{
    (void)state;
    static const char *const stale[] = {"If-Match", "\"1.1\"", NULL};
    static const char *const any[] = {"If-None-Match", "*", NULL};
    api_bench *b = restart(begin());
    bench_done(
        bench_expect(412, bench_send(b, "PUT", "/v1/meshes/m", stale, "{\"shape\":\"cube\"}")));
    b = restart(b);
    bench_done(
        bench_expect(412, bench_send(b, "PUT", "/v1/meshes/m", any, "{\"shape\":\"cube\"}")));
    b = restart(b);
    bench_done(bench_expect(412, bench_send(b, "DELETE", "/v1/meshes/m", stale, NULL)));
    end(b);
}

static void a_list_loads_nothing(void **state)
{
    (void)state;
    api_bench *b = begin();
    b = expect_same_after_restart(b, "/v1/meshes");
    assert_int_equal(kept_journal_facts(journal, "m").opened, 0);
    end(b);
}

static void a_sorted_list_loads_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *target, *ids[2];
    } lists[] = {{"/v1/meshes?sort=name", {"n", "m"}},
                 {"/v1/meshes?sort=bytes", {"m", "n"}},
                 {"/v1/meshes?sort=name&limit=1", {"n", NULL}}};
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        b = expect_same_after_restart(b, lists[i].target);
        bench_reply r = bench_expect(200, bench_get(b, lists[i].target));
        const cJSON *items = cJSON_GetObjectItem(r.json, "items");
        for (int k = 0; k < 2; k++) {
            const cJSON *item = cJSON_GetArrayItem(items, k);
            const char *id = item == NULL ? NULL : cJSON_GetObjectItem(item, "id")->valuestring;
            assert_true(id == NULL ? lists[i].ids[k] == NULL : strcmp(id, lists[i].ids[k]) == 0);
        }
        bench_done(r);
    }
    assert_int_equal(kept_journal_facts(journal, "m").opened, 0);
    end(b);
}

static size_t loads(const char *id)
{
    return kept_journal_facts(journal, id).opened;
}

/* Requires that the answer to HEAD has the headers of the answer to GET, and that HEAD did not load
 * the mesh. */
static void expect_head(api_bench *b, const char *coding, size_t loaded)
{
    const char *const headers[] = {"Accept-Encoding", coding, NULL};
    bench_reply head = bench_expect(200, bench_send(b, "HEAD", "/v1/meshes/m", headers, NULL));
    assert_int_equal(loads("m"), loaded);
    assert_int_equal(head.length, 0);
    bench_reply get = bench_expect(200, bench_send(b, "GET", "/v1/meshes/m", headers, NULL));
    static const char *const same[] = {"ETag", "Content-Type", "Vary", "Cache-Control"};
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        assert_string_not_equal(bench_header(&get, same[i]), "");
        assert_string_equal(bench_header(&head, same[i]), bench_header(&get, same[i]));
    }
    bench_done(head);
    bench_done(get);
}

static void head_of_a_cold_mesh_loads_nothing(void **state)
{
    (void)state;
    api_bench *b = restart(begin());
    expect_head(b, "identity", 0);
    assert_int_equal(loads("m"), 1);
    b = restart(b);
    expect_head(b, "gzip, zstd, br", 1);
    b = restart(b);
    expect_head(b, "*", 2);
    /* If the client accepts only compressed answers, HEAD has to load the mesh, because the length
     * of the compressed answer is needed. */
    b = restart(b);
    const char *const coded[] = {"Accept-Encoding", "gzip, identity;q=0", NULL};
    bench_done(bench_expect(200, bench_send(b, "HEAD", "/v1/meshes/m", coded, NULL)));
    assert_int_equal(loads("m"), 4);
    expect_code(404, "no_such_mesh", bench_send(b, "HEAD", "/v1/meshes/nosuch", NULL, NULL));
    end(b);
}

static void what_the_client_has_of_a_cold_mesh_loads_nothing(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply was = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    char *tag = strdup(bench_header(&was, "ETag"));
    bench_done(was);
    const char *const has[] = {"If-None-Match", tag, "Accept-Encoding", "gzip", NULL};
    b = restart(b);
    bench_reply is = bench_expect(304, bench_send(b, "GET", "/v1/meshes/m", has, NULL));
    assert_string_equal(bench_header(&is, "ETag"), tag);
    bench_done(is);
    assert_int_equal(loads("m"), 0);
    /* If the client has a cached copy of another revision than the one that it requests, it gets
     * the whole answer, for which the mesh must be loaded. */
    bench_done(bench_expect(200, bench_send(b, "GET", "/v1/meshes/m?revision=2", has, NULL)));
    poke(b, "m", 0);
    b = restart(b);
    bench_done(bench_expect(200, bench_send(b, "GET", "/v1/meshes/m", has, NULL)));
    free(tag);
    end(b);
}

static void a_cold_mesh_is_deleted_without_being_loaded(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_reply was = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    char *tag = strdup(bench_header(&was, "ETag"));
    bench_done(was);
    const char *const match[] = {"If-Match", tag, NULL}, *const none[] = {"If-None-Match", tag,
                                                                          NULL};
    b = restart(b);
    bench_done(bench_expect(412, bench_send(b, "DELETE", "/v1/meshes/m", none, NULL)));
    kept_journal_refuse(journal, ST_FAILED);
    expect_code(503, "store_failed", bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL));
    assert_int_equal(loads("m"), 0); /* no request so far has loaded the mesh */
    kept_journal_refuse(journal, ST_FULL);
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", match, NULL)));
    kept_journal_refuse(journal, ST_OK);
    expect_code(404, "no_such_mesh", bench_send(b, "GET", "/v1/meshes/m", NULL, NULL));
    expect_code(404, "no_such_mesh", bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL));
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/n", NULL, NULL)));
    bench_reply list = bench_expect(200, bench_get(b, "/v1/meshes"));
    assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(list.json, "items")), 0);
    bench_done(list);
    b = restart(b);
    /* After the deletion, a new mesh can have the id of the deleted mesh; the entity tags of the
     * two meshes must differ. */
    bench_reply fresh =
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}"));
    assert_string_not_equal(bench_header(&fresh, "ETag"), tag);
    bench_done(fresh);
    bench_done(bench_expect(412, bench_send(b, "DELETE", "/v1/meshes/m", match, NULL)));
    assert_int_equal(kept_journal_out(journal), 0);
    free(tag);
    end(b);
}

static void expect_name(bench_reply r)
{
    assert_string_equal(cJSON_GetObjectItem(r.json, "name")->valuestring, "first");
    bench_done(r);
}

static void a_damaged_mesh_can_only_go(void **state)
{
    (void)state;
    static const char *const reads[] = {"/v1/meshes/m", "/v1/meshes/m/faces/1",
                                        "/v1/meshes/m/content", "/v1/meshes/m/edits",
                                        "/v1/meshes/m/events"};
    for (int round = 0; round < 2; round++) {
        api_bench *b = begin();
        bench_free(b);
        kept_journal_damage(journal, "m", 1, KEPT_CUT, 3);
        b = restart(NULL);
        for (size_t i = 0; i < sizeof reads / sizeof *reads; i++) {
            expect_code(500, "mesh_damaged", bench_send(b, "GET", reads[i], NULL, NULL));
        }
        expect_code(500, "mesh_damaged", bench_send(b, "POST", "/v1/meshes/m/undo", NULL, "{}"));
        expect_code(500, "mesh_damaged",
                    bench_send(b, "PATCH", "/v1/meshes/m", NULL, "{\"name\":\"x\"}"));
        expect_code(500, "mesh_damaged",
                    bench_send(b, "POST", "/v1/meshes/n/edits", NULL,
                               "{\"op\":\"append\",\"mesh\":\"m\"}"));
        bench_done(bench_expect(200, bench_get(b, "/v1/meshes/n")));
        bench_reply list = bench_expect(200, bench_get(b, "/v1/meshes"));
        assert_non_null(strstr(list.body, "\"damage\":\"record 3"));
        bench_done(list);
        if (round == 0) {
            bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
            bench_done(bench_expect(404, bench_get(b, "/v1/meshes/m")));
        } else {
            /* PUT without a name keeps the name of the damaged mesh that it replaces, and the
             * answer shows this name. */
            expect_name(bench_expect(
                201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
            b = restart(b);
            expect_name(bench_expect(200, bench_get(b, "/v1/meshes/m")));
        }
        end(b);
    }
}

static void a_mesh_of_a_newer_release_waits_for_it(void **state)
{
    (void)state;
    api_bench *b = begin();
    bench_free(b);
    kept_journal_damage(journal, "m", 1, KEPT_NEWER, 0);
    b = restart(NULL);
    expect_code(500, "mesh_newer", bench_send(b, "GET", "/v1/meshes/m", NULL, NULL));
    expect_code(500, "mesh_newer", bench_send(b, "POST", "/v1/meshes/m/undo", NULL, "{}"));
    expect_code(
        500, "mesh_newer",
        bench_send(b, "POST", "/v1/meshes/n/edits", NULL, "{\"op\":\"append\",\"mesh\":\"m\"}"));
    bench_reply list = bench_expect(200, bench_get(b, "/v1/meshes"));
    assert_null(strstr(list.body, "\"damage\""));
    bench_done(list);
    bench_free(b);
    kept_journal_damage(journal, "m", 1, KEPT_NEWER, 0);
    b = restart(NULL);
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m/content")));
    end(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_read_is_what_it_was),
        cmocka_unit_test(a_cold_mesh_is_changed_like_any_other),
        cmocka_unit_test(clients_show_themselves_at_a_cold_mesh),
        cmocka_unit_test(octets_of_an_attribute_are_counted_when_the_mesh_is_there),
        cmocka_unit_test(preconditions_hold_of_a_cold_mesh),
        cmocka_unit_test(a_list_loads_nothing),
        cmocka_unit_test(a_sorted_list_loads_nothing),
        cmocka_unit_test(head_of_a_cold_mesh_loads_nothing),
        cmocka_unit_test(what_the_client_has_of_a_cold_mesh_loads_nothing),
        cmocka_unit_test(a_cold_mesh_is_deleted_without_being_loaded),
        cmocka_unit_test(a_damaged_mesh_can_only_go),
        cmocka_unit_test(a_mesh_of_a_newer_release_waits_for_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
