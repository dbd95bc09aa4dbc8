/* Previews of deformations: their answers agree with the edit, whether the system of equations is
 * new or kept. */
#include "tests/api/request.h"

#include "base/mem.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char DEFORM[] = "/v1/meshes/m/deform", EDITS[] = "/v1/meshes/m/edits";
static const char SPHERE[] = "{\"shape\":\"icosphere\",\"subdivisions\":2}";
enum { VERTICES = 162, BYTES = 28 };

static api_bench *begin(void)
{
    api_bench *b = bench_new();
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, SPHERE)));
    return b;
}

/* Returns the positions of all vertices of the mesh; the caller frees the reply. */
static bench_reply positions(api_bench *b)
{
    static const char *const octets[] = {"Accept", "application/octet-stream", NULL};
    return bench_expect(
        200, bench_send(b, "GET", "/v1/meshes/m/attributes/vertices/position", octets, NULL));
}

/* Sends a preview and then the edit, requires that the preview has changed nothing and has foretold
 * the positions in every bit, and undoes the edit. Returns the number of vertices in the answer. */
static size_t require_same(api_bench *b, const char *body)
{
    bench_reply before = positions(b);
    bench_reply r = bench_expect(200, bench_post(b, DEFORM, body));
    assert_string_equal(bench_header(&r, "Content-Type"), "application/octet-stream");
    assert_int_equal(r.length % BYTES, 0);
    const size_t count = r.length / BYTES;
    bench_reply after = positions(b);
    assert_memory_equal(before.body, after.body, before.length);
    bench_reply_free(&after);
    bench_done(bench_expect(200, bench_post(b, EDITS, body)));
    after = positions(b);
    bool listed[VERTICES] = {false};
    for (size_t i = 0; i < count; i++) {
        uint32_t id;
        memcpy(&id, r.body + 24 * count + 4 * i, sizeof id);
        assert_true(id < VERTICES && !listed[id]);
        listed[id] = true;
        assert_memory_equal(r.body + 24 * i, after.body + 24 * (size_t)id, 24);
    }
    for (size_t id = 0; id < VERTICES; id++) {
        if (!listed[id]) {
            assert_memory_equal(before.body + 24 * id, after.body + 24 * id, 24);
        }
    }
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", "")));
    bench_reply_free(&before);
    bench_reply_free(&after);
    bench_reply_free(&r);
    return count;
}

static void a_preview_is_compressed_only_if_it_must(void **state)
{
    (void)state;
    static const char BODY[] = "{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,0.5]}";
    static const struct {
        const char *accept, *coding;
    } cases[] = {{"gzip, deflate", ""}, {"zstd, gzip", ""}, {"gzip, identity;q=0", "gzip"}};
    api_bench *b = begin();
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/fine", NULL,
                                            "{\"shape\":\"icosphere\",\"subdivisions\":3}")));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench_reply r = bench_expect(
            200, bench_send(b, "POST", "/v1/meshes/fine/deform",
                            (const char *const[]){"Accept-Encoding", cases[i].accept, NULL}, BODY));
        const char *coding = bench_header(&r, "Content-Encoding");
        assert_string_equal(coding, cases[i].coding);
        assert_true(cases[i].coding[0] != '\0' || r.length == 642 * BYTES);
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void a_preview_foretells_the_edit(void **state)
{
    (void)state;
    api_bench *b = begin();
    static const struct {
        const char *body;
        size_t count;
    } cases[] = {
        {"{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,0.5]}", VERTICES},
        {"{\"op\":\"deform\",\"vertices\":[3,1],\"to\":[[0,0,2],[1,0,2]],\"fixed\":[7,8,9]}",
         VERTICES - 3},
        {"{\"op\":\"deform\",\"vertices\":[3,1],\"fixed_vertex\":9,\"method\":\"biharmonic\","
         "\"matrix\":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]}",
         VERTICES - 1},
        {"{\"op\":\"deform\",\"vertices\":{\"selected\":true},\"by\":[0.1,0,0],\"steps\":2}",
         VERTICES},
    };
    bench_done(bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m/attributes/vertices/selected",
                                            NULL, "{\"type\":\"bool\"}")));
    bench_done(bench_expect(200, bench_send(b, "PATCH", "/v1/meshes/m/attributes/vertices/selected",
                                            NULL, "{\"ids\":[4,5],\"value\":true}")));
    /* The second round repeats each preview at a later revision, and after previews of other
     * sets. */
    for (int round = 0; round < 2; round++) {
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            assert_int_equal(require_same(b, cases[i].body), cases[i].count);
        }
    }
    bench_free(b);
}

/* Drags a handle: the same sets with other goals, whose system of equations is kept, then a mesh
 * that has changed. */
static void a_kept_system_answers_like_a_new_one(void **state)
{
    (void)state;
    api_bench *b = begin();
    char body[200];
    bench_reply kept[5];
    for (int i = 0; i < 5; i++) {
        (void)snprintf(body, sizeof body,
                       "{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,%g],\"fixed\":[20,21,22]}",
                       0.1 * i);
        kept[i] = bench_expect(200, bench_post(b, DEFORM, body));
    }
    for (int i = 0; i < 5; i++) {
        api_bench *other = begin();
        (void)snprintf(body, sizeof body,
                       "{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,%g],\"fixed\":[20,21,22]}",
                       0.1 * i);
        bench_reply r = bench_expect(200, bench_post(other, DEFORM, body));
        assert_int_equal(r.length, kept[i].length);
        assert_memory_equal(r.body, kept[i].body, r.length);
        bench_reply_free(&r);
        bench_free(other);
    }
    bench_done(bench_expect(
        200, bench_post(b, EDITS, "{\"op\":\"vertex_move\",\"vertex\":50,\"by\":[0.2,0.2,0.2]}")));
    bench_reply changed = bench_expect(200, bench_post(b, DEFORM, body));
    assert_int_equal(changed.length, kept[4].length);
    assert_memory_not_equal(changed.body, kept[4].body, changed.length);
    bench_reply_free(&changed);
    (void)require_same(b, body);
    for (int i = 0; i < 5; i++) {
        bench_reply_free(&kept[i]);
    }
    bench_free(b);
}

static void bad_previews_are_refused_by_name(void **state)
{
    (void)state;
    api_bench *b = begin();
    static const struct {
        const char *body;
        int status;
        const char *code;
    } cases[] = {
        {"{\"op\":\"smooth\"}", 400, "bad_value"},
        {"{\"vertex\":0,\"by\":[0,0,1]}", 400, "missing_member"},
        {"{\"op\":\"deform\",\"vertex\":0}", 400, "missing_member"},
        {"{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,1],\"to\":[0,0,1]}", 400,
         "conflicting_members"},
        {"{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,1],\"steps\":0}", 400, "bad_value"},
        {"{\"op\":\"deform\",\"vertex\":0,\"by\":[0,0,1],\"steps\":2,\"method\":\"biharmonic\"}",
         400, "conflicting_members"},
        {"{\"op\":\"deform\",\"vertices\":[0,1],\"to\":[[0,0,1],[0,0,2],[0,0,3]],"
         "\"fixed\":[4,5,6]}",
         400, "bad_value"},
        {"{\"op\":\"deform\",\"vertices\":{\"selected\":true},\"by\":[0,0,1]}", 422,
         "no_such_attribute"},
        {"{\"op\":\"deform\",\"vertex\":400,\"by\":[0,0,1]}", 422, "no_such_element"},
        {"{\"op\":\"deform\",\"vertices\":[1,2,1],\"by\":[0,0,1]}", 422, "repeated_element"},
        {"{\"op\":\"deform\",\"vertices\":[1,2],\"by\":[0,0,1],\"fixed\":[2]}", 422,
         "repeated_element"},
        {"{\"op\":\"deform\",\"vertices\":[0,1,2,3,4,5,6,7,8,9,10,11],"
         "\"matrix\":[1.7e308,0,0,1.7e308,0,1.7e308,0,1.7e308,0,0,1.7e308,0,0,0,0,1]}",
         400, "not_finite"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench_reply r = bench_post(b, DEFORM, cases[i].body);
        if (r.status != cases[i].status || strcmp(bench_text(&r, "code"), cases[i].code) != 0) {
            fail_msg("%s: %d %s", cases[i].body, r.status, r.body);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char body[] =
        "{\"op\":\"deform\",\"vertices\":[0,1],\"by\":[0,0,0.5],\"fixed\":[9],\"steps\":1}";
    const bench_request request = {"POST", DEFORM, NULL, body, sizeof body - 1};
    failing f = {.what = DEFORM};
    while (failing_next(&f)) {
        failing_pause();
        api_bench *b = begin();
        failing_resume();
        bench_reply r;
        const bool sent = bench_try(b, &request, &r);
        const bool done = sent && r.status == 200;
        failing_end(&f, done);
        if (sent) {
            assert_true(done || r.status == 507);
            bench_reply_free(&r);
        }
        bench_free(b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_preview_foretells_the_edit),
        cmocka_unit_test(a_preview_is_compressed_only_if_it_must),
        cmocka_unit_test(a_kept_system_answers_like_a_new_one),
        cmocka_unit_test(bad_previews_are_refused_by_name),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("deform", tests, NULL, NULL);
}
