/* A request with an Idempotency-Key is executed only once; each repetition of the request gets the
 * same answer. */
#include "tests/api/request.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static bench_reply keyed(api_bench *b, const char *method, const char *target, const char *key,
                         const char *body)
{
    return bench_send(b, method, target, (const char *const[]){"Idempotency-Key", key, NULL}, body);
}

static void refused(int status, const char *code, bench_reply r)
{
    r = bench_expect(status, r);
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, code);
    bench_reply_free(&r);
}

static int revision(api_bench *b)
{
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    int value = cJSON_GetObjectItem(r.json, "revision")->valueint;
    bench_reply_free(&r);
    return value;
}

/* Creates a mesh with one step to undo and one to redo. */
static api_bench *begin(void)
{
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "POST", "/v1/meshes?id=m", NULL, "{\"shape\":\"cube\"}")));
    for (int face = 2; face < 5; face++) {
        char body[64];
        snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", face);
        bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/edits", NULL, body)));
    }
    bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/undo", NULL, NULL)));
    return b;
}

static char *list_of(api_bench *b)
{
    bench_reply list = bench_expect(200, bench_get(b, "/v1/meshes"));
    char *text = strdup(list.body);
    assert_non_null(text);
    bench_reply_free(&list);
    return text;
}

static const struct {
    const char *method, *target;
    int status;
    const char *body;
} writes[] = {
    {"POST", "/v1/meshes", 201, "{\"shape\":\"cube\"}"},
    {"POST", "/v1/meshes?id=new", 201, "{\"vertices\":[[0,0,0]],\"faces\":[]}"},
    {"POST", "/v1/meshes/m/copy", 201, NULL},
    {"POST", "/v1/meshes/m/copy", 201, "{\"id\":\"c\"}"},
    {"PATCH", "/v1/meshes/m", 200, "{\"name\":\"other\"}"},
    {"POST", "/v1/meshes/m/edits", 200, "{\"op\":\"face_poke\",\"face\":1}"},
    {"POST", "/v1/meshes/m/edits", 200, "{\"expected_revision\":5,\"ops\":[{\"op\":\"compact\"}]}"},
    {"POST", "/v1/meshes/m/edits", 200, "{\"op\":\"face_poke\",\"face\":1,\"dry_run\":true}"},
    {"POST", "/v1/meshes/m/undo", 200, NULL},
    {"POST", "/v1/meshes/m/redo", 200, "{}"},
};

static void a_write_is_done_once_and_answered_twice(void **state)
{
    (void)state;
    static const char *const headers[] = {"ETag", "Location", "Content-Type", "Cache-Control"};
    for (size_t i = 0; i < sizeof writes / sizeof *writes; i++) {
        api_bench *b = begin();
        bench_reply first = bench_expect(
            writes[i].status, keyed(b, writes[i].method, writes[i].target, "k", writes[i].body));
        assert_string_equal(bench_header(&first, "Idempotency-Replayed"), "");
        char *before = list_of(b);
        bench_reply again = bench_expect(
            writes[i].status, keyed(b, writes[i].method, writes[i].target, "k", writes[i].body));
        char *after = list_of(b);
        assert_string_equal(before, after);
        assert_string_equal(bench_header(&again, "Idempotency-Replayed"), "true");
        assert_string_equal(first.body, again.body);
        for (size_t h = 0; h < sizeof headers / sizeof *headers; h++) {
            assert_string_equal(bench_header(&first, headers[h]), bench_header(&again, headers[h]));
        }
        /* Like the first answer, the answer to the repeated request must wait until the change is
         * durable. */
        const st_shown *shown = &api_answer_of(first.exchange)->shown;
        assert_true(shown->position > 0 && shown->incarnation != 0);
        assert_memory_equal(shown, &api_answer_of(again.exchange)->shown, sizeof *shown);
        bench_reply_free(&first);
        bench_reply_free(&again);
        free(before);
        free(after);
        bench_free(b);
    }
}

static void a_key_is_of_one_request(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    api_bench *b = begin();
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke)));
    int now = revision(b);
    refused(422, "idempotency_mismatch",
            keyed(b, "POST", "/v1/meshes/m/edits", "k", "{\"op\":\"face_poke\",\"face\":2}"));
    refused(422, "idempotency_mismatch",
            keyed(b, "POST", "/v1/meshes/m/edits", "k", "{ \"op\":\"face_poke\",\"face\":1}"));
    refused(422, "idempotency_mismatch", keyed(b, "POST", "/v1/meshes/m/undo", "k", NULL));
    refused(422, "idempotency_mismatch",
            bench_send(b, "PATCH", "/v1/meshes/m",
                       (const char *const[]){"Idempotency-Key", "k", NULL}, "{}"));
    assert_int_equal(revision(b), now);
    /* Keys of edits belong to one mesh, and keys of requests that create a mesh belong to the
     * store. So the key "K", and the key "k" for another mesh, are independent of the key "k" for
     * the mesh m. */
    bench_done(bench_expect(
        200, keyed(b, "POST", "/v1/meshes/m/edits", "K", "{\"op\":\"face_poke\",\"face\":2}")));
    bench_done(bench_expect(201, keyed(b, "POST", "/v1/meshes?id=n", "k", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/n/edits", "k", poke)));
    refused(422, "idempotency_mismatch",
            keyed(b, "POST", "/v1/meshes?id=o", "k", "{\"shape\":\"cube\"}"));
    bench_free(b);
}

static void keys_are_short_and_visible(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    char key[258];
    memset(key, 'k', sizeof key);
    key[256] = '\0';
    api_bench *b = begin();
    refused(400, "bad_header", keyed(b, "POST", "/v1/meshes/m/edits", "", poke));
    refused(400, "bad_header", keyed(b, "POST", "/v1/meshes/m/edits", "a b", poke));
    refused(400, "bad_header", keyed(b, "POST", "/v1/meshes/m/edits", "a\x7f", poke));
    refused(400, "bad_header", keyed(b, "POST", "/v1/meshes/m/edits", "\xc3\xa9", poke));
    refused(400, "bad_header", keyed(b, "POST", "/v1/meshes/m/edits", key, poke));
    assert_int_equal(revision(b), 5);
    key[255] = '\0';
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", key, poke)));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "\"a-quoted-one\"",
                                       "{\"op\":\"face_poke\",\"face\":2}")));
    bench_done(bench_expect(200, keyed(b, "GET", "/v1/meshes/m", "", NULL)));
    bench_free(b);
}

static void a_refusal_may_be_tried_again(void **state)
{
    (void)state;
    static const char split[] = "{\"expected_revision\":6,\"op\":\"face_poke\",\"face\":1}";
    api_bench *b = begin();
    bench_done(bench_expect(412, keyed(b, "POST", "/v1/meshes/m/edits", "k", split)));
    bench_done(bench_expect(400, keyed(b, "POST", "/v1/meshes/m/edits", "k", "{")));
    bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/redo", NULL, NULL)));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", split)));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", split)));
    assert_int_equal(revision(b), 7);
    bench_free(b);
}

static void undo_forgets_no_key_and_removal_all(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    api_bench *b = begin();
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke)));
    bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/undo", NULL, NULL)));
    bench_reply r = bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 6);
    bench_reply_free(&r);
    assert_int_equal(revision(b), 7);

    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    bench_done(bench_expect(404, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke)));
    bench_done(
        bench_expect(201, keyed(b, "POST", "/v1/meshes?id=m", "new", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke)));
    assert_int_equal(revision(b), 2);

    /* The mesh was deleted. The request that created it is repeated: it gets its first answer
     * again, and no mesh is created. */
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    r = bench_expect(201, keyed(b, "POST", "/v1/meshes?id=m", "new", "{\"shape\":\"cube\"}"));
    assert_string_equal(bench_header(&r, "Location"), "/v1/meshes/m");
    assert_true(api_answer_of(r.exchange)->shown.position > 0);
    bench_reply_free(&r);
    bench_done(bench_expect(404, bench_get(b, "/v1/meshes/m")));
    bench_free(b);
}

/* The store does not keep a huge answer, only the fact that the request was executed. A repetition
 * of the request is answered without a body. */
static void a_huge_answer_is_given_again_without_its_body(void **state)
{
    (void)state;
    static const char move[] =
        "{\"op\":\"transform\",\"matrix\":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}";
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_send(b, "POST", "/v1/meshes?id=m", NULL,
                                            "{\"shape\":\"grid\",\"columns\":900,\"rows\":800}")));
    bench_reply first = bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", move));
    assert_true(first.length > 4 << 20);
    bench_reply again = bench_expect(204, keyed(b, "POST", "/v1/meshes/m/edits", "k", move));
    assert_string_equal(bench_header(&again, "ETag"), bench_header(&first, "ETag"));
    assert_string_equal(bench_header(&again, "Idempotency-Replayed"), "true");
    assert_int_equal(revision(b), 2);
    bench_reply_free(&first);
    bench_reply_free(&again);
    bench_free(b);
}

static bench_reply keyed_job(api_bench *b, const char *body)
{
    return bench_send(
        b, "POST", "/v1/meshes/m/edits",
        (const char *const[]){"Idempotency-Key", "k", "Prefer", "respond-async", NULL}, body);
}

static void a_key_is_busy_while_its_job_is_and_then_gives_its_answer(void **state)
{
    (void)state;
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    api_bench *b = begin();
    bench_reply job = bench_expect(202, keyed_job(b, poke));
    refused(409, "idempotency_in_progress", keyed(b, "POST", "/v1/meshes/m/edits", "k", poke));
    refused(409, "idempotency_in_progress", keyed_job(b, poke));
    refused(422, "idempotency_mismatch", keyed(b, "POST", "/v1/meshes/m/undo", "k", NULL));
    bench_run_jobs(b, 1);
    bench_reply kept = bench_expect(200, bench_get(b, bench_header(&job, "Location")));
    bench_reply again = bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke));
    assert_string_equal(bench_header(&again, "Idempotency-Replayed"), "true");
    assert_true(cJSON_Compare(cJSON_GetObjectItem(kept.json, "result"), again.json, true));
    bench_done(bench_expect(200, keyed_job(b, poke)));
    assert_int_equal(revision(b), 6);
    bench_reply_free(&job);
    bench_reply_free(&kept);
    bench_reply_free(&again);
    bench_free(b);
}

static void a_job_that_came_to_nothing_gives_its_key_back(void **state)
{
    (void)state;
    static const char wrong[] = "{\"op\":\"face_poke\",\"face\":99}";
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    api_bench *b = begin();
    bench_done(bench_expect(202, keyed_job(b, wrong)));
    bench_run_jobs(b, 1);
    bench_reply job = bench_expect(202, keyed_job(b, poke));
    bench_done(
        bench_expect(202, bench_send(b, "DELETE", bench_header(&job, "Location"), NULL, NULL)));
    bench_reply_free(&job);
    bench_run_jobs(b, 1);
    bench_limit_jobs(b, 0);
    refused(503, "too_many_jobs", keyed_job(b, poke));
    bench_done(bench_expect(200, keyed(b, "POST", "/v1/meshes/m/edits", "k", poke)));
    assert_int_equal(revision(b), 6);
    /* A mesh may be deleted, together with its idempotency keys, while a job still uses one of the
     * keys. */
    bench_limit_jobs(b, 1);
    bench_done(bench_expect(202, bench_send(b, "POST", "/v1/meshes/m/edits",
                                            (const char *const[]){"Idempotency-Key", "other",
                                                                  "Prefer", "respond-async", NULL},
                                            "{\"op\":\"face_poke\",\"face\":5}")));
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    bench_run_jobs(b, 1);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_write_is_done_once_and_answered_twice),
        cmocka_unit_test(a_key_is_of_one_request),
        cmocka_unit_test(keys_are_short_and_visible),
        cmocka_unit_test(a_refusal_may_be_tried_again),
        cmocka_unit_test(undo_forgets_no_key_and_removal_all),
        cmocka_unit_test(a_huge_answer_is_given_again_without_its_body),
        cmocka_unit_test(a_key_is_busy_while_its_job_is_and_then_gives_its_answer),
        cmocka_unit_test(a_job_that_came_to_nothing_gives_its_key_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
