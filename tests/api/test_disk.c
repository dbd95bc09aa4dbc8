/* What the API answers when the disk is full or has failed, and when changes that a client has seen
 * were lost. */
#include "tests/api/request.h"
#include "store/table.h"
#include "store/write.h"
#include "tests/slow_journal.h"

#include "api/limits.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static slow_journal journal;

/* Creates the meshes m and n, whose changes are all durable. */
static api_bench *begin(void)
{
    const st_journal kept = slow_journal_open_keeping(&journal);
    api_bench *b = bench_new_over(&kept);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=n", "{\"shape\":\"cube\"}")));
    slow_journal_advance(&journal, 2);
    return b;
}

static void lose_newest(st_status why)
{
    const uint64_t newest = slow_journal_newest(&journal);
    const st_loss loss = {.from = newest, .to = newest, .status = why, .reason = "the disk"};
    slow_journal_lose(&journal, &loss);
    slow_journal_advance(&journal, newest);
}

/* --- changes of the mesh are lost before a write begins --- */

/* If not ST_OK, the newest change is lost right before the next write begins, with this status as
 * the reason. The linker replaces calls of st_write_begin by calls of the wrapper in this file (see
 * the Makefile), in which the journal reports the loss. */
static st_status loss_before;

st_status __real_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);
st_status __wrap_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out);

st_status __wrap_st_write_begin(st_mesh *mesh, const st_cause *cause, st_write *out)
{
    if (loss_before != ST_OK) {
        lose_newest(loss_before);
        loss_before = ST_OK;
    }
    return __real_st_write_begin(mesh, cause, out);
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
                 /* The change was lost because the disk was full, but now there is space again. A
                  * client that repeats the request finds the mesh in its last durable state. */
                 {ST_FULL, ST_OK, 503, "store_lost", "0"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_bench *b = begin();
        bench_done(bench_send(b, "PATCH", "/v1/meshes/m", NULL, "{\"name\":\"x\"}"));
        loss_before = cases[i].loss;
        journal.refuse = cases[i].disk;
        bench_reply r = bench_expect(
            cases[i].status, bench_send(b, "PATCH", "/v1/meshes/m", NULL, "{\"name\":\"y\"}"));
        assert_string_equal(bench_text(&r, "code"), cases[i].code);
        assert_string_equal(bench_header(&r, "Retry-After"), cases[i].retry);
        /* The refusal is sent without waiting for the disk. If it waited, the service might notice
         * the lost change meanwhile and send another refusal. */
        assert_int_equal(api_answer_of(r.exchange)->shown.position, 0);
        bench_reply_free(&r);
        bench_free(b);
    }
}

/* --- changes are lost between reading a mesh and committing the result --- */

/* If not ST_OK, the newest change is lost right before the next commit, with this status as the
 * reason. */
static st_status loss_between;

st_status __real_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out);
st_status __wrap_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out);
st_status __real_st_write_commit(st_write *w, const char *ops);
st_status __wrap_st_write_commit(st_write *w, const char *ops);

static void lose_between(void)
{
    if (loss_between != ST_OK) {
        lose_newest(loss_between);
        loss_between = ST_OK;
    }
}

st_status __wrap_st_create_from(st_store *store, const st_new_mesh *made, he_mesh *content,
                                st_mesh **out)
{
    lose_between();
    return __real_st_create_from(store, made, content, out);
}

st_status __wrap_st_write_commit(st_write *w, const char *ops)
{
    lose_between();
    return __real_st_write_commit(w, ops);
}

/* When the copy is made, the disk works again. So the only possible reason to refuse the copy is
 * that changes of the copied mesh were lost. */
static void what_was_lost_is_not_copied_or_appended(void **state)
{
    (void)state;
    static const struct {
        const char *target, *body;
    } cases[] = {{"/v1/meshes/n/copy", "{\"id\":\"c\"}"},
                 {"/v1/meshes/m/edits", "{\"op\":\"append\",\"mesh\":\"n\"}"},
                 {"/v1/meshes/m/edits", "{\"ops\":[{\"op\":\"append\",\"mesh\":\"n\"}]}"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_bench *b = begin();
        bench_done(bench_expect(
            200, bench_post(b, "/v1/meshes/n/edits", "{\"op\":\"face_poke\",\"face\":0}")));
        const uint64_t groups = journal.groups;
        loss_between = ST_FULL;
        bench_reply r = bench_expect(503, bench_post(b, cases[i].target, cases[i].body));
        assert_string_equal(bench_text(&r, "code"), "store_lost");
        assert_string_equal(bench_header(&r, "Retry-After"), "0");
        bench_reply_free(&r);
        assert_true(journal.groups == groups);
        bench_done(bench_expect(404, bench_get(b, "/v1/meshes/c")));
        r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
        assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
        bench_reply_free(&r);
        bench_free(b);
    }
}

static void a_change_that_is_too_large_to_be_kept_names_the_limit(void **state)
{
    (void)state;
    api_bench *b = begin();
    journal.refuse = ST_TOO_LARGE;
    bench_reply r =
        bench_expect(413, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}"));
    assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
    assert_non_null(strstr(bench_text(&r, "detail"), "900000000 bytes"));
    bench_reply_free(&r);
    journal.refuse = ST_OK;
    r = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_reply_free(&r);
    bench_free(b);
}

/* --- a list of operations with many changes --- */

static api_bench *staging_for;

/* Called while an edit that is a list of operations is being written to the disk. The edited mesh
 * must still be readable in its old state, and another mesh must be writable. */
static void look_and_write(void)
{
    bench_reply r = bench_expect(200, bench_get(staging_for, "/v1/meshes/m"));
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 1);
    bench_reply_free(&r);
    bench_done(bench_expect(
        200, bench_post(staging_for, "/v1/meshes/n/edits", "{\"op\":\"face_poke\",\"face\":0}")));
    bench_done(bench_expect(
        409, bench_post(staging_for, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}")));
}

static void splits(api_bench *b, size_t count)
{
    static const char op[] = "{\"op\":\"edge_split\",\"edge\":0},";
    static const char head[] = "{\"ops\":[";
    char *body = malloc(count * sizeof op + sizeof head + 3);
    assert_non_null(body);
    size_t length = sizeof head - 1;
    memcpy(body, head, length);
    for (size_t i = 0; i < count; i++) {
        memcpy(body + length, op, sizeof op - 1);
        length += sizeof op - 1;
    }
    memcpy(body + length - 1, "]}", 3);
    const uint64_t groups = journal.groups;
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/edits", body)));
    assert_int_equal(journal.groups, groups + (journal.staging == NULL ? 1 : 2));
    free(body);
}

static void a_long_list_keeps_no_reader_and_no_writer_of_another_mesh(void **state)
{
    (void)state;
    api_bench *b = begin();
    slow_journal_advance(&journal, UINT64_MAX);
    staging_for = b;
    journal.staging = look_and_write;
    splits(b, API_MAX_OPS);
    assert_int_equal(journal.staged_edits, 1);
    assert_true(journal.record.staged_edit && journal.record.body == NULL);
    bench_free(b);
}

static void a_short_list_takes_the_lock_until_it_turns_out_to_change_much(void **state)
{
    (void)state;
    api_bench *b = begin();
    slow_journal_advance(&journal, UINT64_MAX);
    splits(b, 100);
    assert_int_equal(journal.staged_edits, 0);
    staging_for = b;
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    /* A list of API_CLAIM_EDITS operations changes so many elements that the edit needs the
     * exclusive right to write the mesh (a claim), whether it runs on a worker or as a job. */
    splits(b, API_CLAIM_EDITS);
    assert_int_equal(journal.staged_edits, 1);
    bench_free(b);
}

/* --- a large attribute --- */

static void a_large_attribute_keeps_no_reader_and_no_writer_of_another_mesh(void **state)
{
    (void)state;
    enum { SIDE = 400, ROWS = (SIDE + 1) * (SIDE + 1) };
    static const char path[] = "/v1/meshes/m/attributes/vertices/a";
    static double values[ROWS];
    char body[80];
    api_bench *b = begin();
    slow_journal_advance(&journal, UINT64_MAX);
    /* A change of an attribute is encoded for the journal. For a small mesh this happens while the
     * mesh is locked; for a large mesh it happens before the mesh is locked, which is called
     * staging. */
    bench_done(bench_expect(201, bench_send(b, "PUT", path, NULL, "{\"type\":\"double\"}")));
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    (void)snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", SIDE,
                   SIDE);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", body)));
    assert_int_equal(journal.staged_edits, 0);
    staging_for = b;
    journal.staging = look_and_write;
    values[0] = 1;
    const char *const octets[] = {"Content-Type", "application/octet-stream", NULL};
    bench_done(bench_expect(
        201, bench_send_bytes(b, &(bench_request){"PUT",
                                                  "/v1/meshes/m/attributes/vertices/a?type=double",
                                                  octets, (const char *)values, sizeof values})));
    assert_int_equal(journal.staged_edits, 1);
    assert_true(journal.record.staged_edit && journal.record.body == NULL);
    journal.staging = NULL;
    /* The next edits set one value for all vertices. The first of them is a dry run, for which no
     * data may be written to the disk in advance. */
    bench_done(bench_expect(200, bench_send(b, "PUT", path, NULL,
                                            "{\"type\":\"double\",\"value\":2,\"dry_run\":true}")));
    assert_int_equal(journal.staged_edits, 1);
    bench_done(
        bench_expect(200, bench_send(b, "PUT", path, NULL, "{\"type\":\"double\",\"value\":2}")));
    assert_int_equal(journal.staged_edits, 2);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/undo", NULL)));
    bench_reply r = bench_expect(200, bench_get(b, "/v1/meshes/m/attributes/vertices/a?ids=0,1"));
    assert_non_null(strstr(r.body, "\"values\":[1,0]"));
    bench_reply_free(&r);
    /* A wrong number of values is refused for a large mesh, too. */
    bench_done(bench_expect(
        422,
        bench_send_bytes(b, &(bench_request){"PUT", "/v1/meshes/m/attributes/edges/b?type=double",
                                             octets, (const char *)values, sizeof values})));
    bench_free(b);
}

/* --- an answer that waits until its change is durable --- */

/* The answers to the writes are not sent until the changes are on the disk. Once they are, the
 * meshes can be evicted from memory, even if the answers have not been sent yet. */
static void a_mesh_can_be_evicted_while_the_answer_that_made_it_waits(void **state)
{
    (void)state;
    enum { MIB = 1 << 20 };
    api_bench *b = begin();
    st_store_measures measures;
    bench_reply made = bench_expect(201, bench_post(b, "/v1/meshes?id=o", "{\"shape\":\"cube\"}"));
    bench_reply edited =
        bench_expect(200, bench_post(b, "/v1/meshes/m/edits", "{\"op\":\"face_poke\",\"face\":0}"));
    st_memory_set_budget(MIB);
    st_memory_count(MIB);
    st_make_room(bench_store(b), 1);
    st_store_measure(bench_store(b), &measures);
    /* meshes with changes that are not on the disk yet stay in memory */
    assert_int_equal(measures.meshes_in_memory, 2);
    slow_journal_advance(&journal, slow_journal_newest(&journal));
    st_make_room(bench_store(b), 1);
    st_store_measure(bench_store(b), &measures);
    assert_int_equal(measures.meshes_in_memory, 0);
    st_memory_count(-MIB);
    st_memory_set_budget(0);
    bench_reply_free(&made);
    bench_reply_free(&edited);
    bench_free(b);
}

/* --- readiness of the service --- */

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
        assert_string_equal(bench_text(&r, cases[i].member), cases[i].text);
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* Requires that the page of metrics has the line `line`. */
static void expect_metric(const bench_reply *page, const char *line)
{
    char whole[120];
    snprintf(whole, sizeof whole, "\n%s\n", line);
    if (strstr(page->body, whole) == NULL) {
        fail_msg("the page has no line %s", line);
    }
}

static void metrics_tell_how_the_disk_is(void **state)
{
    (void)state;
    api_bench *b = begin();
    journal.refuse = ST_FULL;
    journal.fulls = 2;
    journal.measures = (st_journal_measures){
        .checkpoints = {.buckets = {3}}, .behind = 4, .lost = 5, .queued = 6, .most_queued = 7};
    bench_reply page = bench_expect(200, bench_get(b, "/metrics"));
    expect_metric(&page, "hedge_store_state{state=\"writable\"} 0");
    expect_metric(&page, "hedge_store_state{state=\"full\"} 1");
    expect_metric(&page, "hedge_store_disk_full_total 2");
    expect_metric(&page, "hedge_store_checkpoint_duration_seconds_count 3");
    expect_metric(&page, "hedge_store_records_pending 4");
    expect_metric(&page, "hedge_store_records_lost_total 5");
    expect_metric(&page, "hedge_store_queue_bytes 6");
    expect_metric(&page, "hedge_store_queue_limit_bytes 7");
    bench_done(page);
    journal.refuse = ST_FAILED;
    page = bench_expect(200, bench_get(b, "/metrics"));
    expect_metric(&page, "hedge_store_state{state=\"full\"} 0");
    expect_metric(&page, "hedge_store_state{state=\"failed\"} 1");
    bench_done(page);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_write_to_what_was_lost_is_refused_as_the_disk_is),
        cmocka_unit_test(what_was_lost_is_not_copied_or_appended),
        cmocka_unit_test(a_change_that_is_too_large_to_be_kept_names_the_limit),
        cmocka_unit_test(a_long_list_keeps_no_reader_and_no_writer_of_another_mesh),
        cmocka_unit_test(a_short_list_takes_the_lock_until_it_turns_out_to_change_much),
        cmocka_unit_test(a_large_attribute_keeps_no_reader_and_no_writer_of_another_mesh),
        cmocka_unit_test(a_mesh_can_be_evicted_while_the_answer_that_made_it_waits),
        cmocka_unit_test(readiness_tells_how_the_disk_is),
        cmocka_unit_test(metrics_tell_how_the_disk_is),
    };
    return cmocka_run_group_tests_name("disk", tests, NULL, NULL);
}
