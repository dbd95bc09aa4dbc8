/* Attributes: values are read back bit for bit, as JSON and as octets, also from a mesh document,
 * from a copy of the mesh, and after compact, undo and redo. Mistakes in a request are refused with
 * a pointer to the mistake. */
#include "tests/api/strip.h"

#include "tests/model/random.h"
#include "tests/seed.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

/* Requests `target` with a GET and returns the body of the answer, which the caller must free. */
static char *read_all(api_bench *b, const char *target, const char *accept, size_t *length)
{
    const char *const headers[] = {"Accept", accept, NULL};
    bench_reply r = bench_expect(200, bench_send(b, "GET", target, headers, NULL));
    char *copy = malloc(r.length + 1);
    assert_non_null(copy);
    memcpy(copy, r.body, r.length + 1);
    *length = r.length;
    bench_reply_free(&r);
    return copy;
}

/* --- every domain, type, rule and number of components --- */

typedef struct kind {
    const char *type;
    size_t bytes;
} kind;

static const kind types[] = {{"bool", 1}, {"int32", 4}, {"uint32", 4}, {"float", 4}, {"double", 8}};
static const char *const domains[] = {"vertices", "halfedges", "edges", "faces", "mesh"};
static const char *const rules[] = {"copy", "interpolate", "default"};
static const unsigned components[] = {1, 2, 3, 16};

static void fill(md_random *r, unsigned type, char *out, size_t numbers)
{
    for (size_t i = 0; i < numbers; i++) {
        uint64_t bits = md_bits(r);
        double number;
        float single;
        memcpy(&number, &bits, sizeof number);
        memcpy(&single, &bits, sizeof single);
        if (type == 0) {
            bits &= 1;
        } else if ((type == 3 && !isfinite(single)) || (type == 4 && !isfinite(number))) {
            bits = UINT64_C(0x8000000080000000); /* -0 */
        }
        memcpy(out + i * types[type].bytes, &bits, types[type].bytes);
    }
}

static size_t issued_rows(api_bench *b, const char *mesh, const char *domain)
{
    char target[96];
    size_t length;
    snprintf(target, sizeof target, "/v1/meshes/%s/attributes/%s/probe", mesh, domain);
    strip_send(b, 201, "PUT", target, "{\"type\":\"bool\"}");
    free(read_all(b, target, OCTETS, &length));
    strip_send(b, 200, "DELETE", target, NULL);
    return length;
}

/* Adds attributes of every type, interpolation rule and number of components to every domain, with
 * random values; their names are built like "c2_float_copy". */
static void add_columns(api_bench *b, const char *mesh, md_random *r)
{
    for (unsigned d = 0; d < 5; d++) {
        size_t rows = issued_rows(b, mesh, domains[d]);
        for (unsigned i = 0; i < 5 * 3; i++) {
            unsigned type = i / 3, count = components[md_below(r, 4)];
            char target[200];
            snprintf(target, sizeof target,
                     "/v1/meshes/%s/attributes/%s/a%u?type=%s&components=%u&rule=%s", mesh,
                     domains[d], i, types[type].type, count, rules[i % 3]);
            size_t length = rows * count * types[type].bytes;
            char *body = malloc(length);
            assert_non_null(body);
            fill(r, type, body, rows * count);
            const char *const headers[] = {"Content-Type", OCTETS, NULL};
            bench_reply reply = bench_expect(
                201, bench_send_bytes(b, &(bench_request){"PUT", target, headers, body, length}));
            bench_reply_free(&reply);
            *strchr(target, '?') = '\0';
            size_t got;
            char *back = read_all(b, target, OCTETS, &got);
            assert_int_equal(got, length);
            /* no element of the mesh "plain" was deleted, so the values of all elements are read
             * back */
            if (strcmp(mesh, "plain") == 0) {
                assert_memory_equal(back, body, length);
            }
            free(back);
            free(body);
        }
    }
}

/* Returns everything that can be read about a mesh except its id and the times of its changes. */
static char *dump(api_bench *b, const char *mesh, size_t *length)
{
    static char text[1 << 20];
    char target[200];
    size_t used = 0, part;
    for (int i = 0; i < 5; i++) {
        static const char *const targets[] = {"content", "vertices", "halfedges", "edges", "faces"};
        snprintf(target, sizeof target, "/v1/meshes/%s/%s", mesh, targets[i]);
        char *body = read_all(b, target, "application/json", &part);
        const char *from = i == 0 ? body : strstr(body, "\"items\"");
        size_t size = strlen(from);
        assert_true(used + size < sizeof text);
        memcpy(text + used, from, size);
        used += size;
        free(body);
    }
    snprintf(target, sizeof target, "/v1/meshes/%s/attributes", mesh);
    bench_reply list = bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(list.json, "attributes"))
    {
        snprintf(target, sizeof target, "/v1/meshes/%s/attributes/%s/%s", mesh,
                 cJSON_GetObjectItem(item, "domain")->valuestring,
                 cJSON_GetObjectItem(item, "name")->valuestring);
        bench_reply r = bench_expect(200, bench_send(b, "GET", target, NULL, NULL));
        char *values = cJSON_PrintUnformatted(cJSON_GetObjectItem(r.json, "values"));
        assert_true(used + strlen(values) < sizeof text);
        memcpy(text + used, values, strlen(values));
        used += strlen(values);
        free(values);
        bench_reply_free(&r);
    }
    bench_reply_free(&list);
    char *copy = malloc(used + 1);
    assert_non_null(copy);
    memcpy(copy, text, used);
    copy[used] = '\0';
    *length = used;
    return copy;
}

static void documents_carry_every_value(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    static const char *const meshes[] = {"plain", "edited"};
    for (int i = 0; i < 2; i++) {
        api_bench *b = bench_new();
        size_t length, again, third, part;
        char target[200];
        strip_make(b, meshes[i], i == 1);
        add_columns(b, meshes[i], &r);
        strip_send(
            b, 201, "PUT",
            i == 0 ? "/v1/meshes/plain/attributes/faces/group"
                   : "/v1/meshes/edited/attributes/faces/group",
            "{\"type\":\"uint32\",\"labels\":[\"a \\\"b\\\"\",\"\",\"\\u00e4\"],\"value\":2}");
        snprintf(target, sizeof target, "/v1/meshes/%s/content", meshes[i]);
        char *document = read_all(b, target, "application/json", &length);
        strip_send(b, 201, "POST", "/v1/meshes?id=two", document);
        char *two = read_all(b, "/v1/meshes/two/content", "application/json", &again);
        assert_string_equal(document, two);
        strip_send(b, 201, "PUT", "/v1/meshes/three", two);
        char *three = read_all(b, "/v1/meshes/three/content", "application/json", &third);
        assert_string_equal(document, three);
        /* The mesh "two", made from the document, has elements with the ids of those of "plain", so
         * the attributes of the two meshes must have equal bits. */
        for (unsigned d = 0; i == 0 && d < 5; d++) {
            for (unsigned a = 0; a < 15; a++) {
                snprintf(target, sizeof target, "/v1/meshes/plain/attributes/%s/a%u", domains[d],
                         a);
                char *here = read_all(b, target, OCTETS, &length);
                snprintf(target, sizeof target, "/v1/meshes/two/attributes/%s/a%u", domains[d], a);
                char *there = read_all(b, target, OCTETS, &part);
                assert_int_equal(length, part);
                assert_memory_equal(here, there, length);
                free(here);
                free(there);
            }
        }
        free(document);
        free(two);
        free(three);
        bench_free(b);
    }
}

static void copies_and_compact_keep_values(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    api_bench *b = bench_new();
    size_t length, other;
    strip_make(b, "edited", true);
    add_columns(b, "edited", &r);
    char *before = dump(b, "edited", &length);
    strip_send(b, 201, "POST", "/v1/meshes/edited/copy", "{\"id\":\"twin\"}");
    char *copy = dump(b, "twin", &other);
    assert_int_equal(length, other);
    assert_memory_equal(before, copy, length);
    /* A document and the edit `compact` both number the elements without gaps, but a document
     * numbers the edges in the order of the faces. So the attributes of edges and half-edges may be
     * in another order, and only those of vertices, faces and the mesh are compared. */
    char *document = read_all(b, "/v1/meshes/edited/content", "application/json", &other);
    strip_send(b, 200, "POST", "/v1/meshes/edited/edits", "{\"op\":\"compact\"}");
    char *compact = read_all(b, "/v1/meshes/edited/content", "application/json", &other);
    assert_string_equal(document, compact);
    free(document);
    free(compact);
    free(copy);
    free(before);
    bench_free(b);
}

/* --- undo and redo --- */

static void random_write(api_bench *b, md_random *r)
{
    char target[200], body[400];
    unsigned d = md_below(r, 5), name = md_below(r, 3);
    snprintf(target, sizeof target, "/v1/meshes/m/attributes/%s/%s%u", domains[d],
             md_chance(r, 30) ? "selected" : "x", name);
    const char *method = "PATCH";
    switch (md_below(r, 10)) {
    case 0:
    case 1:
        method = "PUT";
        snprintf(body, sizeof body, "{\"type\":\"%s\",\"rule\":\"%s\"}", types[md_below(r, 5)].type,
                 rules[md_below(r, 3)]);
        break;
    case 2:
        method = "DELETE";
        break;
    case 3:
    case 4:
    case 5:
        snprintf(body, sizeof body, "{\"ids\":[%u],\"value\":%s}", md_below(r, 12),
                 md_chance(r, 30) ? "true" : "7");
        break;
    case 6:
        snprintf(body, sizeof body, "{\"ids\":\"all\",\"value\":%u}", md_below(r, 3));
        break;
    default: {
        static const char *const ops[] = {"face_poke\",\"face\"",     "face_delete\",\"face\"",
                                          "edge_split\",\"edge\"",    "edge_flip\",\"edge\"",
                                          "edge_collapse\",\"edge\"", "vertex_delete\",\"vertex\"",
                                          "edge_bisect\",\"edge\"",   "face_join\",\"edge\""};
        method = "POST";
        snprintf(target, sizeof target, "/v1/meshes/m/edits");
        snprintf(body, sizeof body, "{\"op\":\"%s:%u}", ops[md_below(r, 8)], md_below(r, 30));
        break;
    }
    }
    bench_reply reply =
        bench_send(b, method, target, NULL, strcmp(method, "DELETE") == 0 ? NULL : body);
    assert_true(reply.status < 500);
    bench_reply_free(&reply);
}

static unsigned step_all(api_bench *b, const char *target)
{
    unsigned steps = 0;
    for (;; steps++) {
        bench_reply r = bench_send(b, "POST", target, NULL, NULL);
        bool more = r.status == 200;
        assert_true(more || r.status == 409);
        bench_reply_free(&r);
        if (!more) {
            return steps;
        }
    }
}

static void undo_and_redo_lead_back_bit_for_bit(void **state)
{
    (void)state;
    md_random r = {seed_of_run()};
    unsigned steps = 0;
    for (int round = 0; round < 20; round++) {
        api_bench *b = bench_new();
        size_t first, last, length;
        /* The steps of undo must end at the state in which the mesh was created. */
        strip_send(
            b, 201, "POST", "/v1/meshes?id=m",
            "{\"vertices\":[[0,0,0],[1,0,0],[2,0,0],[0,1,0],[1,1,0],[2,1,0]],"
            "\"faces\":[[0,1,4,3],[1,2,5,4]],\"attributes\":["
            "{\"domain\":\"edges\",\"name\":\"feature\",\"type\":\"bool\","
            "\"values\":[true,false,false,true,false,false,true]},"
            "{\"domain\":\"vertices\",\"name\":\"x1\",\"type\":\"double\","
            "\"values\":[0.1,-0,1e300,4,5,6]},"
            "{\"domain\":\"halfedges\",\"name\":\"x0\",\"type\":\"int32\",\"rule\":\"default\"}]}");
        char *start = dump(b, "m", &first);
        for (int i = 0; i < 40; i++) {
            random_write(b, &r);
        }
        char *end = dump(b, "m", &last);
        unsigned undone = step_all(b, "/v1/meshes/m/undo");
        char *back = dump(b, "m", &length);
        assert_int_equal(length, first);
        assert_memory_equal(back, start, first);
        free(back);
        assert_int_equal(step_all(b, "/v1/meshes/m/redo"), undone);
        back = dump(b, "m", &length);
        assert_int_equal(length, last);
        assert_memory_equal(back, end, last);
        steps += undone;
        free(back);
        free(start);
        free(end);
        bench_free(b);
    }
    printf("note: %u steps undone and redone\n", steps);
}

/* --- refusals --- */

static const struct {
    const char *method, *target;
    int status;
    const char *code, *pointer, *body;
} refusals[] = {
    {"PUT", "vertices/position", 400, "bad_value", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "faces/position", 400, "reserved_name", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "vertices/a", 400, "missing_member", "", "{}"},
    {"PUT", "vertices/a", 400, "bad_value", "/type", "{\"type\":\"byte\"}"},
    {"PUT", "vertices/a", 400, "bad_value", "/components", "{\"type\":\"bool\",\"components\":0}"},
    {"PUT", "vertices/a", 400, "bad_value", "/components", "{\"type\":\"bool\",\"components\":17}"},
    {"PUT", "vertices/a", 400, "bad_value", "/rule", "{\"type\":\"bool\",\"rule\":\"mean\"}"},
    {"PUT", "vertices/a", 400, "wrong_type", "/default", "{\"type\":\"bool\",\"default\":0}"},
    {"PUT", "vertices/a", 400, "wrong_type", "/default", "{\"type\":\"int32\",\"default\":true}"},
    {"PUT", "vertices/a", 400, "bad_value", "/default", "{\"type\":\"int32\",\"default\":0.5}"},
    {"PUT", "vertices/a", 400, "bad_value", "/default",
     "{\"type\":\"int32\",\"default\":2147483648}"},
    {"PUT", "vertices/a", 400, "bad_value", "/default", "{\"type\":\"uint32\",\"default\":-1}"},
    {"PUT", "vertices/a", 400, "not_finite", "/default", "{\"type\":\"float\",\"default\":1e39}"},
    {"PUT", "vertices/a", 400, "unknown_member", "/valeus", "{\"type\":\"bool\",\"valeus\":[]}"},
    {"PUT", "vertices/a", 400, "conflicting_members", "/value",
     "{\"type\":\"bool\",\"values\":[],\"value\":true}"},
    {"PUT", "vertices/a", 400, "wrong_type", "/values/1",
     "{\"type\":\"bool\",\"values\":[true,1,true]}"},
    {"PUT", "vertices/a", 400, "wrong_type", "/values/0",
     "{\"type\":\"float\",\"components\":2,\"values\":[1,2]}"},
    {"PUT", "vertices/a", 400, "bad_value", "/values/0",
     "{\"type\":\"float\",\"components\":2,\"values\":[[1,2,3]]}"},
    {"PUT", "vertices/a", 422, "bad_value", "/values", "{\"type\":\"float\",\"values\":[1,2]}"},
    {"PUT", "vertices/a", 400, "bad_value", "/labels", "{\"type\":\"float\",\"labels\":[\"a\"]}"},
    {"PUT", "vertices/a", 400, "bad_value", "/labels/1",
     "{\"type\":\"uint32\",\"labels\":[\"a\",\"a\"]}"},
    {"PUT", "vertices/a", 400, "bad_value", "/value",
     "{\"type\":\"uint32\",\"labels\":[\"a\"],\"value\":1}"},
    {"PUT", "vertices/a?type=bool", 400, "bad_parameter", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "corners/a", 404, "no_such_route", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "vertices%2Fa", 400, "bad_path", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "vertices/%FF", 400, "bad_path", NULL, "{\"type\":\"bool\"}"},
    {"PUT", "vertices/a23456789012345678901234567890123456789012345678901234567890abcd", 400,
     "bad_value", NULL, "{\"type\":\"bool\"}"},
    {"PATCH", "vertices/none", 404, "no_such_attribute", NULL, "{\"ids\":[0],\"value\":1}"},
    {"PATCH", "vertices/f", 400, "missing_member", "", "{\"value\":1}"},
    {"PATCH", "vertices/f", 400, "missing_member", "", "{\"ids\":[0]}"},
    {"PATCH", "vertices/f", 400, "bad_value", "/ids", "{\"ids\":\"some\",\"value\":1}"},
    {"PATCH", "vertices/f", 400, "bad_value", "/ids/1", "{\"ids\":[0,-1],\"value\":1}"},
    {"PATCH", "vertices/f", 422, "no_such_element", "/ids/1", "{\"ids\":[0,77],\"value\":1}"},
    {"PATCH", "vertices/f", 422, "deleted_element", "/ids/0", "{\"ids\":[6,0],\"value\":1}"},
    {"PATCH", "vertices/f", 422, "repeated_element", "/ids/2", "{\"ids\":[1,0,1],\"value\":1}"},
    {"PATCH", "vertices/f", 422, "bad_value", "/values", "{\"ids\":[1,0],\"values\":[1]}"},
    {"PATCH", "vertices/f", 422, "bad_value", "/values", "{\"ids\":\"all\",\"values\":[1]}"},
    {"PATCH", "vertices/f", 400, "not_finite", "/values/1", "{\"ids\":[0,1],\"values\":[1,1e39]}"},
    {"PATCH", "vertices/f", 422, "no_such_attribute", "/ids",
     "{\"ids\":{\"no\":true},\"value\":1}"},
    {"PATCH", "vertices/f", 400, "wrong_type", "/ids", "{\"ids\":{\"f\":true},\"value\":1}"},
    {"PATCH", "mesh/f", 422, "no_such_element", NULL, "{\"ids\":[1],\"value\":1}"},
    {"PATCH", "vertices/f", 412, "stale_revision", NULL,
     "{\"ids\":[0],\"value\":1,\"expected_revision\":1}"},
    {"DELETE", "vertices/none", 404, "no_such_attribute", NULL, NULL},
    {"GET", "edges/position", 404, "no_such_attribute", NULL, NULL},
    {"GET", "vertices/f?ids=1,,2", 400, "bad_parameter", NULL, NULL},
    {"GET", "vertices/f?ids=1,2&limit=1", 400, "bad_parameter", NULL, NULL},
    {"GET", "vertices/f?ids=99", 404, "no_such_element", NULL, NULL},
    {"GET", "vertices/f?ids=6", 410, "deleted_element", NULL, NULL},
    {"GET", "vertices/f?cursor=vertices.1.1.1", 400, "bad_cursor", NULL, NULL},
};

static void what_is_wrong_is_refused_with_its_pointer(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    size_t length, after;
    strip_make(b, "m", true);
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/vertices/f",
               "{\"type\":\"float\",\"value\":3}");
    strip_send(b, 201, "PUT", "/v1/meshes/m/attributes/mesh/f", "{\"type\":\"float\",\"value\":3}");
    char *before = dump(b, "m", &length);
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        char target[200];
        snprintf(target, sizeof target, "/v1/meshes/m/attributes/%s", refusals[i].target);
        bench_reply r = bench_send(b, refusals[i].method, target, NULL, refusals[i].body);
        const cJSON *code = cJSON_GetObjectItem(r.json, "code");
        const cJSON *pointer = cJSON_GetObjectItem(r.json, "pointer");
        if (r.status != refusals[i].status || code == NULL ||
            strcmp(code->valuestring, refusals[i].code) != 0 ||
            (refusals[i].pointer != NULL &&
             (pointer == NULL || strcmp(pointer->valuestring, refusals[i].pointer) != 0))) {
            fail_msg("%s %s %s: %s", refusals[i].method, target,
                     refusals[i].body == NULL ? "" : refusals[i].body, r.body);
        }
        bench_reply_free(&r);
    }
    char *now = dump(b, "m", &after);
    assert_int_equal(length, after);
    assert_memory_equal(before, now, length);
    free(before);
    free(now);
    bench_free(b);
}

static void octets_are_checked(void **state)
{
    (void)state;
    static const struct {
        const char *query;
        int status;
        const char *body;
        size_t length;
    } cases[] = {
        {"", 400, "\0\0\0", 3},
        {"?type=bool", 201, "\0\1\0", 3},
        {"?type=bool", 400, "\0\2\0", 3},
        {"?type=bool", 422, "\0\1", 2},
        {"?type=bool", 422, "\0\1\0\1", 4},
        {"?type=float", 400, "\0\0\0\0\0\0\200\177\0\0\0\0", 12}, /* infinity */
        {"?type=float", 400, "\0\0\0\0\0\0\300\377\0\0\0\0", 12}, /* NaN */
        {"?type=float", 400, "\0\0\0\0\0", 5},
        {"?type=float&components=17", 400, "\0\0\0", 3},
        {"?type=uint32", 200, "\1\0\0\0\2\0\0\0\3\0\0\0", 12},
    };
    api_bench *b = bench_new();
    strip_send(b, 201, "POST", "/v1/meshes?id=m",
               "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]]}");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char target[200];
        const char *const headers[] = {"Content-Type", OCTETS, NULL};
        snprintf(target, sizeof target, "/v1/meshes/m/attributes/vertices/o%s", cases[i].query);
        bench_reply r = bench_send_bytes(
            b, &(bench_request){"PUT", target, headers, cases[i].body, cases[i].length});
        if (r.status != cases[i].status) {
            fail_msg("case %zu: %d, %s", i, r.status, r.body);
        }
        bench_reply_free(&r);
    }
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/attributes/vertices/o", NULL, NULL);
    assert_non_null(strstr(r.body, "\"values\":[1,2,3]"));
    bench_reply_free(&r);
    bench_free(b);
}

static const struct {
    const char *attributes;
    int status;
    const char *code, *pointer;
} documents[] = {
    {"[]", 201, NULL, NULL},
    {"[{\"values\":[1,2,3],\"name\":\"a\",\"type\":\"double\",\"domain\":\"vertices\"}]", 201, NULL,
     NULL},
    {" [ { \"domain\" : \"mesh\" , \"name\" : \"a\" , \"type\" : \"bool\" , \"values\" : [ true ] "
     "} ] ",
     201, NULL, NULL},
    {"[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"float\",\"components\":2,"
     "\"values\":[ [1 , 2] ,[3,4], [ 5 ,6 ] ]}]",
     201, NULL, NULL},
    {"{}", 400, "wrong_type", "/attributes/0"},
    {"[1]", 400, "wrong_type", "/attributes/0"},
    {"[{}]", 400, "missing_member", "/attributes/0"},
    {"[{\"domain\":\"corners\",\"name\":\"a\",\"type\":\"bool\"}]", 400, "bad_value",
     "/attributes/0/domain"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\",\"x\":1}]", 400, "unknown_member",
     "/attributes/0/x"},
    {"[{\"domain\":\"faces\",\"name\":\"position\",\"type\":\"bool\"}]", 400, "reserved_name",
     "/attributes/0/name"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\"},{\"domain\":\"faces\",\"name\":"
     "\"a\","
     "\"type\":\"int32\"}]",
     400, "bad_value", "/attributes/1/name"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\",\"values\":[true,false]}]", 422,
     "bad_value", "/attributes/0/values"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\",\"values\":[1]}]", 400, "wrong_type",
     "/attributes/0/values/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"int32\",\"values\":[true]}]", 400,
     "wrong_type", "/attributes/0/values/0"},
    {"[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"int32\",\"values\":[1,2.5,3]}]", 400,
     "bad_value", "/attributes/0/values/1"},
    {"[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"double\",\"values\":[1,2,1e999]}]", 400,
     "not_finite", "/attributes/0/values/2"},
    {"[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"double\",\"values\":[1,[2],3]}]", 400,
     "bad_value", "/attributes/0/values/1"},
    {"[{\"domain\":\"vertices\",\"name\":\"a\",\"type\":\"double\",\"values\":[[1],[2],[[3]]]}]",
     400, "wrong_type", "/attributes/0/values/2"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"double\",\"components\":2,\"values\":[1]}]",
     400, "bad_value", "/attributes/0/values/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"double\",\"values\":[01]}]", 400,
     "malformed_json", "/attributes/0/values/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"double\",\"values\":[null]}]", 400,
     "wrong_type", "/attributes/0/values/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"double\",\"values\":[1,]}]", 400,
     "malformed_json", "/attributes/0/values/1"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"double\",\"values\":[1],\"values\":[1]}]",
     400, "duplicate_member", "/attributes/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"uint32\",\"labels\":[\"x\"],\"values\":[1]}"
     "]",
     400, "bad_value", "/attributes/0/values/0"},
    {"[{\"domain\":\"faces\",}]", 400, "malformed_json", "/attributes/0"},
    {"[{\"domain\":\"faces\",\"name\":\"a\",\"type\":\"bool\"}", 400, "wrong_type", NULL},
};

static void documents_are_read_whole_or_not_at_all(void **state)
{
    (void)state;
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof documents / sizeof *documents; i++) {
        char body[1000];
        snprintf(body, sizeof body,
                 "{\"attributes\":%s,\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]]}",
                 documents[i].attributes);
        bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, body);
        const cJSON *code = cJSON_GetObjectItem(r.json, "code");
        const cJSON *pointer = cJSON_GetObjectItem(r.json, "pointer");
        bool good = r.status == 200 ? documents[i].status == 201 : r.status == documents[i].status;
        good = good && (documents[i].code == NULL ||
                        (code != NULL && strcmp(code->valuestring, documents[i].code) == 0));
        good =
            good && (documents[i].pointer == NULL ||
                     (pointer != NULL && strcmp(pointer->valuestring, documents[i].pointer) == 0));
        if (!good) {
            fail_msg("%s: %d %s", documents[i].attributes, r.status, r.body);
        }
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* A file may contain an attribute with a slash in its name; in a path the slash is written %2F. */
static void a_name_with_a_slash_is_reached_by_an_escaped_one(void **state)
{
    (void)state;
    static const char path[] = "/v1/meshes/m/attributes/vertices/uv%2F0%2f";
    api_bench *b = bench_new();
    bench_done(bench_expect(
        201,
        bench_send(b, "PUT", "/v1/meshes/m", NULL,
                   "{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]],\"attributes\":"
                   "[{\"name\":\"uv/0/"
                   "\",\"domain\":\"vertices\",\"type\":\"float\",\"values\":[1,2,3]}]}")));
    bench_reply r = bench_expect(200, bench_get(b, path));
    assert_non_null(strstr(r.body, "\"name\":\"uv/0/\""));
    bench_done(r);
    char first[100];
    snprintf(first, sizeof first, "%s?limit=1", path);
    r = bench_expect(200, bench_get(b, first));
    assert_non_null(strstr(bench_header(&r, "Link"), "/attributes/vertices/uv%2F0%2F?limit=1"));
    bench_done(r);
    bench_done(bench_expect(200, bench_send(b, "PATCH", path, NULL, "{\"ids\":[1],\"value\":5}")));
    bench_done(bench_expect(405, bench_send(b, "POST", path, NULL, "{}")));
    bench_done(bench_expect(200, bench_send(b, "DELETE", path, NULL, NULL)));
    bench_done(bench_expect(404, bench_get(b, path)));
    r = bench_expect(201, bench_send(b, "PUT", "/v1/meshes/m/attributes/faces/%2F", NULL,
                                     "{\"type\":\"bool\"}"));
    assert_string_equal(bench_header(&r, "Location"), "/v1/meshes/m/attributes/faces/%2F");
    bench_done(r);
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_with_a_slash_is_reached_by_an_escaped_one),
        cmocka_unit_test(documents_carry_every_value),
        cmocka_unit_test(copies_and_compact_keep_values),
        cmocka_unit_test(undo_and_redo_lead_back_bit_for_bit),
        cmocka_unit_test(what_is_wrong_is_refused_with_its_pointer),
        cmocka_unit_test(octets_are_checked),
        cmocka_unit_test(documents_are_read_whole_or_not_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
