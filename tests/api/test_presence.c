/* What clients show of themselves to the other clients of a mesh. The test sets the time of the
 * clock. */
#include "tests/api/stream.h"

#include "api/limits.h"
#include "api/presence/presences.h"
#include "tests/failing.h"
#include "tests/kept_journal.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* The SHA-256 hashes of the tokens "test" and "prueba". */
#define TEST   "sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"
#define PRUEBA "sha256:655e786674d9d3e77bc05ed1de37b4b6bc89f788829f9f3c679e7687b410c89b"

static uint64_t clock_now = 5000000;

uint64_t __wrap_st_clock_micros(void);
uint64_t __wrap_st_clock_micros(void)
{
    return clock_now;
}

/* How often an event `presence` was written. */
static unsigned news_written;

void __real_api_record_write(api_out *out, const api_record *record, const void *value);
void __wrap_api_record_write(api_out *out, const api_record *record, const void *value);
void __wrap_api_record_write(api_out *out, const api_record *record, const void *value)
{
    news_written += record == &api_presence_news_record;
    __real_api_record_write(out, record, value);
}

static const char PATH[] = "/v1/meshes/m/presence";
static const char EVENTS[] = "/v1/meshes/m/events";

/* Lets time pass, and does what is then due. Returns the time at which something will be due. */
static uint64_t pass(api_bench *b, uint64_t micros)
{
    clock_now += micros;
    return api_presences_work(api_service_presences(bench_service(b)), clock_now);
}

static api_bench *begin(void)
{
    api_bench *b = bench_new();
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    return b;
}

static bench_reply put(api_bench *b, const char *body)
{
    return bench_send(b, "PUT", PATH, NULL, body);
}

static void show(api_bench *b, const char *client, unsigned face)
{
    char body[200];
    snprintf(body, sizeof body,
             "{\"client\":\"%s\",\"name\":\"N\",\"selection\":{\"kind\":\"face\",\"ids\":[%u]}}",
             client, face);
    bench_done(bench_expect(200, put(b, body)));
}

/* Requires that the next event is a presence: `clients` are the ids of those that are there, and
 * `faces` those that the changed ones have selected, each with a comma. */
static void expect_news(listener *l, const char *clients, const char *faces)
{
    char ids[400] = "", selected[400] = "";
    const cJSON *item;
    assert_string_equal(stream_next(l, false), "presence");
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(l->data, "clients"))
    {
        snprintf(ids + strlen(ids), sizeof ids - strlen(ids), "%s,", item->valuestring);
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(l->data, "changed"))
    {
        const cJSON *list = cJSON_GetObjectItem(cJSON_GetObjectItem(item, "selection"), "ids");
        snprintf(selected + strlen(selected), 20, "%d,", cJSON_GetArrayItem(list, 0)->valueint);
    }
    assert_string_equal(ids, clients);
    assert_string_equal(selected, faces);
}

static void expect_none(listener *l)
{
    assert_string_equal(stream_next(l, false), "");
}

static void listeners_are_told_ten_times_a_second_at_most(void **state)
{
    (void)state;
    api_bench *b = begin();
    listener *l = stream_open(b, EVENTS, "", NULL);
    expect_none(l);
    show(b, "ada", 1);
    expect_news(l, "ada,", "1,");
    for (unsigned i = 0; i < 50; i++) {
        clock_now += API_PRESENCE_MICROS / 60;
        show(b, i % 2 == 0 ? "ada" : "bob", i % 6);
        assert_true(pass(b, 0) > clock_now);
        expect_none(l);
    }
    (void)pass(b, API_PRESENCE_MICROS / 5);
    expect_news(l, "ada,bob,", "0,1,");
    expect_none(l);
    /* What does not change is not told again. */
    (void)pass(b, API_PRESENCE_MICROS);
    show(b, "bob", 1);
    (void)pass(b, API_PRESENCE_MICROS);
    expect_none(l);
    show(b, "bob", 2);
    expect_news(l, "ada,bob,", "2,");
    /* A listener that begins now is told of all, one that was slow of the newest state only. */
    listener *late = stream_open(b, EVENTS, "", NULL);
    expect_news(late, "ada,bob,", "0,2,");
    for (unsigned i = 0; i < 5; i++) {
        (void)pass(b, API_PRESENCE_MICROS);
        show(b, "ada", i);
    }
    expect_news(late, "ada,bob,", "4,");
    expect_none(late);
    stream_close(late);
    stream_close(l);
    bench_free(b);
}

static void a_client_is_forgotten_after_half_a_minute_or_when_it_leaves(void **state)
{
    (void)state;
    const uint64_t patience = (uint64_t)API_PRESENCE_SECONDS * 1000000;
    api_bench *b = begin();
    listener *l = stream_open(b, EVENTS, "", NULL);
    show(b, "ada", 1);
    show(b, "bob", 2);
    (void)pass(b, API_PRESENCE_MICROS);
    (void)stream_next(l, false);
    expect_none(l);
    (void)pass(b, patience / 2);
    show(b, "bob", 2);
    const uint64_t next = pass(b, patience / 2 - API_PRESENCE_MICROS - 1);
    assert_int_equal(next, clock_now + 1);
    expect_none(l);
    (void)pass(b, 1);
    expect_news(l, "bob,", "");
    bench_done(bench_expect(200, put(b, "{\"client\":\"bob\",\"leaves\":true}")));
    (void)pass(b, API_PRESENCE_MICROS);
    expect_news(l, "", "");
    assert_int_equal(api_presences_count(api_service_presences(bench_service(b))), 0);
    assert_true(pass(b, API_PRESENCE_MICROS) == UINT64_MAX);
    expect_none(l);
    stream_close(l);
    bench_free(b);
}

static void listeners_that_have_seen_the_same_get_one_text(void **state)
{
    (void)state;
    enum { LISTENERS = 30 };
    api_bench *b = bench_new();
    api_presences *p = api_service_presences(bench_service(b));
    const st_mesh_info mesh = {.id = "m", .incarnation = 7};
    api_presence one = {.client = "c"};
    uint64_t seen[LISTENERS] = {0};
    for (unsigned round = 1; round <= 3; round++) {
        api_text first = {0};
        one.selection.count = round;
        one.has_selection = true;
        assert_int_equal(api_presences_put(p, &mesh, "", &one), API_PRESENCE_PUT);
        news_written = 0;
        for (unsigned i = 0; i < LISTENERS; i++) {
            api_text text = {0};
            uint64_t none = 0;
            api_presences_news(p, mesh.incarnation, &seen[i], i == 0 ? &first : &text);
            assert_true(i == 0 || (text.length == first.length &&
                                   memcmp(text.bytes, first.bytes, text.length) == 0));
            api_text_clear(&text);
            if (i == LISTENERS / 2 && round > 1) { /* a listener that begins now */
                api_presences_news(p, mesh.incarnation, &none, &text);
                api_text_clear(&text);
            }
        }
        assert_int_equal(news_written, round > 1 ? 2 : 1);
        api_text_clear(&first);
    }
    bench_free(b);
}

static void a_client_that_is_put_during_the_work_stays(void **state)
{
    (void)state;
    api_bench *b = begin();
    api_presences *presences = api_service_presences(bench_service(b));
    show(b, "ada", 1);
    const uint64_t next = api_presences_work(presences, clock_now - 1);
    assert_int_equal(api_presences_count(presences), 1);
    assert_int_equal(next, clock_now + (uint64_t)API_PRESENCE_SECONDS * 1000000);
    bench_free(b);
}

static void the_mesh_and_the_journal_know_nothing_of_it(void **state)
{
    (void)state;
    kept_journal *journal = kept_journal_new();
    const st_journal lent = kept_journal_open(journal);
    api_bench *b = bench_new_over(&lent);
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_reply before = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    const kept_facts kept = kept_journal_facts(journal, "m");
    show(b, "ada", 1);
    bench_reply after = bench_expect(200, bench_get(b, "/v1/meshes/m"));
    assert_string_equal(bench_header(&before, "ETag"), bench_header(&after, "ETag"));
    assert_string_equal(before.body, after.body);
    const kept_facts now = kept_journal_facts(journal, "m");
    assert_int_equal(kept.records, now.records);
    assert_int_equal(kept.opened, now.opened);
    bench_done(before);
    bench_done(after);
    /* Another mesh with the same id has other clients. */
    bench_done(bench_expect(204, bench_send(b, "DELETE", "/v1/meshes/m", NULL, NULL)));
    bench_done(bench_expect(404, bench_get(b, PATH)));
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_reply none = bench_expect(200, bench_get(b, PATH));
    assert_string_equal(none.body, "{\"clients\":[]}");
    bench_done(none);
    bench_free(b);
    kept_journal_free(journal);
}

static void what_a_client_shows_is_listed(void **state)
{
    (void)state;
    static const char all[] =
        "{\"client\":\"a.B-1_\",\"name\":\"Ad\xc3\xa9\",\"selection\":{\"kind\":\"halfedge\","
        "\"ids\":[3,1],\"count\":9},\"camera\":{\"position\":[1,2.5,3],\"target\":[0,0,0],"
        "\"up\":[0,0,1]}}";
    api_bench *b = begin();
    bench_reply r = bench_expect(200, put(b, all));
    char expected[400];
    snprintf(expected, sizeof expected, "{\"clients\":[%s]}", all);
    assert_string_equal(r.body, expected);
    bench_done(r);
    bench_done(bench_expect(200, put(b, "{\"client\":\"b\",\"selection\":null,\"camera\":null}")));
    r = bench_expect(200, bench_get(b, PATH));
    snprintf(expected, sizeof expected, "{\"clients\":[%s,{\"client\":\"b\",\"name\":\"\"}]}", all);
    assert_string_equal(r.body, expected);
    bench_done(r);
    bench_free(b);
}

static void what_is_wrong_is_refused_and_named(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *says;
    } rows[] = {
        {"{}", 400, "client"},
        {"{\"client\":\"\"}", 400, "/client"},
        {"{\"client\":\"a b\"}", 400, "/client"},
        {"{\"client\":\"12345678901234567890123456789012345678901\"}", 400, "/client"},
        {"{\"client\":\"a\",\"nam\":\"\"}", 400, "nam"},
        {"{\"client\":\"a\",\"name\":7}", 400, "/name"},
        {"{\"client\":\"a\",\"name\":\"\\u001b[2J\"}", 400, "U+001B"},
        {"{\"client\":\"a\",\"name\":\"\\u202egpj\"}", 400, "U+202E"},
        {"{\"client\":\"a\",\"selection\":[]}", 400, "/selection"},
        {"{\"client\":\"a\",\"selection\":{\"ids\":[]}}", 400, "kind"},
        {"{\"client\":\"a\",\"selection\":{\"kind\":\"face\"}}", 400, "ids"},
        {"{\"client\":\"a\",\"selection\":{\"kind\":\"mesh\",\"ids\":[]}}", 400, "/selection/kind"},
        {"{\"client\":\"a\",\"selection\":{\"kind\":\"face\",\"ids\":[-1]}}", 400,
         "/selection/ids/0"},
        {"{\"client\":\"a\",\"selection\":{\"kind\":\"face\",\"ids\":[1,2],\"count\":1}}", 400,
         "/selection/count"},
        {"{\"client\":\"a\",\"camera\":{\"position\":[0,0,0],\"target\":[0,0,0]}}", 400, "up"},
        {"{\"client\":\"a\",\"camera\":{\"position\":[0,0],\"target\":[0,0,0],\"up\":[0,0,1]}}",
         400, "/camera/position"},
        {"{\"client\":\"a\",\"leaves\":1}", 400, "/leaves"},
    };
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        bench_reply r = bench_expect(rows[i].status, put(b, rows[i].body));
        if (strstr(r.body, rows[i].says) == NULL) {
            fail_msg("%s: %s", rows[i].body, r.body);
        }
        bench_done(r);
    }
    char large[API_MAX_PRESENCE + 100], many[4 * API_PRESENCE_IDS + 100];
    snprintf(large, sizeof large, "{\"client\":\"a\"%*s}", API_MAX_PRESENCE, "");
    bench_done(bench_expect(413, put(b, large)));
    int used = snprintf(many, sizeof many,
                        "{\"client\":\"a\",\"selection\":{\"kind\":\"face\",\"ids\":[0");
    for (unsigned i = 0; i < API_PRESENCE_IDS; i++) {
        used += snprintf(many + used, sizeof many - (size_t)used, ",0");
    }
    snprintf(many + used, sizeof many - (size_t)used, "]}}");
    bench_done(bench_expect(413, put(b, many)));
    bench_reply none = bench_expect(200, bench_get(b, PATH));
    assert_string_equal(none.body, "{\"clients\":[]}");
    bench_done(none);
    bench_free(b);
}

static void so_many_clients_may_be_there(void **state)
{
    (void)state;
    api_bench *b = begin();
    char target[60], body[60];
    for (unsigned i = 0; i < API_MAX_PRESENT_OF_MESH; i++) {
        snprintf(body, sizeof body, "c%02u", i);
        show(b, body, 0);
    }
    bench_reply r = bench_expect(503, put(b, "{\"client\":\"one-more\"}"));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "too_many_present");
    assert_non_null(bench_header(&r, "Retry-After"));
    bench_done(r);
    show(b, "c00", 1); /* one that is there may still show something else */
    unsigned total = API_MAX_PRESENT_OF_MESH;
    for (unsigned mesh = 0; total < API_MAX_PRESENT; mesh++) {
        snprintf(target, sizeof target, "/v1/meshes/n%u", mesh);
        bench_done(bench_expect(201, bench_send(b, "PUT", target, NULL, "{\"shape\":\"cube\"}")));
        snprintf(target, sizeof target, "/v1/meshes/n%u/presence", mesh);
        for (unsigned i = 0; i < API_MAX_PRESENT_OF_MESH && total < API_MAX_PRESENT; i++) {
            snprintf(body, sizeof body, "{\"client\":\"c%u\"}", i);
            bench_done(bench_expect(200, bench_send(b, "PUT", target, NULL, body)));
            total++;
        }
    }
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/last", NULL, "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(
        503, bench_send(b, "PUT", "/v1/meshes/last/presence", NULL, "{\"client\":\"a\"}")));
    (void)pass(b, (uint64_t)API_PRESENCE_SECONDS * 1000000);
    bench_done(bench_expect(
        200, bench_send(b, "PUT", "/v1/meshes/last/presence", NULL, "{\"client\":\"a\"}")));
    bench_free(b);
}

static void one_token_cannot_take_all_places(void **state)
{
    (void)state;
    char body[60];
    api_bench *b = bench_new_guarded("alice admin " TEST "\nbob read " PRUEBA "\n");
    bench_use_token(b, "test");
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_use_token(b, "prueba");
    for (unsigned i = 0; i < API_MAX_PRESENT_OF_TOKEN; i++) {
        snprintf(body, sizeof body, "{\"client\":\"b%u\"}", i);
        bench_done(bench_expect(200, put(b, body)));
    }
    bench_reply r = bench_expect(503, put(b, "{\"client\":\"one-more\"}"));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "too_many_present");
    assert_non_null(strstr(r.body, "with this token"));
    bench_done(r);
    bench_done(bench_expect(200, put(b, "{\"client\":\"b0\",\"name\":\"still there\"}")));
    bench_use_token(b, "test");
    bench_done(bench_expect(200, put(b, "{\"client\":\"a\"}")));
    bench_use_token(b, "prueba");
    bench_done(bench_expect(200, put(b, "{\"client\":\"b0\",\"leaves\":true}")));
    bench_done(bench_expect(200, put(b, "{\"client\":\"one-more\"}")));
    bench_free(b);
}

/* Counts the blocks of memory in use. */
static void *count_block(void *context, void *memory, size_t size)
{
    size_t *blocks = context;
    if (size == 0) {
        *blocks -= memory != NULL;
        free(memory);
        return NULL;
    }
    void *now = realloc(memory, size);
    assert_non_null(now);
    *blocks += memory == NULL;
    return now;
}

static void a_refused_presence_leaves_no_memory_in_use(void **state)
{
    (void)state;
    size_t blocks = 0;
    st_store *store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20, .max_meshes = 1, .journal = st_journal_memory()});
    assert_non_null(store);
    const he_mem_hook hook = {.resize = count_block, .context = &blocks};
    he_mem_set_hook(&hook);
    api_presences *presences = api_presences_new(store);
    assert_non_null(presences);
    st_mesh_info mesh = {.id = "m"};
    api_presence one = {.client = "c"};
    for (unsigned i = 0; i < API_MAX_PRESENT; i++) {
        mesh.incarnation = i / API_MAX_PRESENT_OF_MESH;
        snprintf(one.client, sizeof one.client, "c%u", i);
        assert_int_equal(api_presences_put(presences, &mesh, "", &one), API_PRESENCE_PUT);
    }
    const size_t before = blocks;
    for (unsigned i = 0; i < 100; i++) {
        mesh.incarnation = 1000 + i;
        assert_int_equal(api_presences_put(presences, &mesh, "", &one), API_PRESENCE_FULL);
    }
    assert_int_equal(blocks, before);
    api_presences_free(presences);
    assert_int_equal(blocks, 0);
    he_mem_set_hook(NULL);
    st_store_free(store);
}

static void with_tokens_the_name_is_the_tokens(void **state)
{
    (void)state;
    api_bench *b = bench_new_guarded("alice admin " TEST "\nbob read " PRUEBA "\n");
    bench_use_token(b, "test");
    bench_done(
        bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m", NULL, "{\"shape\":\"cube\"}")));
    bench_done(bench_expect(200, put(b, "{\"client\":\"a\",\"name\":\"bob\"}")));
    bench_use_token(b, "prueba");
    bench_reply r = bench_expect(200, put(b, "{\"client\":\"b\",\"name\":\"alice\"}"));
    assert_string_equal(r.body, "{\"clients\":[{\"client\":\"a\",\"name\":\"alice\"},"
                                "{\"client\":\"b\",\"name\":\"bob\"}]}");
    bench_done(r);
    r = bench_expect(409, put(b, "{\"client\":\"a\"}"));
    assert_string_equal(cJSON_GetObjectItem(r.json, "code")->valuestring, "client_taken");
    bench_done(r);
    r = bench_expect(200, put(b, "{\"client\":\"a\",\"leaves\":true}"));
    assert_non_null(strstr(r.body, "\"a\"")); /* bob cannot send alice away */
    bench_done(r);
    bench_use_token(b, NULL);
    bench_done(bench_expect(401, put(b, "{\"client\":\"c\"}")));
    bench_free(b);
}

static void a_request_without_memory_shows_nothing(void **state)
{
    (void)state;
    static const char body[] = "{\"client\":\"a\",\"selection\":{\"kind\":\"face\",\"ids\":[1]}}";
    const bench_request request = {"PUT", PATH, NULL, body, sizeof body - 1};
    api_bench *b = begin();
    failing f = {.what = "a presence", .may_succeed = true};
    while (failing_next(&f)) {
        bench_reply r = {0};
        const bool sent = bench_try(b, &request, &r);
        const bool good = failing_end(&f, sent && r.status == 200);
        assert_true(good || !sent || r.status == 507);
        if (sent) {
            bench_reply_free(&r);
        }
        bench_done(bench_expect(200, put(b, "{\"client\":\"a\",\"leaves\":true}")));
        (void)pass(b, API_PRESENCE_MICROS);
        assert_int_equal(api_presences_count(api_service_presences(bench_service(b))), 0);
    }
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(listeners_are_told_ten_times_a_second_at_most),
        cmocka_unit_test(a_client_is_forgotten_after_half_a_minute_or_when_it_leaves),
        cmocka_unit_test(listeners_that_have_seen_the_same_get_one_text),
        cmocka_unit_test(a_client_that_is_put_during_the_work_stays),
        cmocka_unit_test(the_mesh_and_the_journal_know_nothing_of_it),
        cmocka_unit_test(what_a_client_shows_is_listed),
        cmocka_unit_test(what_is_wrong_is_refused_and_named),
        cmocka_unit_test(so_many_clients_may_be_there),
        cmocka_unit_test(one_token_cannot_take_all_places),
        cmocka_unit_test(a_refused_presence_leaves_no_memory_in_use),
        cmocka_unit_test(with_tokens_the_name_is_the_tokens),
        cmocka_unit_test(a_request_without_memory_shows_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
