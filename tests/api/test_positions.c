/* The positions of vertices, read and written like an attribute: every way of writing against an
 * array in the test, undo and redo, and refusals. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/api/strip.h"
#include "tests/seed.h"
#include "tests/model/random.h"

#define PATH "/v1/meshes/m/attributes/vertices/position"

enum { MOST = 64 };

/* What the positions of the mesh `m` should be, one for each id that was given out. */
typedef struct oracle {
    double at[MOST][3];
    bool live[MOST];
    uint32_t count;
} oracle;

/* The strip after some edits: two of its vertices are deleted. */
static api_bench *make(oracle *o)
{
    api_bench *b = bench_new();
    const char *const accept[] = {"Accept", OCTETS, NULL};
    strip_make(b, "m", true);
    *o = (oracle){.count = 0};
    bench_reply r = bench_expect(200, bench_send(b, "GET", PATH, accept, NULL));
    o->count = (uint32_t)(r.length / sizeof o->at[0]);
    assert_in_range(o->count, 4, MOST);
    memcpy(o->at, r.body, r.length);
    bench_done(r);
    r = bench_expect(200, bench_get(b, "/v1/meshes/m/vertices?limit=1000"));
    const cJSON *item;
    uint32_t live = 0;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(r.json, "items"))
    {
        const uint32_t id = (uint32_t)cJSON_GetObjectItem(item, "id")->valuedouble;
        const cJSON *position = cJSON_GetObjectItem(item, "position");
        o->live[id] = true;
        live++;
        for (int k = 0; k < 3; k++) {
            assert_true(o->at[id][k] == cJSON_GetArrayItem(position, k)->valuedouble);
        }
    }
    assert_in_range(live, 1, o->count - 1);
    bench_done(r);
    return b;
}

/* Sends binary data and requires the status `status`. `what` is the method and the target, such as
 * "PUT /v1/...". */
static void send_bytes(api_bench *b, int status, const char *what, const void *bytes, size_t length)
{
    const char *const headers[] = {"Content-Type", OCTETS, NULL};
    const char *target = strchr(what, ' ') + 1;
    const char *method = target - what == sizeof "PUT" ? "PUT" : "PATCH";
    bench_done(bench_expect(
        status, bench_send_bytes(b, &(bench_request){method, target, headers, bytes, length})));
}

/* Compares all ways of reading with the oracle. */
static void compare(api_bench *b, const oracle *o)
{
    const char *const accept[] = {"Accept", OCTETS, NULL};
    bench_reply r = bench_expect(200, bench_send(b, "GET", PATH, accept, NULL));
    assert_int_equal(r.length, o->count * sizeof o->at[0]);
    assert_memory_equal(r.body, o->at, r.length);
    bench_done(r);

    r = bench_expect(200, bench_send(b, "GET", PATH "?type=float", accept, NULL));
    assert_int_equal(r.length, o->count * 3 * sizeof(float));
    for (size_t i = 0; i < 3 * (size_t)o->count; i++) {
        float value, expected = (float)o->at[i / 3][i % 3];
        memcpy(&value, r.body + i * sizeof value, sizeof value);
        assert_memory_equal(&value, &expected, sizeof value);
    }
    bench_done(r);

    r = bench_expect(200, bench_get(b, PATH "?limit=1000"));
    const cJSON *ids = cJSON_GetObjectItem(r.json, "ids"),
                *values = cJSON_GetObjectItem(r.json, "values");
    for (int i = 0; i < cJSON_GetArraySize(ids); i++) {
        const uint32_t id = (uint32_t)cJSON_GetArrayItem(ids, i)->valuedouble;
        assert_true(o->live[id]);
        for (int k = 0; k < 3; k++) {
            assert_true(cJSON_GetArrayItem(cJSON_GetArrayItem(values, i), k)->valuedouble ==
                        o->at[id][k]);
        }
    }
    bench_done(r);

    r = bench_expect(200, bench_send(b, "GET", PATH "?ids=3,0,3", accept, NULL));
    assert_int_equal(r.length, 3 * sizeof o->at[0]);
    assert_memory_equal(r.body, o->at[3], sizeof o->at[0]);
    assert_memory_equal(r.body + sizeof o->at[0], o->at[0], sizeof o->at[0]);
    assert_memory_equal(r.body + 2 * sizeof o->at[0], o->at[3], sizeof o->at[0]);
    bench_done(r);
}

/* --- random writes --- */

static double number(md_random *r)
{
    /* Floats can hold these values exactly. */
    return (double)md_below(r, 4096) / 64 - 32;
}

/* Writes all positions, as floats or as doubles. */
static void write_all(api_bench *b, md_random *r, oracle *o)
{
    float narrow[MOST][3];
    for (uint32_t i = 0; i < o->count; i++) {
        for (int k = 0; k < 3; k++) {
            const double value = number(r);
            narrow[i][k] = (float)value;
            /* the positions of deleted vertices are sent, too, and ignored */
            o->at[i][k] = value;
        }
    }
    if (md_chance(r, 50)) {
        send_bytes(b, 200, "PUT " PATH "?type=float", narrow, o->count * sizeof narrow[0]);
    } else {
        send_bytes(b, 200, "PUT " PATH, o->at, o->count * sizeof o->at[0]);
    }
    for (uint32_t i = 0; i < o->count; i++) {
        if (!o->live[i]) {
            memset(o->at[i], 0, sizeof o->at[i]);
        }
    }
}

/* Writes some positions by ids, as binary data or as JSON. */
static void write_some(api_bench *b, md_random *r, oracle *o)
{
    uint32_t ids[MOST], count = 0;
    double values[MOST][3];
    unsigned char bytes[MOST * (sizeof(uint32_t) + sizeof values[0])];
    char list[MOST * 8] = "", text[MOST * 100] = "", body[sizeof list + sizeof text + 100];
    for (uint32_t i = 0; i < o->count; i++) {
        if (o->live[i] && md_chance(r, 40)) {
            for (int k = 0; k < 3; k++) {
                o->at[i][k] = values[count][k] = number(r);
            }
            snprintf(list + strlen(list), sizeof list - strlen(list), "%s%u", count ? "," : "", i);
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s[%.17g,%.17g,%.17g]",
                     count ? "," : "", values[count][0], values[count][1], values[count][2]);
            ids[count++] = i;
        }
    }
    if (count == 0) {
        return;
    }
    if (md_chance(r, 50)) {
        snprintf(body, sizeof body, "{\"ids\":[%s],\"values\":[%s]}", list, text);
        strip_send(b, 200, "PATCH", PATH, body);
        return;
    }
    memcpy(bytes, ids, count * sizeof *ids);
    memcpy(bytes + count * sizeof *ids, values, count * sizeof *values);
    send_bytes(b, 200, "PATCH " PATH, bytes, count * (sizeof *ids + sizeof *values));
}

/* Gives all vertices one position, or writes all by a list in JSON. */
static void write_json(api_bench *b, md_random *r, oracle *o)
{
    char body[MOST * 100];
    const double value = number(r);
    if (md_chance(r, 50)) {
        snprintf(body, sizeof body, "{\"ids\":\"all\",\"value\":[%.17g,1,2]}", value);
        strip_send(b, 200, "PATCH", PATH, body);
    } else {
        snprintf(body, sizeof body, "{\"type\":\"double\",\"components\":3,\"value\":[%.17g,1,2]}",
                 value);
        strip_send(b, 200, "PUT", PATH, body);
    }
    for (uint32_t i = 0; i < o->count; i++) {
        if (o->live[i]) {
            o->at[i][0] = value;
            o->at[i][1] = 1;
            o->at[i][2] = 2;
        }
    }
}

static void every_way_of_writing_equals_the_oracle(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    for (int round = 0; round < 20; round++) {
        oracle o, first;
        api_bench *b = make(&o);
        first = o;
        for (int i = 0; i < 30; i++) {
            switch (md_below(&r, 3)) {
            case 0:
                write_all(b, &r, &o);
                break;
            case 1:
                write_some(b, &r, &o);
                break;
            default:
                write_json(b, &r, &o);
                break;
            }
            compare(b, &o);
        }
        const oracle last = o;
        bench_reply reply = bench_expect(200, bench_get(b, "/v1/meshes/m"));
        const int steps = (int)cJSON_GetObjectItem(reply.json, "revision")->valuedouble - 2;
        bench_done(reply);
        assert_in_range(steps, 1, 30);
        for (int i = 0; i < steps; i++) {
            bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/undo", NULL, NULL)));
        }
        compare(b, &first);
        for (int i = 0; i < steps; i++) {
            bench_done(bench_expect(200, bench_send(b, "POST", "/v1/meshes/m/redo", NULL, NULL)));
        }
        compare(b, &last);
        reply = bench_expect(200, bench_get(b, "/v1/meshes/m/check"));
        assert_non_null(strstr(reply.body, "\"valid\":true"));
        bench_done(reply);
        bench_free(b);
    }
}

/* --- many positions --- */

enum { MAJOR = 200, MINOR = 100, MANY = MAJOR * MINOR };

static void expect_all(api_bench *b, const double *at)
{
    const char *const accept[] = {"Accept", OCTETS, NULL};
    bench_reply r = bench_expect(200, bench_send(b, "GET", PATH, accept, NULL));
    assert_int_equal(r.length, 3 * MANY * sizeof *at);
    assert_memory_equal(r.body, at, r.length);
    bench_done(r);
}

/* A move of many vertices is one record of the history, whatever part of them moves; listeners are
 * told to read the mesh again, and undo and redo restore every bit. */
static void many_positions_are_one_step(void **state)
{
    (void)state;
    char shape[100];
    double *first = calloc(3 * MANY, sizeof *first), *last = calloc(3 * MANY, sizeof *last);
    float *narrow = calloc(3 * MANY, sizeof *narrow);
    const char *const accept[] = {"Accept", OCTETS, NULL};
    const char *const put[] = {"Content-Type", OCTETS, "Prefer", "return=minimal", NULL};
    api_bench *b = bench_new();
    snprintf(shape, sizeof shape,
             "{\"shape\":\"torus\",\"major_segments\":%d,\"minor_segments\":%d}", MAJOR, MINOR);
    bench_done(bench_expect(201, bench_post(b, "/v1/meshes?id=m", shape)));
    bench_reply r = bench_expect(200, bench_send(b, "GET", PATH, accept, NULL));
    assert_int_equal(r.length, 3 * MANY * sizeof *first);
    memcpy(first, r.body, r.length);
    bench_done(r);

    for (size_t i = 0; i < 3 * MANY; i++) {
        narrow[i] = (float)first[i] + 1;
        last[i] = (double)narrow[i];
    }
    send_bytes(b, 200, "PUT " PATH "?type=float", narrow, 3 * MANY * sizeof *narrow);
    expect_all(b, last);
    last[7] += 0.5;
    for (size_t i = 0; i < 3 * MANY; i += 3) {
        last[i] = -last[i];
    }
    const bench_request request = {"PUT", PATH, put, (const char *)last, 3 * MANY * sizeof *last};
    r = bench_expect(204, bench_send_bytes(b, &request));
    assert_int_equal(r.length, 0);
    bench_done(r);
    expect_all(b, last);
    /* the same values again are no change */
    bench_done(bench_expect(204, bench_send_bytes(b, &request)));

    r = bench_expect(200, bench_get(b, "/v1/meshes/m/edits"));
    const cJSON *entries = cJSON_GetObjectItem(r.json, "entries");
    assert_int_equal(cJSON_GetObjectItem(r.json, "revision")->valueint, 3);
    assert_true(cJSON_GetObjectItem(cJSON_GetArrayItem(entries, 0), "bytes")->valueint <
                (int)(4 * MANY * sizeof *last));
    bench_done(r);
    r = bench_expect(200, bench_post(b, "/v1/meshes/m/undo", "{\"steps\":2}"));
    assert_int_equal(cJSON_GetArraySize(
                         cJSON_GetObjectItem(cJSON_GetObjectItem(r.json, "modified"), "vertices")),
                     MANY);
    bench_done(r);
    expect_all(b, first);
    bench_done(bench_expect(200, bench_post(b, "/v1/meshes/m/redo", "{\"steps\":2}")));
    expect_all(b, last);
    for (int revision = 1; revision <= 3; revision += 2) {
        char target[100];
        snprintf(target, sizeof target, PATH "?revision=%d", revision);
        r = bench_expect(200, bench_send(b, "GET", target, accept, NULL));
        assert_memory_equal(r.body, revision == 1 ? first : last, r.length);
        bench_done(r);
    }
    bench_free(b);
    free(first);
    free(last);
    free(narrow);
}

/* --- refusals --- */

static void what_is_wrong_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *method, *target, *body, *code;
        int status;
    } cases[] = {
        {"DELETE", PATH, NULL, "reserved_name", 400},
        {"PUT", "/v1/meshes/m/attributes/faces/position", "{\"type\":\"bool\"}", "reserved_name",
         400},
        {"GET", "/v1/meshes/m/attributes/faces/position", NULL, "no_such_attribute", 404},
        {"PUT", PATH, "{\"type\":\"bool\"}", "bad_value", 400},
        {"PUT", PATH, "{\"type\":\"double\",\"components\":2,\"value\":[1,2]}", "bad_value", 400},
        {"PUT", PATH, "{\"type\":\"double\",\"components\":3}", "missing_member", 400},
        {"PUT", PATH,
         "{\"type\":\"double\",\"components\":3,\"default\":[1,2,3],\"value\":[1,2,3]}",
         "bad_value", 400},
        {"PUT", PATH, "{\"type\":\"double\",\"components\":3,\"rule\":\"copy\",\"value\":[1,2,3]}",
         "bad_value", 400},
        {"PUT", PATH, "{\"type\":\"double\",\"components\":3,\"values\":[[1,2,3]]}", "bad_value",
         422},
        {"PATCH", PATH, "{\"ids\":[1]}", "missing_member", 400},
        {"PATCH", PATH, "{\"ids\":[1,1],\"value\":[1,2,3]}", "repeated_element", 422},
        {"PATCH", PATH, "{\"ids\":[6],\"value\":[1,2,3]}", "deleted_element", 422},
        {"PATCH", PATH, "{\"ids\":[60],\"value\":[1,2,3]}", "no_such_element", 422},
        {"PATCH", PATH, "{\"ids\":[0],\"value\":[1,2,1e999]}", "not_finite", 400},
        {"PATCH", PATH "?type=float", "{\"ids\":[0],\"value\":[1,2,3]}", "bad_parameter", 400},
        {"GET", PATH "?type=float", NULL, "bad_parameter", 400},
    };
    oracle o;
    api_bench *b = make(&o);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        bench_reply r = bench_send(b, cases[i].method, cases[i].target, NULL, cases[i].body);
        if (r.status != cases[i].status || strcmp(bench_text(&r, "code"), cases[i].code) != 0) {
            fail_msg("case %zu: %d %s", i, r.status, r.body);
        }
        bench_done(r);
    }
    compare(b, &o);
    bench_free(b);
}

static void octets_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    const char *const accept[] = {"Accept", OCTETS, NULL};
    const char *const octets[] = {"Content-Type", OCTETS, NULL};
    const uint32_t gone[] = {0, 6}, beyond = 99, twice[] = {1, 1};
    const double huge[] = {0, 1e300, 0}, infinite[] = {0, 0, INFINITY};
    unsigned char bytes[200] = {0};
    oracle o;
    api_bench *b = make(&o);
    send_bytes(b, 422, "PUT " PATH, bytes, 24);
    send_bytes(b, 400, "PUT " PATH, bytes, 25);
    bench_reply empty = bench_expect(
        400, bench_send_bytes(b, &(bench_request){"PUT", PATH, octets, (const char *)bytes, 0}));
    assert_string_equal(bench_text(&empty, "code"), "missing_body");
    assert_non_null(strstr(bench_text(&empty, "detail"), "send the values"));
    bench_done(empty);
    send_bytes(b, 400, "PUT " PATH "?type=int32", bytes, 24);
    send_bytes(b, 400, "PUT " PATH "?components=4", bytes, 24);
    send_bytes(b, 400, "PATCH " PATH, bytes, 27);
    send_bytes(b, 400, "PATCH " PATH "?type=bool", bytes, 28);
    memcpy(bytes, gone, sizeof gone);
    send_bytes(b, 422, "PATCH " PATH, bytes, 56);
    memcpy(bytes, twice, sizeof twice);
    send_bytes(b, 422, "PATCH " PATH, bytes, 56);
    memcpy(bytes, &beyond, sizeof beyond);
    send_bytes(b, 422, "PATCH " PATH, bytes, 28);
    memset(bytes, 0, sizeof bytes);
    memcpy(bytes + 4, infinite, sizeof infinite);
    send_bytes(b, 400, "PATCH " PATH, bytes, 28);
    compare(b, &o);

    /* a double that a float cannot hold is refused when floats are asked for */
    memcpy(bytes + 4, huge, sizeof huge);
    send_bytes(b, 200, "PATCH " PATH "?dry_run=true", bytes, 28);
    compare(b, &o);
    send_bytes(b, 200, "PATCH " PATH, bytes, 28);
    bench_reply r = bench_expect(422, bench_send(b, "GET", PATH "?type=float", accept, NULL));
    assert_string_equal(bench_text(&r, "code"), "beyond_float");
    bench_done(r);
    bench_done(bench_expect(422, bench_send(b, "GET", PATH "?type=float&ids=0", accept, NULL)));
    bench_done(bench_expect(200, bench_send(b, "GET", PATH "?type=float&ids=1", accept, NULL)));
    bench_done(bench_expect(400, bench_send(b, "GET", PATH "?type=int32", accept, NULL)));
    bench_done(bench_expect(400, bench_send(b, "GET", PATH "?limit=2", accept, NULL)));
    bench_free(b);
}

static void other_attributes_are_patched_by_octets_too(void **state)
{
    (void)state;
    const char *const accept[] = {"Accept", OCTETS, NULL};
    static const char path[] = "/v1/meshes/m/attributes/vertices/heat";
    const uint32_t ids[] = {1, 0};
    const float single[] = {0.5F, 0.25F};
    const double wide[] = {4, 1e300};
    unsigned char bytes[24];
    oracle o;
    api_bench *b = make(&o);
    strip_send(b, 201, "PUT", path, "{\"type\":\"float\"}");
    memcpy(bytes, ids, sizeof ids);
    memcpy(bytes + sizeof ids, single, sizeof single);
    send_bytes(b, 200, "PATCH /v1/meshes/m/attributes/vertices/heat", bytes,
               sizeof ids + sizeof single);
    bench_reply r = bench_expect(200, bench_send(b, "GET",
                                                 "/v1/meshes/m/attributes/vertices/heat"
                                                 "?ids=0,1&type=double",
                                                 accept, NULL));
    double read[2];
    assert_int_equal(r.length, sizeof read);
    memcpy(read, r.body, sizeof read);
    assert_true(read[0] == 0.25 && read[1] == 0.5);
    bench_done(r);
    memcpy(bytes + sizeof ids, wide, sizeof wide);
    send_bytes(b, 400, "PATCH /v1/meshes/m/attributes/vertices/heat?type=double", bytes,
               sizeof ids + sizeof wide);
    /* one id and its value */
    send_bytes(b, 200, "PATCH /v1/meshes/m/attributes/vertices/heat?type=double", bytes, 12);
    bench_free(b);
}

static void a_locked_vertex_may_stay_but_not_move(void **state)
{
    (void)state;
    oracle o;
    api_bench *b = make(&o);
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/vertices/locked", "{\"type\":\"bool\"}");
    strip_send(b, 200, "PATCH", "/v1/meshes/m/attributes/vertices/locked",
               "{\"ids\":[0],\"value\":true}");
    o.at[1][2] += 1;
    send_bytes(b, 200, "PUT " PATH, o.at, o.count * sizeof o.at[0]);
    compare(b, &o);
    o.at[0][2] += 1;
    send_bytes(b, 422, "PUT " PATH, o.at, o.count * sizeof o.at[0]);
    o.at[0][2] -= 1;
    compare(b, &o);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_way_of_writing_equals_the_oracle),
        cmocka_unit_test(many_positions_are_one_step),
        cmocka_unit_test(what_is_wrong_is_refused_and_changes_nothing),
        cmocka_unit_test(octets_that_do_not_fit_are_refused),
        cmocka_unit_test(other_attributes_are_patched_by_octets_too),
        cmocka_unit_test(a_locked_vertex_may_stay_but_not_move),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
