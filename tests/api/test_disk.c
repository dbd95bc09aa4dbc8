/* What a client is told of a disk that is full or failed, and of changes that were lost for it. */
#include "tests/api/request.h"
#include "store/write.h"
#include "tests/slow_journal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static slow_journal journal;

/* With the meshes m and n, of which all is durable. */
static api_bench *begin(void)
{
    const st_journal kept = slow_journal_open_keeping(&journal);
    api_bench *b = bench_new_over(&kept);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=n", "{\"shape\":\"cube\"}")));
    slow_journal_advance(&journal, 2);
    return b;
}

static const char *text_of(const bench_reply *r, const char *member)
{
    const cJSON *value = cJSON_GetObjectItem(r->json, member);
    assert_true(cJSON_IsString(value));
    return value->valuestring;
}

static void lose_newest(st_status why)
{
    const uint64_t newest = slow_journal_newest(&journal);
    const st_loss loss = {.from = newest, .to = newest, .status = why, .reason = "the disk"};
    slow_journal_lose(&journal, &loss);
    slow_journal_advance(&journal, newest);
}

/* --- the mesh is lost when a write begins --- */

/* What becomes of the newest change right before the next write begins; ST_OK: nothing. The linker
 * gives calls of this function to the wrapper (Makefile). */
static st_status loss_before;

st_status __real_st_write_begin(st_mesh *mesh, const st_keyed *keyed, st_write *out);
st_status __wrap_st_write_begin(st_mesh *mesh, const st_keyed *keyed, st_write *out);

st_status __wrap_st_write_begin(st_mesh *mesh, const st_keyed *keyed, st_write *out)
{
    if (loss_before != ST_OK) {
        lose_newest(loss_before);
        loss_before = ST_OK;
    }
    return __real_st_write_begin(mesh, keyed, out);
}

static void a_write_to_what_was_lost_is_refused_as_the_disk_is(void **state)
{
    (void)state;
    static const struct {
        st_status loss, disk;
        int status;
        const char *code, *retry;
    } cases[] = {{ST_FULL, ST_FULL, 507, "store_full", ""},
                 {ST_FAILED, ST_FAILED, 503, "store_failed", "1"},
                 /* There is space again: the same request finds the mesh as it was kept. */
                 {ST_FULL, ST_OK, 503, "store_lost", "0"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_bench *b = begin();
        bench_done(bench_send(b, "PATCH", "/v1/meshes/m", NULL, "{\"name\":\"x\"}"));
        loss_before = cases[i].loss;
        journal.refuse = cases[i].disk;
        bench_reply r = bench_expect(
            cases[i].status, bench_send(b, "PATCH", "/v1/meshes/m", NULL, "{\"name\":\"y\"}"));
        assert_string_equal(text_of(&r, "code"), cases[i].code);
        assert_string_equal(bench_header(&r, "Retry-After"), cases[i].retry);
        /* It waits for nothing, and so is never taken for a change that was lost. */
        assert_int_equal(api_answer_of(r.exchange)->shown.position, 0);
        bench_reply_free(&r);
        bench_free(b);
    }
}

/* --- readiness --- */

static void readiness_tells_how_the_disk_is(void **state)
{
    (void)state;
    static const struct {
        st_status disk;
        int status;
        const char *member, *text;
    } cases[] = {{ST_OK, 200, "store", "writable"},
                 {ST_FULL, 200, "store", "full"},
                 {ST_FAILED, 503, "code", "store_failed"},
                 {ST_OK, 200, "status", "ready"}};
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        journal.refuse = cases[i].disk;
        bench_reply r = bench_expect(cases[i].status, bench_get(b, "/readyz"));
        assert_string_equal(text_of(&r, cases[i].member), cases[i].text);
        bench_reply_free(&r);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_write_to_what_was_lost_is_refused_as_the_disk_is),
        cmocka_unit_test(readiness_tells_how_the_disk_is),
    };
    return cmocka_run_group_tests_name("disk", tests, NULL, NULL);
}
