/* Edits as application/vnd.hedge.edits (api/json/packed.h): arrays of octets mean what lists in
 * JSON mean, in requests and in answers, and a body that is wrong anywhere is refused with the
 * place of the fault and changes nothing. */
#include "tests/api/cubes.h"

#include "api/json/packed.h"
#include "api/json/text.h"
#include "model/random.h"
#include "tests/failing.h"
#include "tests/seed.h"

#include <inttypes.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const char EDITS[] = "/v1/meshes/m/edits";
enum { VERSION_AT = 4, JSON_AT = 8, COUNT_AT = 12, REVISION_AT = 16, ROWS_AT = 24, ROW = 16 };

/* Writes a body. The writer of answers makes requests, too, if they have no revision. */
static api_text pack(const char *json, const api_arrays *arrays)
{
    api_text body = {0}, text = {0};
    api_text_add_string(&text, json);
    api_packed_write(arrays, &text, &body);
    assert_false(body.failed);
    api_text_clear(&text);
    return body;
}

/* Sends bytes of the packed type; if `packed` is true, asks for an answer of this type. */
static bench_reply send_bytes(api_bench *b, const char *bytes, size_t length, bool packed)
{
    static const char *const both[] = {"Content-Type", API_PACKED_EDITS, "Accept", API_PACKED_EDITS,
                                       NULL};
    static const char *const in[] = {"Content-Type", API_PACKED_EDITS, NULL};
    const bench_request request = {"POST", EDITS, packed ? both : in, bytes, length};
    return bench_send_bytes(b, &request);
}

/* --- reading answers --- */

static uint32_t u32_at(const char *bytes, size_t at)
{
    uint32_t value;
    memcpy(&value, bytes + at, sizeof value);
    return value;
}

/* Returns the JSON of array `number` of an answer. */
static cJSON *array_of(const bench_reply *r, uint32_t number)
{
    const uint32_t text = u32_at(r->body, JSON_AT), count = u32_at(r->body, COUNT_AT);
    size_t at = (ROWS_AT + (size_t)count * ROW + text + 7) / 8 * 8;
    cJSON *list = cJSON_CreateArray();
    for (uint32_t i = 0; i <= number; i++) {
        const size_t row = ROWS_AT + (size_t)i * ROW;
        const uint32_t type = u32_at(r->body, row), width = u32_at(r->body, row + 4);
        const uint32_t items = u32_at(r->body, row + 8);
        const size_t size = type == API_PACKED_U32 ? sizeof(uint32_t) : sizeof(double);
        for (size_t k = 0; i == number && k < items; k++) {
            cJSON *item = width == 1 ? NULL : cJSON_CreateArray();
            for (size_t w = 0; w < width; w++) {
                double f64 = 0;
                memcpy(&f64, r->body + at + (k * width + w) * size, size);
                const uint32_t id = u32_at(r->body, at + (k * width + w) * size);
                const bool is_null = type == API_PACKED_U32 && id == HE_NONE;
                cJSON *one = is_null ? cJSON_CreateNull()
                                     : cJSON_CreateNumber(type == API_PACKED_U32 ? id : f64);
                cJSON_AddItemToArray(item == NULL ? list : item, one);
            }
            if (item != NULL) {
                cJSON_AddItemToArray(list, item);
            }
        }
        at += ((size_t)items * width * size + 7) / 8 * 8;
    }
    return list;
}

/* Makes a list of lists of {"ids":[...],"ends":[...]}. */
static cJSON *lists_of(const cJSON *value)
{
    const cJSON *ids = cJSON_GetObjectItem(value, "ids"), *id = ids->child, *end;
    cJSON *lists = cJSON_CreateArray();
    int at = 0;
    cJSON_ArrayForEach(end, cJSON_GetObjectItem(value, "ends"))
    {
        cJSON *list = cJSON_CreateArray();
        for (; at < end->valueint; at++, id = id->next) {
            cJSON_AddItemToArray(list, cJSON_Duplicate(id, false));
        }
        cJSON_AddItemToArray(lists, list);
    }
    return lists;
}

/* Puts the arrays of an answer in the places of the objects that stand for them. */
static cJSON *unpack(const bench_reply *r, const cJSON *value)
{
    const cJSON *first = value->child;
    if (cJSON_IsObject(value) && first != NULL && strcmp(first->string, "array") == 0) {
        return array_of(r, (uint32_t)first->valueint);
    }
    cJSON *out = cJSON_Duplicate(value, false);
    for (const cJSON *child = first; child != NULL; child = child->next) {
        cJSON *item = unpack(r, child);
        if (cJSON_IsObject(value)) {
            cJSON_AddItemToObject(out, child->string, item);
        } else {
            cJSON_AddItemToArray(out, item);
        }
    }
    if (cJSON_GetObjectItem(out, "ends") != NULL) {
        cJSON *lists = lists_of(out);
        cJSON_Delete(out);
        out = lists;
    }
    return out;
}

/* Returns the answer as the JSON that application/json would be. */
static cJSON *json_of(const bench_reply *r)
{
    const uint32_t count = u32_at(r->body, COUNT_AT);
    assert_memory_equal(r->body, "HEDE", 4);
    assert_string_equal(bench_header(r, "Content-Type"), API_PACKED_EDITS);
    cJSON *packed =
        cJSON_ParseWithLength(r->body + ROWS_AT + (size_t)count * ROW, u32_at(r->body, JSON_AT));
    assert_non_null(packed);
    cJSON *json = unpack(r, packed);
    cJSON_AddNumberToObject(json, "revision", u32_at(r->body, REVISION_AT));
    cJSON_Delete(packed);
    return json;
}

/* --- octets and JSON --- */

static const uint32_t ids[] = {0, 5, 3}, corners[] = {1, HE_NONE};
static const double numbers[] = {0.5, 0.25, 0.75};
static const double points[] = {0, 0, 3, 0, 1, 3, 1, 1, 3};

/* The arrays of all requests below: 0 has ids, 1 numbers, 2 points, 3 ids of which one is null. */
static api_arrays arrays_of_requests(void)
{
    api_arrays arrays = {0};
    (void)api_packed_add(&arrays, API_PACKED_U32, 1, ids, 3);
    (void)api_packed_add(&arrays, API_PACKED_F64, 1, numbers, 3);
    (void)api_packed_add(&arrays, API_PACKED_F64, 3, points, 3);
    (void)api_packed_add(&arrays, API_PACKED_U32, 1, corners, 2);
    return arrays;
}

static const struct {
    const char *packed, *json;
} pairs[] = {
    {"{\"op\":\"edge_split\",\"edges\":{\"array\":0},\"t\":{\"array\":1}}",
     "{\"op\":\"edge_split\",\"edges\":[0,5,3],\"t\":[0.5,0.25,0.75]}"},
    {"{\"op\":\"edge_split\",\"edges\":{\"array\":0},\"t\":0.25}",
     "{\"op\":\"edge_split\",\"edges\":[0,5,3],\"t\":0.25}"},
    {"{\"op\":\"edge_split\",\"edges\":[0,5,3],\"t\":{\"array\":1},\"dry_run\":true}",
     "{\"op\":\"edge_split\",\"edges\":[0,5,3],\"t\":[0.5,0.25,0.75],\"dry_run\":true}"},
    {"{\"op\":\"vertex_move\",\"vertices\":{\"array\":0},\"by\":{\"array\":2}}",
     "{\"op\":\"vertex_move\",\"vertices\":[0,5,3],\"by\":[[0,0,3],[0,1,3],[1,1,3]]}"},
    {"{\"ops\":[{\"op\":\"vertex_add\",\"positions\":{\"array\":2},\"as\":\"v\"},"
     "{\"op\":\"face_add\",\"faces\":[[\"$v.vertex\"]],\"as\":\"f\"},"
     "{\"op\":\"face_poke\",\"faces\":[\"$f.face\"]},"
     "{\"op\":\"face_poke\",\"faces\":{\"array\":0},\"position\":{\"array\":2}},"
     "{\"op\":\"face_delete\",\"faces\":{\"array\":0}}]}",
     "{\"ops\":[{\"op\":\"vertex_add\",\"positions\":[[0,0,3],[0,1,3],[1,1,3]],\"as\":\"v\"},"
     "{\"op\":\"face_add\",\"faces\":[[\"$v.vertex\"]],\"as\":\"f\"},"
     "{\"op\":\"face_poke\",\"faces\":[\"$f.face\"]},"
     "{\"op\":\"face_poke\",\"faces\":[0,5,3],\"position\":[[0,0,3],[0,1,3],[1,1,3]]},"
     "{\"op\":\"face_delete\",\"faces\":[0,5,3]}]}"},
    {"{\"op\":\"face_poke\",\"face\":2}", "{\"op\":\"face_poke\",\"face\":2}"},
};

static void octets_mean_what_json_means(void **state)
{
    (void)state;
    api_arrays arrays = arrays_of_requests();
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        api_bench *b = cubes_begin();
        api_text body = pack(pairs[i].packed, &arrays);
        bench_reply r = bench_expect(200, send_bytes(b, body.bytes, body.length, true));
        bench_reply plain = bench_expect(200, bench_post(b, "/v1/meshes/n/edits", pairs[i].json));
        cJSON *json = json_of(&r);
        if (!cJSON_Compare(json, plain.json, true)) {
            fail_msg("%s: %s", cJSON_PrintUnformatted(json), plain.body);
        }
        he_mesh *mesh = cubes_copy(b, "n");
        cubes_expect(b, mesh, "m");
        he_mesh_free(mesh);
        cJSON_Delete(json);
        bench_reply_free(&r);
        bench_reply_free(&plain);
        api_text_clear(&body);
        bench_free(b);
    }
    api_arrays_clear(&arrays);
}

static void each_side_may_choose_its_type(void **state)
{
    (void)state;
    static const char *const accept[] = {"Accept", API_PACKED_EDITS, NULL};
    static const char *const minimal[] = {"Accept", API_PACKED_EDITS, "Prefer", "return=minimal",
                                          NULL};
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    api_text body = pack(pairs[0].packed, &arrays);
    bench_reply r = bench_expect(200, send_bytes(b, body.bytes, body.length, false));
    assert_string_equal(bench_header(&r, "Content-Type"), "application/json");
    bench_reply_free(&r);
    r = bench_expect(200,
                     bench_send(b, "POST", EDITS, accept, "{\"op\":\"face_poke\",\"face\":0}"));
    cJSON *json = json_of(&r);
    cJSON_Delete(json);
    bench_reply_free(&r);
    r = bench_expect(204,
                     bench_send(b, "POST", EDITS, minimal, "{\"op\":\"face_poke\",\"face\":1}"));
    assert_int_equal(r.length, 0);
    bench_reply_free(&r);
    /* A refusal is a problem in JSON. */
    r = bench_expect(422,
                     bench_send(b, "POST", EDITS, accept, "{\"op\":\"face_poke\",\"face\":99}"));
    assert_string_equal(bench_text(&r, "code"), "no_such_element");
    bench_reply_free(&r);
    api_text_clear(&body);
    api_arrays_clear(&arrays);
    bench_free(b);
}

static void a_wrong_array_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *json, *code, *pointer;
    } cases[] = {
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":4}}", "bad_value", "/edges/array"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":-1}}", "bad_value", "/edges/array"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":0.5}}", "bad_value", "/edges/array"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":\"0\"}}", "wrong_type", "/edges/array"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":1}}", "wrong_type", "/edges"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":2}}", "wrong_type", "/edges"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":3}}", "bad_value", "/edges/1"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":0},\"t\":{\"array\":0}}", "wrong_type", "/t"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":0},\"t\":{\"array\":2}}", "wrong_type", "/t"},
        {"{\"op\":\"edge_split\",\"edges\":[1,2],\"t\":{\"array\":1}}", "bad_value", "/t"},
        {"{\"op\":\"edge_split\",\"edge\":{\"array\":0}}", "wrong_type", "/edge"},
        {"{\"op\":\"edge_split\",\"edge\":0,\"t\":{\"array\":1}}", "wrong_type", "/t"},
        {"{\"op\":\"vertex_move\",\"vertex\":0,\"to\":{\"array\":1}}", "wrong_type", "/to"},
        {"{\"op\":\"vertex_delete\",\"vertices\":{\"array\":0},\"keep_isolated\":{\"array\":1}}",
         "wrong_type", "/keep_isolated"},
        {"{\"op\":\"transform\",\"matrix\":{\"array\":1}}", "wrong_type", "/matrix"},
        {"{\"op\":\"select\",\"by\":\"lasso\",\"polygon\":{\"array\":2}}", "wrong_type",
         "/polygon"},
        {"{\"op\":\"face_add\",\"vertices\":{\"array\":2}}", "wrong_type", "/vertices"},
        {"{\"op\":{\"array\":0}}", "wrong_type", "/op"},
        {"{\"array\":0}", "wrong_type", ""},
        {"{\"ops\":{\"array\":0}}", "wrong_type", "/ops"},
        {"{\"ops\":[{\"array\":0}]}", "wrong_type", "/ops/0"},
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":0,\"x\":1}}", "unknown_member", "/edges/x"},
        {"{\"op\":\"edge_split\"", "malformed_json", ""},
        {"", "malformed_json", ""},
    };
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    he_mesh *before = cubes_copy(b, "m");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_text body = pack(cases[i].json, &arrays);
        bench_reply r = send_bytes(b, body.bytes, body.length, false);
        if (r.status != 400 || strcmp(bench_text(&r, "code"), cases[i].code) != 0 ||
            (cases[i].pointer[0] != '\0' &&
             strcmp(bench_text(&r, "pointer"), cases[i].pointer) != 0)) {
            fail_msg("%s: %s", cases[i].json, r.body);
        }
        bench_reply_free(&r);
        api_text_clear(&body);
        cubes_expect(b, before, "m");
    }
    he_mesh_free(before);
    api_arrays_clear(&arrays);
    bench_free(b);
}

static void a_wrong_header_is_refused_with_its_place(void **state)
{
    (void)state;
    static const struct {
        size_t at;
        const char *bytes;
        size_t length;
        const char *begins; /* how the detail begins */
    } cases[] = {
        {0, "HEDG", 4, "byte 0: "},
        {VERSION_AT, "\2", 1, "byte 4: 2 is not a known version"},
        {JSON_AT, "\377\377\377\377", 4, "byte 8: "},
        {COUNT_AT, "\377\377\377\377", 4, "byte 12: "},
        {COUNT_AT, "\0", 1, "byte "},
        {REVISION_AT + 7, "\1", 1, "byte 16: "},
        {ROWS_AT, "\0", 1, "byte 24: 0 is not a type"},
        {ROWS_AT, "\3", 1, "byte 24: 3 is not a type"},
        {ROWS_AT + 4, "\0", 1, "byte 28: "},
        {ROWS_AT + 4, "\3", 1, "byte 28: "},
        {ROWS_AT + 8, "\377\377\377\377\377\377\377\377", 8, "byte 32: "},
        {ROWS_AT + 8, "\5", 1, "byte "},
        {ROWS_AT + 8, "\1", 1, "byte "},
    };
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    he_mesh *before = cubes_copy(b, "m");
    api_text body = pack(pairs[0].packed, &arrays);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *bytes = malloc(body.length);
        assert_non_null(bytes);
        memcpy(bytes, body.bytes, body.length);
        memcpy(bytes + cases[i].at, cases[i].bytes, cases[i].length);
        bench_reply r = bench_expect(400, send_bytes(b, bytes, body.length, false));
        assert_string_equal(bench_text(&r, "code"), "bad_value");
        if (strncmp(bench_text(&r, "detail"), cases[i].begins, strlen(cases[i].begins)) != 0) {
            fail_msg("%zu: %s", i, r.body);
        }
        bench_reply_free(&r);
        free(bytes);
        cubes_expect(b, before, "m");
    }
    he_mesh_free(before);
    api_text_clear(&body);
    api_arrays_clear(&arrays);
    bench_free(b);
}

/* Each copy is as long as what is sent, so that AddressSanitizer finds a read beyond it. */
static void a_body_of_another_length_is_refused(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    he_mesh *before = cubes_copy(b, "m");
    api_text body = pack(pairs[0].packed, &arrays);
    for (size_t length = 1; length < body.length + 20; length++) {
        char *bytes = calloc(length, 1);
        assert_non_null(bytes);
        memcpy(bytes, body.bytes, length < body.length ? length : body.length);
        if (length != body.length) {
            bench_reply r = bench_expect(400, send_bytes(b, bytes, length, false));
            assert_string_equal(bench_text(&r, "code"), "bad_value");
            bench_reply_free(&r);
            cubes_expect(b, before, "m");
        }
        free(bytes);
    }
    he_mesh_free(before);
    api_text_clear(&body);
    api_arrays_clear(&arrays);
    bench_free(b);
}

static void changed_bytes_do_no_harm(void **state)
{
    (void)state;
    md_random random = {.state = seed_of_run()};
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    for (int i = 0; i < 3000; i++) {
        api_text body = pack(pairs[(size_t)i % (sizeof pairs / sizeof *pairs)].packed, &arrays);
        for (uint32_t k = md_from(&random, 1, 3); k > 0; k--) {
            body.bytes[md_below(&random, (uint32_t)body.length)] = (char)md_bits(&random);
        }
        bench_reply r = send_bytes(b, body.bytes, body.length, md_chance(&random, 50));
        assert_true(r.status == 200 || r.status == 400 || r.status == 422);
        bench_reply_free(&r);
        api_text_clear(&body);
    }
    bench_done(bench_expect(200, bench_get(b, "/v1/meshes/m/check")));
    api_arrays_clear(&arrays);
    bench_free(b);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char *const both[] = {"Content-Type", API_PACKED_EDITS, "Accept", API_PACKED_EDITS,
                                       NULL};
    api_arrays arrays = arrays_of_requests();
    api_text body = pack(pairs[4].packed, &arrays);
    const bench_request request = {"POST", EDITS, both, body.bytes, body.length};
    failing f = {.what = EDITS, .may_succeed = true};
    while (failing_next(&f)) {
        failing_pause();
        api_bench *b = cubes_begin();
        he_mesh *before = cubes_copy(b, "m");
        failing_resume();
        bench_reply r;
        const bool sent = bench_try(b, &request, &r);
        const bool done = sent && r.status == 200;
        failing_end(&f, done);
        if (sent) {
            assert_true(done || r.status == 507);
            bench_reply_free(&r);
        }
        if (!done) {
            cubes_expect(b, before, "m");
        }
        he_mesh_free(before);
        bench_free(b);
    }
    api_text_clear(&body);
    api_arrays_clear(&arrays);
}

static void a_repeated_key_answers_the_same_octets(void **state)
{
    (void)state;
    static const char *const keyed[] = {
        "Content-Type", API_PACKED_EDITS, "Accept", API_PACKED_EDITS, "Idempotency-Key", "k", NULL};
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    api_text body = pack(pairs[0].packed, &arrays);
    const bench_request request = {"POST", EDITS, keyed, body.bytes, body.length};
    bench_reply first = bench_expect(200, bench_send_bytes(b, &request));
    he_mesh *mesh = cubes_copy(b, "m");
    bench_reply again = bench_expect(200, bench_send_bytes(b, &request));
    assert_string_equal(bench_header(&again, "Idempotency-Replayed"), "true");
    assert_string_equal(bench_header(&again, "Content-Type"), API_PACKED_EDITS);
    assert_string_equal(bench_header(&again, "ETag"), bench_header(&first, "ETag"));
    assert_int_equal(again.length, first.length);
    assert_memory_equal(again.body, first.body, first.length);
    cubes_expect(b, mesh, "m");
    bench_reply_free(&first);
    bench_reply_free(&again);
    he_mesh_free(mesh);
    api_text_clear(&body);
    api_arrays_clear(&arrays);
    bench_free(b);
}

static void octets_and_json_have_tags_of_their_own(void **state)
{
    (void)state;
    static const char *const accept[] = {"Accept", API_PACKED_EDITS, NULL};
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":0}";
    api_bench *b = cubes_begin();
    bench_reply r = bench_expect(200, bench_send(b, "POST", EDITS, accept, poke));
    assert_non_null(strstr(bench_header(&r, "ETag"), "-edits-octets\""));
    const char *const match[] = {"If-Match", bench_header(&r, "ETag"), NULL};
    bench_reply json = bench_expect(200, bench_send(b, "POST", EDITS, match, poke));
    assert_non_null(strstr(bench_header(&json, "ETag"), "-edits\""));
    bench_reply_free(&json);
    bench_reply_free(&r);
    bench_free(b);
}

/* The offset of a fault in the JSON is that in the body. */
static void faults_of_the_json_are_counted_from_the_begin_of_the_body(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    api_arrays arrays = arrays_of_requests();
    api_text body = pack("{\"op\":!}", &arrays);
    const size_t at = ROWS_AT + 16 * arrays.count + strlen("{\"op\":");
    char begins[30];
    assert_int_equal(body.bytes[at], '!');
    (void)snprintf(begins, sizeof begins, "byte %zu: ", at);
    bench_reply r = bench_expect(400, send_bytes(b, body.bytes, body.length, false));
    if (strncmp(bench_text(&r, "detail"), begins, strlen(begins)) != 0) {
        fail_msg("%s: %s", begins, r.body);
    }
    bench_reply_free(&r);
    api_text_clear(&body);
    api_arrays_clear(&arrays);
    bench_free(b);
}

enum { MANY_VALUES = 1 << 20 };

/* Returns a body with 67 times the same operation and an array of MANY_VALUES ids, of which the
 * cube does not have the thirteenth. */
static api_text pack_many(const char *op)
{
    api_arrays arrays = {0};
    api_text json = {0};
    uint32_t *edges = malloc(MANY_VALUES * sizeof *edges);
    assert_non_null(edges);
    for (uint32_t i = 0; i < MANY_VALUES; i++) {
        edges[i] = i;
    }
    (void)api_packed_add(&arrays, API_PACKED_U32, 1, edges, MANY_VALUES);
    api_text_add_string(&json, "{\"ops\":[");
    for (size_t i = 0; i < 67; i++) {
        api_text_add_format(&json, "%s%s", i > 0 ? "," : "", op);
    }
    api_text_add(&json, "]}", sizeof "]}");
    assert_false(json.failed);
    api_text body = pack(json.bytes, &arrays);
    api_text_clear(&json);
    api_arrays_clear(&arrays);
    free(edges);
    return body;
}

/* Operations that together name too many elements are refused before the first one runs, which
 * would be refused for its thirteenth edge. */
static void an_array_counts_for_each_operation_that_names_it(void **state)
{
    (void)state;
    static const struct {
        const char *op, *pointer;
    } cases[] = {
        {"{\"op\":\"edge_split\",\"edges\":{\"array\":0}}", "/ops/65"},
        {"{\"op\":\"edge_weld\",\"a\":{\"array\":0},\"b\":{\"array\":0}}", "/ops/33"},
    };
    api_bench *b = cubes_begin();
    he_mesh *before = cubes_copy(b, "m");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        api_text body = pack_many(cases[i].op);
        bench_reply r = bench_expect(413, send_bytes(b, body.bytes, body.length, false));
        assert_string_equal(bench_text(&r, "code"), "limit_exceeded");
        assert_string_equal(bench_text(&r, "pointer"), cases[i].pointer);
        bench_reply_free(&r);
        cubes_expect(b, before, "m");
        api_text_clear(&body);
    }
    he_mesh_free(before);
    bench_free(b);
}

/* Cancels the request when `*context` reports were made while operations were read. */
static bool cancel_reading(void *context, const char *phase, double done)
{
    int *left = context;
    assert_true(done >= 0 && done <= 1);
    return strcmp(phase, "reading") != 0 || --*left > 0;
}

static void the_reading_of_operations_can_be_cancelled(void **state)
{
    (void)state;
    api_bench *b = cubes_begin();
    he_mesh *before = cubes_copy(b, "m");
    api_text body = pack_many("{\"op\":\"edge_split\",\"edges\":{\"array\":0}}");
    const api_request request = {.method = "POST",
                                 .path = EDITS,
                                 .query = "",
                                 .request_id = "test",
                                 .headers = {[API_HEADER_CONTENT_TYPE] = API_PACKED_EDITS},
                                 .has_length = true,
                                 .length = body.length,
                                 .has_body = true};
    api_step step;
    size_t used = 0;
    int left = 3;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    assert_non_null(x);
    for (size_t at = 0; step == API_MORE && at < body.length; at += used) {
        step = api_body(x, body.bytes + at, body.length - at, &used);
    }
    assert_int_equal(step, API_MORE);
    assert_int_equal(api_end(x), API_WORK);
    api_set_progress(x, cancel_reading, &left);
    assert_int_equal(api_work(x), API_READY);
    assert_int_equal(api_answer_of(x)->status, 503);
    assert_int_equal(left, 0);
    api_free(x);
    cubes_expect(b, before, "m");
    he_mesh_free(before);
    api_text_clear(&body);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(octets_mean_what_json_means),
        cmocka_unit_test(each_side_may_choose_its_type),
        cmocka_unit_test(a_wrong_array_is_refused),
        cmocka_unit_test(a_wrong_header_is_refused_with_its_place),
        cmocka_unit_test(a_body_of_another_length_is_refused),
        cmocka_unit_test(changed_bytes_do_no_harm),
        cmocka_unit_test(every_allocation_may_fail),
        cmocka_unit_test(a_repeated_key_answers_the_same_octets),
        cmocka_unit_test(octets_and_json_have_tags_of_their_own),
        cmocka_unit_test(faults_of_the_json_are_counted_from_the_begin_of_the_body),
        cmocka_unit_test(an_array_counts_for_each_operation_that_names_it),
        cmocka_unit_test(the_reading_of_operations_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
