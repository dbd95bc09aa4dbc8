/* Questions that must be refused, what questions cost, and questions during which an allocation
 * fails. */
#include "tests/api/request.h"

#include "base/mem.h"
#include "tests/failing.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void put(api_bench *b, const char *document)
{
    bench_reply r = bench_send(b, "PUT", "/v1/meshes/m", NULL, document);
    if (r.status != 201 && r.status != 200) {
        fail_msg("%d: %s", r.status, r.body);
    }
    bench_reply_free(&r);
}

/* A mesh document of a cube and an isolated vertex, whose id is 8. */
static const char cube[] =
    "{\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1],[5,5,5]],"
    "\"faces\":[[3,2,1,0],[4,5,6,7],[5,4,0,1],[6,5,1,2],[7,6,2,3],[4,7,3,0]]}";

static void edit(api_bench *b, const char *body)
{
    bench_reply r = bench_send(b, "POST", "/v1/meshes/m/edits", NULL, body);
    if (r.status != 200) {
        fail_msg("%d: %s", r.status, r.body);
    }
    bench_reply_free(&r);
}

/* Creates the cube, then deletes its face 0 and vertex 8. */
static api_bench *begin(void)
{
    api_bench *b = bench_new();
    put(b, cube);
    edit(b, "{\"op\":\"face_delete\",\"face\":0}");
    edit(b, "{\"op\":\"vertex_delete\",\"vertex\":8}");
    return b;
}

/* --- refusals --- */

typedef struct refusal {
    const char *target; /* after /v1/meshes/m */
    const char *body;   /* NULL if the request is a GET */
    int status;
    const char *code;
    const char *pointer; /* NULL: none */
} refusal;

#define TRAVERSE   "/traverse"
#define QUERY      "/query"
#define WALK(text) "{\"walk\":" text "}"
#define PATH(text) "{\"walk\":\"path\",\"from\":{\"halfedge\":2}," text "}"

static const refusal refusals[] = {
    /* paths */
    {"/vertices/9", NULL, 404, "no_such_element", NULL},
    {"/vertices/8", NULL, 410, "deleted_element", NULL},
    {"/faces/0", NULL, 410, "deleted_element", NULL},
    {"/faces/0/vertices", NULL, 410, "deleted_element", NULL},
    {"/edges/12", NULL, 404, "no_such_element", NULL},
    {"/halfedges/24", NULL, 404, "no_such_element", NULL},
    {"/halfedges/24/loop", NULL, 404, "no_such_element", NULL},
    {"/vertices/4294967296", NULL, 404, "no_such_element", NULL},
    {"/vertices/-1", NULL, 404, "no_such_element", NULL},
    {"/vertices/1.5", NULL, 404, "no_such_element", NULL},
    {"/vertices/0/loop", NULL, 404, "no_such_route", NULL},
    {"/edges/0/edges", NULL, 404, "no_such_route", NULL},
    {"/corners/0", NULL, 404, "no_such_route", NULL},
    /* query parameters */
    {"/vertices/0?x=1", NULL, 400, "unknown_parameter", NULL},
    {"/vertices/0/faces?cw=yes", NULL, 400, "bad_parameter", NULL},
    {"/vertices/0/faces?limit=1", NULL, 400, "unknown_parameter", NULL},
    {"/vertices?limit=0", NULL, 400, "bad_parameter", NULL},
    {"/vertices?limit=10001", NULL, 400, "bad_parameter", NULL},
    {"/vertices?limit=1&limit=2", NULL, 400, "repeated_parameter", NULL},
    {"/vertices?cursor=", NULL, 400, "bad_cursor", NULL},
    {"/vertices?cursor=vertices.1.1", NULL, 400, "bad_cursor", NULL},
    {"/vertices?cursor=faces.0123456789abcdef.1.0", NULL, 400, "bad_cursor", NULL},
    {"/vertices?cursor=vertices.0123456789abcdef.3.0", NULL, 410, "revision_gone", NULL},
    {"/components?by=face", NULL, 400, "bad_parameter", NULL},
    {"/boundaries?by=edge", NULL, 400, "unknown_parameter", NULL},
    {"/check?limit=1", NULL, 400, "unknown_parameter", NULL},
    /* mistakes in the object that describes a walk */
    {TRAVERSE, "[]", 400, "wrong_type", ""},
    {TRAVERSE, "{}", 400, "missing_member", ""},
    {TRAVERSE, "{\"walk\":1}", 400, "wrong_type", "/walk"},
    {TRAVERSE, "{\"walk\":\"dance\"}", 400, "bad_value", "/walk"},
    {TRAVERSE, WALK("\"loop\""), 400, "missing_member", ""},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":2},\"depth\":1"), 400, "unknown_member",
     "/depth"},
    {TRAVERSE, WALK("\"loop\",\"walk\":\"loop\""), 400, "duplicate_member", "/walk"},
    {TRAVERSE, "{\"walk\":\"loop\"", 400, "malformed_json", NULL},
    {TRAVERSE, "", 400, "missing_body", NULL},
    /* mistakes in the member "from" of a walk */
    {TRAVERSE, WALK("\"loop\",\"from\":2"), 400, "wrong_type", "/from"},
    {TRAVERSE, WALK("\"loop\",\"from\":{}"), 400, "missing_member", "/from"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"corner\":2}"), 400, "unknown_member", "/from/corner"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"face\":1}"), 400, "bad_value", "/from/face"},
    {TRAVERSE, WALK("\"rings\",\"depth\":1,\"from\":{\"halfedge\":2}"), 400, "bad_value",
     "/from/halfedge"},
    {TRAVERSE, WALK("\"breadth_first\",\"from\":{\"edge\":4}"), 400, "bad_value", "/from/edge"},
    {TRAVERSE, WALK("\"edge_loop\",\"from\":{\"vertex\":1}"), 400, "bad_value", "/from/vertex"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":1.5}"), 400, "bad_value", "/from/halfedge"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":-1}"), 400, "bad_value", "/from/halfedge"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":\"2\"}"), 400, "wrong_type", "/from/halfedge"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":2,\"edge\":1}"), 400, "unknown_member",
     "/from/edge"},
    {TRAVERSE, WALK("\"loop\",\"from\":{\"halfedge\":24}"), 422, "no_such_element",
     "/from/halfedge"},
    {TRAVERSE, WALK("\"breadth_first\",\"from\":{\"face\":0}"), 422, "deleted_element",
     "/from/face"},
    /* mistakes in the member "path" of a walk */
    {TRAVERSE, PATH("\"repeat\":1"), 400, "missing_member", ""},
    {TRAVERSE, PATH("\"path\":[]"), 400, "bad_value", "/path"},
    {TRAVERSE, PATH("\"path\":\"next\""), 400, "wrong_type", "/path"},
    {TRAVERSE, PATH("\"path\":[\"next\",\"left\"]"), 400, "bad_value", "/path/1"},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"repeat\":0.5"), 400, "bad_value", "/repeat"},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"repeat\":-1"), 400, "bad_value", "/repeat"},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"until\":\"end\""), 400, "bad_value", "/until"},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"repeat\":10000001"), 413, "limit_exceeded", ""},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"repeat\":9007199254740992"), 413, "limit_exceeded", ""},
    {TRAVERSE, PATH("\"path\":[\"next\"],\"repeat\":9007199254740994"), 400, "bad_value",
     "/repeat"},
    /* mistakes in the members "depth", "limit", "to" and "by" of a walk */
    {TRAVERSE, WALK("\"rings\",\"from\":{\"vertex\":1}"), 400, "missing_member", ""},
    {TRAVERSE, WALK("\"rings\",\"from\":{\"vertex\":1},\"depth\":10000001"), 400, "bad_value",
     "/depth"},
    {TRAVERSE, WALK("\"rings\",\"from\":{\"vertex\":1},\"depth\":null"), 400, "wrong_type",
     "/depth"},
    {TRAVERSE, WALK("\"breadth_first\",\"from\":{\"vertex\":1},\"limit\":0"), 400, "bad_value",
     "/limit"},
    {TRAVERSE, WALK("\"breadth_first\",\"from\":{\"vertex\":1},\"limit\":1e9"), 400, "bad_value",
     "/limit"},
    {TRAVERSE, WALK("\"shortest_path\",\"from\":{\"vertex\":1}"), 400, "missing_member", ""},
    {TRAVERSE, WALK("\"shortest_path\",\"from\":{\"vertex\":1},\"to\":{\"vertex\":8}"), 422,
     "deleted_element", "/to/vertex"},
    {TRAVERSE,
     WALK("\"shortest_path\",\"from\":{\"vertex\":1},\"to\":{\"vertex\":2},\"by\":\"weight\""), 400,
     "bad_value", "/by"},
    /* queries */
    {QUERY, "{}", 400, "missing_member", ""},
    {QUERY, "{\"queries\":{}}", 400, "wrong_type", "/queries"},
    {QUERY, "{\"queries\":[],\"limit\":1}", 400, "unknown_member", "/limit"},
};

/* Questions with mistakes. Each is sent as the second of several questions: the refusal must take
 * the place of the answer to this question, and the other questions must be answered. */
static const refusal bad_questions[] = {
    {NULL, "1", 400, "wrong_type", ""},
    {NULL, "{}", 400, "missing_member", ""},
    {NULL, "{\"ask\":1}", 400, "missing_member", ""},
    {NULL, "{\"relation\":\"faces\"}", 400, "missing_member", ""},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertex\":1},\"walk\":1}", 400, "unknown_member",
     "/walk"},
    {NULL, "{\"relation\":\"loop\",\"of\":{\"vertex\":1}}", 400, "bad_value", "/relation"},
    {NULL, "{\"relation\":7,\"of\":{\"vertex\":1}}", 400, "wrong_type", "/relation"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertex\":1},\"cw\":1}", 400, "wrong_type", "/cw"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertex\":8}}", 422, "deleted_element", "/of/vertex"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertex\":1.25}}", 400, "bad_value", "/of/vertex"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertices\":1}}", 400, "wrong_type", "/of/vertices"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertices\":\"some\"}}", 400, "bad_value",
     "/of/vertices"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertices\":[1,2,9]}}", 422, "no_such_element",
     "/of/vertices/2"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertices\":[1,\"2\"]}}", 400, "wrong_type",
     "/of/vertices/1"},
    {NULL, "{\"relation\":\"faces\",\"of\":{\"vertices\":[1],\"faces\":[1]}}", 400,
     "unknown_member", "/of/faces"},
    {NULL, "{\"find\":\"loop\",\"vertices\":[1,2]}", 400, "bad_value", "/find"},
    {NULL, "{\"find\":\"halfedge\",\"vertices\":[1]}", 400, "bad_value", "/vertices"},
    {NULL, "{\"find\":\"halfedge\",\"vertices\":\"all\"}", 400, "wrong_type", "/vertices"},
    {NULL, "{\"find\":\"halfedge\",\"vertices\":[1,8]}", 422, "deleted_element", "/vertices/1"},
    {NULL, "{\"get\":{\"face\":0}}", 422, "deleted_element", "/get/face"},
    {NULL, "{\"get\":{\"edge\":12}}", 422, "no_such_element", "/get/edge"},
    {NULL, "{\"get\":{\"edge\":2},\"cw\":true}", 400, "unknown_member", "/cw"},
    {NULL, "{\"walk\":\"loop\",\"from\":{\"halfedge\":99}}", 422, "no_such_element",
     "/from/halfedge"},
    /* measures */
    {NULL, "{\"measure\":\"length\"}", 400, "missing_member", ""},
    {NULL, "{\"measure\":1,\"of\":{\"edge\":4}}", 400, "wrong_type", "/measure"},
    {NULL, "{\"measure\":\"length\",\"of\":{\"face\":1}}", 400, "bad_value", "/measure"},
    {NULL, "{\"measure\":\"area\",\"of\":{\"face\":0}}", 422, "deleted_element", "/of/face"},
    {NULL, "{\"measure\":\"area\",\"of\":{\"faces\":[1,99]}}", 422, "no_such_element",
     "/of/faces/1"},
    {NULL, "{\"measure\":\"area\",\"of\":{\"face\":1},\"cw\":true}", 400, "unknown_member", "/cw"},
    {NULL, "{\"measure\":\"normal\",\"of\":{\"vertex\":1},\"weights\":\"mass\"}", 400, "bad_value",
     "/weights"},
    {NULL, "{\"measure\":\"normal\",\"of\":{\"face\":1},\"weights\":\"area\"}", 400,
     "unknown_member", "/weights"},
    {NULL, "{\"measure\":\"normal\",\"of\":{\"halfedge\":4}}", 400, "missing_member", ""},
    {NULL, "{\"measure\":\"normal\",\"of\":{\"halfedge\":4},\"crease\":3.2}", 400, "bad_value",
     "/crease"},
    {NULL, "{\"measure\":\"normal\",\"of\":{\"halfedge\":4},\"crease\":-1e-300}", 400, "bad_value",
     "/crease"},
    {NULL, "{\"measure\":\"angle\",\"of\":{\"halfedge\":4},\"crease\":1}", 400, "unknown_member",
     "/crease"},
    /* mistakes in questions about rays, nearest points and intersections */
    {NULL, "{\"ray\":{\"origin\":[0,0,0]}}", 400, "missing_member", "/ray"},
    {NULL, "{\"ray\":{\"origin\":[0,0],\"direction\":[0,0,1]}}", 400, "bad_value", "/ray/origin"},
    {NULL, "{\"ray\":{\"origin\":[0,0,0],\"direction\":[0,-0.0,0]}}", 400, "bad_value",
     "/ray/direction"},
    {NULL, "{\"ray\":{\"origin\":[0,0,0],\"direction\":[0,0,1],\"max\":-1}}", 400, "bad_value",
     "/ray/max"},
    {NULL, "{\"ray\":{\"origin\":[0,0,0],\"direction\":[0,0,1],\"min\":1}}", 400, "unknown_member",
     "/ray/min"},
    {NULL, "{\"ray\":[0,0,0]}", 400, "wrong_type", "/ray"},
    {NULL, "{\"closest\":{\"vertex\":1}}", 400, "wrong_type", "/closest"},
    {NULL, "{\"closest\":[0,0,0],\"max\":\"far\"}", 400, "wrong_type", "/max"},
    {NULL, "{\"self_intersections\":true}", 400, "wrong_type", "/self_intersections"},
    {NULL, "{\"self_intersections\":{\"limit\":1048577}}", 400, "bad_value",
     "/self_intersections/limit"},
};

static const char *text_of(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    return cJSON_IsString(value) ? value->valuestring : NULL;
}

static int number_of(const cJSON *object, const char *name)
{
    const cJSON *value = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_true(cJSON_IsNumber(value));
    return (int)value->valuedouble;
}

static void expect_problem(const cJSON *problem, const refusal *r, const char *prefix)
{
    char pointer[128] = "";
    const char *given = text_of(problem, "pointer");
    snprintf(pointer, sizeof pointer, "%s%s", prefix, r->pointer == NULL ? "" : r->pointer);
    if (text_of(problem, "code") == NULL || strcmp(text_of(problem, "code"), r->code) != 0 ||
        number_of(problem, "status") != r->status ||
        (r->pointer != NULL && (given == NULL || strcmp(given, pointer) != 0))) {
        fail_msg("%s: %s %d %s, not %s", r->body == NULL ? r->target : r->body,
                 text_of(problem, "code"), number_of(problem, "status"), given, r->code);
    }
    assert_non_null(text_of(problem, "type"));
    assert_true(strlen(text_of(problem, "detail")) > 0);
}

static void bad_requests_are_refused_by_name(void **state)
{
    (void)state;
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof refusals / sizeof *refusals; i++) {
        const refusal *wanted = &refusals[i];
        char target[256];
        snprintf(target, sizeof target, "/v1/meshes/m%s", wanted->target);
        bench_reply r =
            bench_send(b, wanted->body == NULL ? "GET" : "POST", target, NULL, wanted->body);
        if (r.status != wanted->status) {
            fail_msg("%s %s: %d %s", target, wanted->body, r.status, r.body);
        }
        expect_problem(r.json, wanted, "");
        assert_string_equal(bench_header(&r, "Content-Type"), "application/problem+json");
        bench_reply_free(&r);
    }
    bench_free(b);
}

static void a_bad_question_stops_no_other(void **state)
{
    (void)state;
    api_bench *b = begin();
    for (size_t i = 0; i < sizeof bad_questions / sizeof *bad_questions; i++) {
        char body[512];
        snprintf(body, sizeof body,
                 "{\"queries\":[{\"find\":\"halfedge\",\"vertices\":[4,5]},%s,"
                 "{\"find\":\"halfedge\",\"vertices\":[4,6]}]}",
                 bad_questions[i].body);
        bench_reply r = bench_send(b, "POST", "/v1/meshes/m/query", NULL, body);
        assert_int_equal(r.status, 200);
        const cJSON *results = cJSON_GetObjectItemCaseSensitive(r.json, "results");
        assert_int_equal(cJSON_GetArraySize(results), 3);
        number_of(cJSON_GetArrayItem(results, 0), "halfedge");
        assert_true(cJSON_IsNull(
            cJSON_GetObjectItemCaseSensitive(cJSON_GetArrayItem(results, 2), "halfedge")));
        expect_problem(cJSON_GetArrayItem(results, 1), &bad_questions[i], "/queries/1");
        bench_reply_free(&r);
    }
    bench_free(b);
}

/* --- media types of answers --- */

/* Returns the status of the answer to a request with one header: a POST, or a GET if `body` is
 * NULL. */
static int status_of(api_bench *b, const char *target, const char *name, const char *value,
                     const char *body)
{
    const char *const headers[] = {name, value, NULL};
    bench_reply r = bench_send(b, body == NULL ? "GET" : "POST", target, headers, body);
    int status = r.status;
    bench_reply_free(&r);
    return status;
}

static void octets_answer_one_dense_question(void **state)
{
    (void)state;
    static const char octets[] = "application/octet-stream";
    static const char target[] = "/v1/meshes/m/query";
    static const char dense[] =
        "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edges\":\"all\"}}]}";
    static const char single[] = "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edge\":4}}]}";
    static const char dead[] = "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"faces\":[0]}}]}";
    api_bench *b = begin();
    assert_int_equal(status_of(b, target, "Accept", octets, dense), 200);
    assert_int_equal(status_of(b, target, "Accept", octets, single), 406);
    assert_int_equal(status_of(b, target, "Accept", octets, "{\"queries\":[]}"), 406);
    assert_int_equal(status_of(b, target, "Accept", octets, dead), 422);
    static const char measure[] =
        "{\"queries\":[{\"measure\":\"length\",\"of\":{\"edges\":\"all\"}}]}";
    static const char ray[] =
        "{\"queries\":[{\"ray\":{\"origin\":[0,0,0],\"direction\":[0,0,1]}}]}";
    assert_int_equal(status_of(b, target, "Accept", octets, measure), 200);
    assert_int_equal(status_of(b, target, "Accept", octets, ray), 406);
    assert_int_equal(status_of(b, target, "Accept", "text/html", dense), 406);
    const char *const both[] = {"Accept", "application/json;q=0.5, application/octet-stream", NULL};
    bench_reply r = bench_send(b, "POST", target, both, single);
    assert_int_equal(r.status, 200);
    assert_string_equal(bench_header(&r, "Content-Type"), "application/json");
    bench_reply_free(&r);
    bench_free(b);
}

static void lines_are_not_pages(void **state)
{
    (void)state;
    static const char lines[] = "application/x-ndjson";
    api_bench *b = begin();
    assert_int_equal(status_of(b, "/v1/meshes/m/edges", "Accept", lines, NULL), 200);
    assert_int_equal(status_of(b, "/v1/meshes/m/edges?limit=3", "Accept", lines, NULL), 400);
    assert_int_equal(status_of(b, "/v1/meshes/m/edges", "Accept", "text/csv", NULL), 406);
    assert_int_equal(status_of(b, "/v1/meshes/m/edges/4", "Accept", lines, NULL), 406);
    bench_free(b);
}

static const char *const readable[] = {
    "/v1/meshes/m/vertices",   "/v1/meshes/m/edges?limit=2", "/v1/meshes/m/vertices/1",
    "/v1/meshes/m/edges/5",    "/v1/meshes/m/faces/1/edges", "/v1/meshes/m/boundaries",
    "/v1/meshes/m/components", "/v1/meshes/m/check",
};
enum { READABLE = sizeof readable / sizeof *readable };

static void tags_hold_until_the_mesh_changes(void **state)
{
    (void)state;
    api_bench *b = begin();
    char tags[READABLE][128];
    for (size_t i = 0; i < READABLE; i++) {
        bench_reply r = bench_send(b, "GET", readable[i], NULL, NULL);
        assert_int_equal(r.status, 200);
        snprintf(tags[i], sizeof tags[i], "%s", bench_header(&r, "ETag"));
        assert_int_equal(tags[i][0], '"');
        bench_reply_free(&r);
        assert_int_equal(status_of(b, readable[i], "If-None-Match", tags[i], NULL), 304);
        assert_int_equal(status_of(b, readable[i], "If-None-Match", "\"x\"", NULL), 200);
    }
    const char *const lines[] = {"Accept", "application/x-ndjson", NULL};
    bench_reply r = bench_send(b, "GET", readable[0], lines, NULL);
    assert_string_not_equal(bench_header(&r, "ETag"), tags[0]);
    bench_reply_free(&r);
    edit(b, "{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[2,0,0]}");
    for (size_t i = 0; i < READABLE; i++) {
        assert_int_equal(status_of(b, readable[i], "If-None-Match", tags[i], NULL), 200);
    }
    bench_free(b);
}

static void a_cursor_is_of_its_revision(void **state)
{
    (void)state;
    api_bench *b = begin();
    char target[300];
    bench_reply r = bench_send(b, "GET", "/v1/meshes/m/faces?limit=2", NULL, NULL);
    /* Face 0 is deleted, so the first page holds the faces 1 and 2. */
    const cJSON *items = cJSON_GetObjectItemCaseSensitive(r.json, "items");
    assert_int_equal(cJSON_GetArraySize(items), 2);
    assert_int_equal(number_of(cJSON_GetArrayItem(items, 0), "id"), 1);
    snprintf(target, sizeof target, "/v1/meshes/m/faces?limit=2&cursor=%s",
             text_of(r.json, "next"));
    bench_reply_free(&r);
    r = bench_send(b, "GET", target, NULL, NULL);
    items = cJSON_GetObjectItemCaseSensitive(r.json, "items");
    assert_int_equal(number_of(cJSON_GetArrayItem(items, 0), "id"), 3);
    int revision = (int)number_of(r.json, "revision");
    int degree = (int)number_of(cJSON_GetArrayItem(items, 0), "degree");
    bench_reply_free(&r);
    /* The next page must show the mesh at the revision of the first page, so an edit between the
     * two requests must not change the next page. */
    edit(b, "{\"op\":\"face_poke\",\"face\":3}");
    r = bench_send(b, "GET", target, NULL, NULL);
    assert_int_equal(r.status, 200);
    assert_int_equal(number_of(r.json, "revision"), revision);
    items = cJSON_GetObjectItemCaseSensitive(r.json, "items");
    assert_int_equal(number_of(cJSON_GetArrayItem(items, 0), "id"), 3);
    assert_int_equal(number_of(cJSON_GetArrayItem(items, 0), "degree"), degree);
    bench_reply_free(&r);
    char twice[340];
    snprintf(twice, sizeof twice, "%s&revision=%d", target, revision + 1);
    r = bench_send(b, "GET", twice, NULL, NULL);
    assert_int_equal(r.status, 400);
    assert_string_equal(text_of(r.json, "code"), "bad_cursor");
    bench_reply_free(&r);
    /* `compact` deletes the history, so the next page cannot be read at its revision any more. */
    edit(b, "{\"op\":\"compact\"}");
    r = bench_send(b, "GET", target, NULL, NULL);
    assert_int_equal(r.status, 410);
    assert_string_equal(text_of(r.json, "code"), "revision_gone");
    bench_reply_free(&r);
    bench_free(b);
}

/* --- cost --- */

typedef struct driven {
    bool none, worked, cut;
    int status;
    size_t length;
} driven;

/* If set, a worker that runs a request must stop immediately. */
static bool is_hurried;

static bool has_no_time(void *context, const char *phase, double done)
{
    (void)context;
    (void)phase;
    (void)done;
    return false;
}

/* Runs a request step by step, so that the test sees whether the request moved from the worker to
 * the job pool. Streamed answers are read in pieces of odd sizes. */
static driven drive(api_bench *b, const char *method, const char *path, const char *accept,
                    const char *body)
{
    size_t length = body == NULL ? 0 : strlen(body);
    api_request request = {
        .method = method,
        .path = path,
        .query = "",
        .request_id = "test",
        .headers = {[API_HEADER_ACCEPT] = accept, [API_HEADER_CONTENT_TYPE] = "application/json"},
        .has_length = body != NULL,
        .length = length,
        .has_body = body != NULL};
    driven d = {.none = false};
    api_step step;
    api_exchange *x = api_begin(bench_service(b), &request, &step);
    if (x == NULL) {
        d.none = true;
        return d;
    }
    for (size_t at = 0, used; step == API_MORE && at < length; at += used) {
        step = api_body(x, body + at, length - at, &used);
    }
    if (is_hurried) {
        api_set_worker_progress(x, has_no_time, NULL);
    }
    step = step == API_MORE ? api_end(x) : step;
    if (step == API_WORK) {
        d.worked = true;
        api_work(x);
    }
    const api_answer *answer = api_answer_of(x);
    d.status = answer->status;
    d.length = answer->read == NULL ? (size_t)answer->length : 0;
    char piece[777];
    int64_t got = answer->read == NULL ? 0 : 1;
    for (size_t size = 1; got > 0; size = size * 5 % sizeof piece + 1) {
        got = answer->read(answer->context, piece, size);
        d.length += got > 0 ? (size_t)got : 0;
        d.cut = got < 0;
    }
    assert_true(d.cut || answer->read == NULL || answer->length < 0 ||
                d.length == (size_t)answer->length);
    api_free(x);
    return d;
}

static void expect_place(api_bench *b, const char *path, const char *accept, const char *body,
                         bool worked)
{
    driven d = drive(b, body == NULL ? "GET" : "POST", path, accept, body);
    assert_int_equal(d.status, 200);
    assert_false(d.cut);
    if (d.worked != worked) {
        fail_msg("%s %s: %s the worker", path, body == NULL ? "" : body,
                 d.worked ? "left" : "stayed on");
    }
}

/* A question moves from the worker to the job pool because of its own cost, not because of the size
 * of its mesh. */
static void long_questions_leave_the_worker(void **state)
{
    (void)state;
    static const char walk[] = "/v1/meshes/m/traverse", query[] = "/v1/meshes/m/query";
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"grid\",\"columns\":150,\"rows\":150}");
    expect_place(b, "/v1/meshes/m/vertices/7", NULL, NULL, false);
    expect_place(b, "/v1/meshes/m/vertices", NULL, NULL, false);
    expect_place(b, "/v1/meshes/m/vertices", "application/x-ndjson", NULL, true);
    expect_place(b, "/v1/meshes/m/check", NULL, NULL, true);
    expect_place(b, "/v1/meshes/m/boundaries", NULL, NULL, true);
    expect_place(b, walk, NULL, WALK("\"loop\",\"from\":{\"halfedge\":2}"), false);
    expect_place(b, walk, NULL, WALK("\"rings\",\"from\":{\"vertex\":9},\"depth\":3"), false);
    expect_place(b, walk, NULL, WALK("\"rings\",\"from\":{\"vertex\":9},\"depth\":900"), true);
    expect_place(b, walk, NULL, WALK("\"breadth_first\",\"from\":{\"face\":9},\"limit\":9"), false);
    expect_place(b, walk, NULL, WALK("\"breadth_first\",\"from\":{\"face\":9}"), true);
    expect_place(b, walk, NULL, PATH("\"path\":[\"next\"],\"repeat\":19999"), false);
    expect_place(b, walk, NULL, PATH("\"path\":[\"next\"],\"repeat\":20001"), true);
    expect_place(b, walk, NULL,
                 PATH("\"path\":[\"next\",\"next\",\"twin\"],\"until\":\"boundary\""), false);
    expect_place(b, walk, NULL,
                 WALK("\"shortest_path\",\"from\":{\"vertex\":9},\"to\":{\"vertex\":8}"), true);
    expect_place(b, query, NULL, "{\"queries\":[{\"get\":{\"edge\":3}}]}", false);
    expect_place(b, query, NULL,
                 "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edges\":\"all\"}}]}", true);
    expect_place(b, query, "application/octet-stream",
                 "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edges\":\"all\"}}]}", true);
    expect_place(b, query, NULL,
                 "{\"queries\":[{\"measure\":\"mean_curvature\",\"of\":{\"vertices\":[7,99]}}]}",
                 false);
    expect_place(b, query, NULL,
                 "{\"queries\":[{\"measure\":\"mean_curvature\",\"of\":{\"vertices\":\"all\"}}]}",
                 true);
    /* The first question builds the tree of bounding boxes, for which it moves to the job pool. The
     * second one finds the tree built and stays on the worker. */
    expect_place(b, query, NULL, "{\"queries\":[{\"closest\":[0,0,1]}]}", true);
    expect_place(b, query, NULL, "{\"queries\":[{\"closest\":[0,0,1]}]}", false);
    expect_place(b, query, NULL, "{\"queries\":[{\"self_intersections\":{}}]}", true);
    bench_free(b);
}

/* Returns a document of two faces with many corners that lie back to back. Each face has only one
 * neighbour, but a search for the neighbours visits all corners. */
static char *pillow(unsigned corners)
{
    size_t size = 64 + 64 * (size_t)corners, used = 0;
    char *text = malloc(size);
    assert_non_null(text);
    used += (size_t)snprintf(text, size, "{\"vertices\":[");
    for (unsigned i = 0; i < corners; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s[%u,%u,0]", i == 0 ? "" : ",", i,
                                 i * i % 97);
    }
    used += (size_t)snprintf(text + used, size - used, "],\"faces\":[[");
    for (unsigned i = 0; i < corners; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s%u", i == 0 ? "" : ",", i);
    }
    used += (size_t)snprintf(text + used, size - used, "],[");
    for (unsigned i = corners; i > 0; i--) {
        used += (size_t)snprintf(text + used, size - used, "%s%u", i == corners ? "" : ",", i - 1);
    }
    snprintf(text + used, size - used, "]]}");
    return text;
}

static char *repeated(const char *question, unsigned times)
{
    size_t size = 32 + times * (strlen(question) + 1), used = 0;
    char *text = malloc(size);
    assert_non_null(text);
    used += (size_t)snprintf(text, size, "{\"queries\":[");
    for (unsigned i = 0; i < times; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s%s", i == 0 ? "" : ",", question);
    }
    snprintf(text + used, size - used, "]}");
    return text;
}

/* A request that reads takes longer than a worker may work on it: it is stopped, started again on
 * another thread, and must be answered once. A request that writes is not stopped. */
static void a_read_that_outstays_the_worker_begins_anew(void **state)
{
    (void)state;
    static const struct {
        const char *method, *path, *body;
        bool leaves;
    } asked[] = {
        {"POST", "/v1/meshes/m/query",
         "{\"queries\":[{\"get\":{\"face\":3}},{\"closest\":[1,2,3]}]}", true},
        {"POST", "/v1/meshes/m/traverse",
         "{\"walk\":\"path\",\"from\":{\"halfedge\":0},\"path\":[\"next\"],\"repeat\":9}", true},
        {"GET", "/v1/meshes/m/check", NULL, true},
        {"GET", "/v1/meshes/m/vertices/3", NULL, false},
        {"POST", "/v1/meshes/m/edits",
         "{\"op\":\"vertex_move\",\"vertex\":1,\"by\":[0,0,1],\"dry_run\":true}", false},
    };
    api_bench *b = bench_new();
    put(b, "{\"shape\":\"grid\",\"columns\":5,\"rows\":5}");
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        driven calm = drive(b, asked[i].method, asked[i].path, NULL, asked[i].body);
        is_hurried = true;
        driven hurried = drive(b, asked[i].method, asked[i].path, NULL, asked[i].body);
        is_hurried = false;
        assert_int_equal(calm.status, 200);
        assert_int_equal(hurried.status, 200);
        assert_int_equal(hurried.length, calm.length);
        assert_false(calm.worked);
        assert_int_equal(hurried.worked, asked[i].leaves);
    }
    bench_free(b);
}

/* Requires that a request that repeats `question` `times` times exhausts its budget after at least
 * `least` answers. The client waits up to a minute, so that the request does not become a job. */
static void expect_exhaustion(api_bench *b, const char *question, unsigned times, int least)
{
    static const char *const patient[] = {"Prefer", "wait=60", NULL};
    char *body = repeated(question, times);
    bench_reply r = bench_send(b, "POST", "/v1/meshes/m/query", patient, body);
    assert_int_equal(r.status, 200);
    const cJSON *results = cJSON_GetObjectItemCaseSensitive(r.json, "results");
    assert_int_equal(cJSON_GetArraySize(results), times);
    int answered = 0;
    bool refused = false;
    const cJSON *result;
    cJSON_ArrayForEach(result, results)
    {
        const char *code = text_of(result, "code");
        /* No question after the first refused one may be answered. */
        assert_true(code != NULL || !refused);
        refused = code != NULL;
        answered += code == NULL;
        if (code != NULL) {
            assert_string_equal(code, "limit_exceeded");
            assert_int_equal(number_of(result, "status"), 413);
        }
    }
    if (answered < least || answered == (int)times) {
        fail_msg("%d of %u answered: %s", answered, times, question);
    }
    bench_reply_free(&r);
    free(body);
}

/* Each kind of question that is short but visits a whole mesh is repeated in one request, more
 * often than the budget allows. */
static void the_work_of_a_query_is_bounded(void **state)
{
    (void)state;
    enum { CORNERS = 20000 };
    api_bench *b = bench_new();
    char *document = pillow(CORNERS);
    put(b, document);
    free(document);
    expect_exhaustion(b, "{\"relation\":\"faces\",\"of\":{\"face\":0}}", 700, 400);
    expect_exhaustion(b, "{\"relation\":\"faces\",\"of\":{\"faces\":\"all\"}}", 400, 200);
    expect_exhaustion(b, "{\"relation\":\"faces\",\"of\":{\"faces\":[0,1,0]}}", 400, 100);
    expect_exhaustion(
        b, WALK("\"shortest_path\",\"from\":{\"vertex\":0},\"to\":{\"vertex\":10000}"), 400, 200);
    bench_free(b);
}

/* An answer must not depend on earlier requests. So a question that finds the tree of bounding
 * boxes built costs as much as one that builds it. */
static void a_tree_costs_everybody_the_same(void **state)
{
    (void)state;
    enum { CORNERS = 20000, TIMES = 700 };
    api_bench *b = bench_new();
    char *document = pillow(CORNERS);
    put(b, document);
    free(document);
    char *many = repeated("{\"relation\":\"faces\",\"of\":{\"face\":0}}", TIMES);
    size_t room = strlen(many) + 64;
    char *body = malloc(room);
    assert_non_null(body);
    snprintf(body, room, "{\"queries\":[{\"closest\":[9,9,9]},%s", strchr(many, '[') + 1);
    bench_reply first = bench_expect(200, bench_post(b, "/v1/meshes/m/query", body));
    bench_reply second = bench_expect(200, bench_post(b, "/v1/meshes/m/query", body));
    assert_non_null(strstr(first.body, "limit_exceeded"));
    assert_string_equal(first.body, second.body);
    bench_reply_free(&first);
    bench_reply_free(&second);
    free(many);
    free(body);
    bench_free(b);
}

static void too_many_queries_are_refused(void **state)
{
    (void)state;
    api_bench *b = begin();
    char *body = repeated("{\"get\":{\"edge\":4}}", 10000);
    assert_int_equal(status_of(b, "/v1/meshes/m/query", "Accept", "*/*", body), 200);
    free(body);
    body = repeated("{\"get\":{\"edge\":4}}", 10001);
    assert_int_equal(status_of(b, "/v1/meshes/m/query", "Accept", "*/*", body), 413);
    free(body);
    bench_free(b);
}

/* --- memory --- */

/* Lets the N-th allocation of a request fail, for N = 1, 2, 3 and so on until the request makes
 * fewer than N allocations. */
static void try_without_memory(api_bench *b, const char *path, const char *accept, const char *body)
{
    const char *method = body == NULL ? "GET" : "POST";
    driven whole = drive(b, method, path, accept, body);
    failing f = {.what = path};
    while (failing_next(&f)) {
        driven d = drive(b, method, path, accept, body);
        bool same = d.status == 200 && d.length == whole.length;
        failing_end(&f, same);
        if (!d.none && !d.cut && d.status != 507 && !same) {
            fail_msg("%s %s, allocation %ld: %d", path, body, f.n, d.status);
        }
    }
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static const char walk[] = "/v1/meshes/m/traverse", query[] = "/v1/meshes/m/query";
    api_bench *b = begin();
    for (size_t i = 0; i < READABLE; i++) {
        if (strchr(readable[i], '?') == NULL) {
            try_without_memory(b, readable[i], NULL, NULL);
        }
    }
    try_without_memory(b, "/v1/meshes/m/faces", "application/x-ndjson", NULL);
    try_without_memory(b, "/v1/meshes/m/faces", "application/octet-stream", NULL);
    try_without_memory(b, walk, NULL, WALK("\"loop\",\"from\":{\"halfedge\":2}"));
    try_without_memory(b, walk, NULL, WALK("\"rings\",\"from\":{\"vertex\":1},\"depth\":3"));
    try_without_memory(b, walk, NULL, PATH("\"path\":[\"next\",\"twin\"],\"until\":\"start\""));
    try_without_memory(b, walk, NULL,
                       WALK("\"shortest_path\",\"from\":{\"vertex\":1},\"to\":{\"vertex\":7}"));
    try_without_memory(b, walk, NULL, WALK("\"edge_loop\",\"from\":{\"edge\":5}"));
    try_without_memory(b, query, NULL,
                       "{\"queries\":[{\"get\":{\"face\":1}},{\"get\":{\"face\":0}},"
                       "{\"relation\":\"faces\",\"of\":{\"vertices\":[1,2]}},"
                       "{\"find\":\"halfedge\",\"vertices\":[1,2]}]}");
    try_without_memory(b, query, NULL,
                       "{\"queries\":[{\"measure\":\"mean_curvature\",\"of\":{\"vertex\":1}},"
                       "{\"measure\":\"normal\",\"of\":{\"halfedges\":\"all\"},\"crease\":1},"
                       "{\"measure\":\"normal\",\"of\":{\"vertices\":\"all\"}},"
                       "{\"measure\":\"cotangent\",\"of\":{\"edges\":[4,5]}}]}");
    try_without_memory(b, query, NULL,
                       "{\"queries\":[{\"ray\":{\"origin\":[0,0,0],\"direction\":[0,0,1]}},"
                       "{\"closest\":[0,0,1]},{\"self_intersections\":{}}]}");
    try_without_memory(b, query, "application/octet-stream",
                       "{\"queries\":[{\"measure\":\"normal\",\"of\":{\"faces\":\"all\"}}]}");
    try_without_memory(b, query, "application/octet-stream",
                       "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"edges\":\"all\"}}]}");
    bench_free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_requests_are_refused_by_name),
        cmocka_unit_test(a_bad_question_stops_no_other),
        cmocka_unit_test(octets_answer_one_dense_question),
        cmocka_unit_test(lines_are_not_pages),
        cmocka_unit_test(tags_hold_until_the_mesh_changes),
        cmocka_unit_test(a_cursor_is_of_its_revision),
        cmocka_unit_test(long_questions_leave_the_worker),
        cmocka_unit_test(a_read_that_outstays_the_worker_begins_anew),
        cmocka_unit_test(the_work_of_a_query_is_bounded),
        cmocka_unit_test(a_tree_costs_everybody_the_same),
        cmocka_unit_test(too_many_queries_are_refused),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
