/* Every route must answer with each status that it declares, and with no other one. */
#include "tests/api/fan.h"

#include "api/describe/routes.h"
#include "api/request/handlers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* One request of a sequence. Each request finds the meshes as the requests before it left them. */
typedef struct step {
    const char *method, *target;
    int status;
    const char *body;
    const char *headers[5]; /* pairs */
} step;

#define CUBE  "{\"shape\":\"cube\"}"
#define TEXT  "Content-Type", "text/plain"
#define FILES "Content-Type", "multipart/form-data; boundary=x"
#define ONE_FILE                                                                               \
    "--x\r\nContent-Disposition: form-data; name=\"a.obj\"\r\n\r\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" \
    "f 1 2 3\n\r\n--x--"
#define MINIMAL  "Prefer", "return=minimal"
#define STALE    "If-Match", "\"0-0-0-x\""
#define ABSENT   "If-None-Match", "*"
#define ANY      "If-None-Match", "*"
#define DRAG(id) "{\"op\":\"deform\",\"vertex\":" id ",\"by\":[0,0,1]}"
#define LARGE    "{\"shape\":\"grid\",\"columns\":200,\"rows\":200}"
#define ASYNC    "Prefer", "respond-async"
#define BIG      "too big" /* a placeholder for a body that is longer than a JSON request may be */

static const step steps[] = {
    {"PUT", "/v1/meshes/m", 201, CUBE, {ABSENT}},
    {"PUT", "/v1/meshes/m", 412, CUBE, {ABSENT}},
    {"PUT", "/v1/meshes/m", 412, CUBE, {STALE}},
    {"PUT", "/v1/meshes/m", 200, CUBE, {NULL}},
    {"PUT", "/v1/meshes/m", 204, CUBE, {MINIMAL}},
    {"PUT", "/v1/meshes/m", 415, CUBE, {TEXT}},
    {"PUT", "/v1/meshes/m", 422, "{\"vertices\":[],\"faces\":[[0,1,2]]}", {NULL}},
    {"PUT", "/v1/meshes/m", 413, BIG, {NULL}},
    {"PUT", "/v1/meshes/m", 400, "{", {NULL}},
    {"PUT", "/v1/meshes/m", 200, ONE_FILE, {FILES}},
    {"PUT", "/v1/meshes/m", 400, "--x", {FILES}},
    {"PUT", "/v1/meshes/m", 422, "--x--", {FILES}},
    {"PUT", "/v1/meshes/m", 200, CUBE, {NULL}},

    {"POST", "/v1/meshes", 201, CUBE, {NULL}},
    {"POST", "/v1/meshes?id=n", 201, CUBE, {NULL}},
    {"POST", "/v1/meshes?id=n", 409, CUBE, {NULL}},
    {"POST", "/v1/meshes", 413, BIG, {NULL}},
    {"POST", "/v1/meshes", 415, CUBE, {TEXT}},
    {"POST", "/v1/meshes", 201, ONE_FILE, {FILES}},
    {"POST", "/v1/meshes", 400, "--x", {FILES}},
    {"POST", "/v1/meshes", 422, "--x--", {FILES}},
    {"POST", "/v1/meshes", 422, "{\"vertices\":[],\"faces\":[[0,1,2]]}", {NULL}},
    {"GET", "/v1/meshes", 200, NULL, {NULL}},
    {"GET", "/v1/meshes?cursor=?", 400, NULL, {NULL}},
    {"GET", "/v1/meshes", 406, NULL, {"Accept", "image/png"}},
    {"DELETE", "/v1/meshes", 405, NULL, {NULL}},

    {"GET", "/v1/meshes/m", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/none", 404, NULL, {NULL}},
    {"PATCH", "/v1/meshes/m", 200, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/m", 204, "{\"name\":null}", {MINIMAL}},
    {"PATCH", "/v1/meshes/m", 412, "{\"name\":\"y\"}", {STALE}},
    {"PATCH", "/v1/meshes/m", 413, BIG, {NULL}},
    {"PATCH", "/v1/meshes/m", 415, "{}", {TEXT}},
    {"DELETE", "/v1/meshes/n", 412, NULL, {STALE}},
    {"DELETE", "/v1/meshes/n", 204, NULL, {NULL}},
    {"PUT", "/v1/meshes/e", 201, CUBE, {NULL}},
    {"GET", "/v1/meshes/m/content", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/content?format=obj", 304, NULL, {ANY}},
    {"PUT", "/v1/meshes/far", 201, "{\"vertices\":[[1e39,0,0]],\"faces\":[]}", {NULL}},
    {"GET", "/v1/meshes/far/content?format=glb", 422, NULL, {NULL}},
    {"GET", "/v1/meshes/m/content", 406, NULL, {"Accept", "image/png"}},
    {"GET", "/v1/meshes/m/geometry", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/geometry", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/geometry", 406, NULL, {"Accept", "application/json"}},
    {"GET", "/v1/meshes/none/geometry", 404, NULL, {NULL}},
    {"PUT", "/v1/meshes/t", 201, "{\"shape\":\"icosphere\"}", {NULL}},
    {"GET", "/v1/meshes/t/progressive", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/t/progressive", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/progressive", 422, NULL, {NULL}},
    {"GET", "/v1/meshes/t/progressive?faces=x", 400, NULL, {NULL}},
    {"GET", "/v1/meshes/t/progressive", 406, NULL, {"Accept", "application/json"}},
    {"GET", "/v1/meshes/none/progressive", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/t/progressive?max_error=-1", 400, NULL, {NULL}},
    {"GET", "/v1/meshes/t/progressive?revision=99", 404, NULL, {NULL}},
    {"POST", "/v1/meshes/m/copy", 201, "{\"id\":\"c\"}", {NULL}},
    {"POST", "/v1/meshes/m/copy", 409, "{\"id\":\"c\"}", {NULL}},
    {"POST", "/v1/meshes/m/copy", 412, NULL, {STALE}},
    {"POST", "/v1/meshes/m/copy", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/copy", 415, "{}", {TEXT}},

    {"GET", "/v1/meshes/m/faces/77", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/m/faces/x", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/m/faces/0/none", 404, NULL, {NULL}},

    {"GET", "/v1/meshes/m/materials", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/materials", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/attributes", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/attributes", 304, NULL, {ANY}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 201, "{\"type\":\"bool\"}", {NULL}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 200, "{\"type\":\"bool\"}", {NULL}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 204, "{\"type\":\"bool\"}", {MINIMAL}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 412, "{\"type\":\"bool\"}", {STALE}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 413, BIG, {NULL}},
    {"PUT", "/v1/meshes/m/attributes/faces/selected", 415, "{}", {TEXT}},
    {"PUT",
     "/v1/meshes/m/attributes/faces/selected",
     422,
     "{\"type\":\"bool\",\"values\":[true]}",
     {NULL}},
    {"PUT", "/v1/meshes/m/attributes/vertices/position", 400, "{\"type\":\"bool\"}", {NULL}},
    {"PUT", "/v1/meshes/m/attributes/none/a", 404, "{\"type\":\"bool\"}", {NULL}},
    {"GET", "/v1/meshes/m/attributes/faces/selected", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/attributes/faces/selected", 304, NULL, {ANY}},
    {"PUT",
     "/v1/meshes/m/attributes/mesh/huge",
     201,
     "{\"type\":\"double\",\"value\":1e300}",
     {NULL}},
    {"GET",
     "/v1/meshes/m/attributes/mesh/huge?type=float",
     422,
     NULL,
     {"Accept", "application/octet-stream"}},
    {"DELETE", "/v1/meshes/m/attributes/mesh/huge", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/attributes/faces/none", 404, NULL, {NULL}},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/selected",
     200,
     "{\"ids\":[0],\"value\":true}",
     {NULL}},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/selected",
     204,
     "{\"ids\":\"all\",\"value\":true}",
     {MINIMAL}},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/selected",
     412,
     "{\"ids\":[0],\"value\":true}",
     {STALE}},
    {"PATCH", "/v1/meshes/m/attributes/faces/selected", 413, BIG, {NULL}},
    {"PATCH", "/v1/meshes/m/attributes/faces/selected", 415, "{}", {TEXT}},
    {"PATCH",
     "/v1/meshes/m/attributes/faces/selected",
     422,
     "{\"ids\":[99],\"value\":true}",
     {NULL}},
    {"DELETE", "/v1/meshes/m/attributes/faces/selected", 412, NULL, {STALE}},
    {"DELETE", "/v1/meshes/m/attributes/faces/selected", 200, NULL, {NULL}},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {NULL}},
    {"DELETE", "/v1/meshes/m/attributes/faces/selected", 204, NULL, {MINIMAL}},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {NULL}},

    {"POST", "/v1/meshes/m/query", 200, "{\"queries\":[{\"get\":{\"edge\":0}}]}", {NULL}},
    {"POST", "/v1/meshes/m/query", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/query", 415, "{}", {TEXT}},
    {"POST",
     "/v1/meshes/m/query",
     422,
     "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"faces\":[99]}}]}",
     {"Accept", "application/octet-stream"}},
    {"POST", "/v1/meshes/m/traverse", 200, "{\"walk\":\"loop\",\"from\":{\"halfedge\":0}}", {NULL}},
    {"POST", "/v1/meshes/m/traverse", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/traverse", 415, "{}", {TEXT}},
    {"POST",
     "/v1/meshes/m/traverse",
     422,
     "{\"walk\":\"loop\",\"from\":{\"halfedge\":99}}",
     {NULL}},
    {"POST", "/v1/meshes/m/deform", 200, DRAG("0"), {NULL}},
    {"POST", "/v1/meshes/m/deform", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/deform", 415, "{}", {TEXT}},
    {"POST", "/v1/meshes/m/deform", 422, DRAG("99"), {NULL}},
    {"GET", "/v1/meshes/m/boundaries", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/boundaries", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/components", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/components", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/check", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/check", 304, NULL, {ANY}},
    {"GET", "/v1/meshes/m/check", 202, NULL, {ASYNC}},

    {"POST", "/v1/meshes/m/compare", 200, "{\"with\":\"t\"}", {NULL}},
    {"POST", "/v1/meshes/m/compare", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/compare", 415, "{}", {TEXT}},
    {"POST", "/v1/meshes/m/compare", 410, "{\"with\":1}", {NULL}},
    {"POST", "/v1/meshes/m/compare", 422, "{\"with\":\"none\"}", {NULL}},
    {"POST", "/v1/meshes/m/compare", 202, "{\"with\":\"t\"}", {ASYNC}},

    {"POST", "/v1/meshes/e/undo", 409, NULL, {NULL}},
    {"POST", "/v1/meshes/e/redo", 409, NULL, {NULL}},
    {"POST", "/v1/meshes/m/edits", 200, "{\"op\":\"face_poke\",\"face\":0}", {NULL}},
    {"POST", "/v1/meshes/m/edits", 204, "{\"op\":\"face_delete\",\"face\":0}", {MINIMAL}},
    {"POST", "/v1/meshes/m/edits", 412, "{\"op\":\"face_poke\",\"face\":1}", {STALE}},
    {"POST", "/v1/meshes/m/edits", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/edits", 415, "{}", {TEXT}},
    {"POST", "/v1/meshes/m/edits", 422, "{\"op\":\"face_poke\",\"face\":99}", {NULL}},
    {"GET", "/v1/meshes/m/edits", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/edits", 304, NULL, {ANY}},
    {"PATCH", "/v1/meshes/m/edits/99", 404, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/m/edits/0", 404, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/m/edits/x", 404, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/m/edits/1", 410, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/1", 410, "{\"name\":\"x\"}", {NULL}},
    {"POST", "/v1/meshes/e/edits", 200, "{\"op\":\"face_poke\",\"face\":0}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 200, "{\"name\":\"poked\"}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 200, "{}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 400, "{\"name\":2}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 400, "{\"title\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 412, "{\"name\":\"y\"}", {STALE}},
    {"PATCH", "/v1/meshes/e/edits/2", 413, BIG, {NULL}},
    {"PATCH", "/v1/meshes/e/edits/2", 415, "{}", {TEXT}},
    {"PATCH", "/v1/meshes/e/edits/2", 204, "{\"name\":null}", {MINIMAL}},
    {"PATCH", "/v1/meshes/none/edits/2", 404, "{}", {NULL}},
    {"GET", "/v1/meshes/e/edits/2", 405, NULL, {NULL}},
    {"GET", "/v1/meshes/m/presence", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/none/presence", 404, NULL, {NULL}},
    {"PUT", "/v1/meshes/m/presence", 200, "{\"client\":\"a\"}", {NULL}},
    {"PUT", "/v1/meshes/m/presence", 204, "{\"client\":\"a\"}", {MINIMAL}},
    {"PUT", "/v1/meshes/m/presence", 400, "{}", {NULL}},
    {"PUT", "/v1/meshes/m/presence", 413, BIG, {NULL}},
    {"PUT", "/v1/meshes/m/presence", 415, "{}", {TEXT}},
    {"PUT", "/v1/meshes/none/presence", 404, "{\"client\":\"a\"}", {NULL}},
    {"POST", "/v1/meshes/m/undo", 412, NULL, {STALE}},
    {"POST", "/v1/meshes/m/undo", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/undo", 415, "{}", {TEXT}},
    {"POST", "/v1/meshes/m/undo", 410, "{\"to_revision\":1}", {NULL}},
    {"POST", "/v1/meshes/m/undo", 422, "{\"to_revision\":99}", {NULL}},
    {"POST", "/v1/meshes/m/undo", 200, NULL, {NULL}},
    {"POST", "/v1/meshes/m/undo", 204, "{}", {MINIMAL}},
    {"POST", "/v1/meshes/m/redo", 412, NULL, {STALE}},
    {"POST", "/v1/meshes/m/redo", 413, BIG, {NULL}},
    {"POST", "/v1/meshes/m/redo", 415, "{}", {TEXT}},
    {"POST", "/v1/meshes/m/redo", 410, "{\"to_revision\":1}", {NULL}},
    {"POST", "/v1/meshes/m/redo", 422, "{\"to_revision\":99}", {NULL}},
    {"POST", "/v1/meshes/m/redo", 200, NULL, {NULL}},
    {"POST", "/v1/meshes/m/redo", 204, NULL, {MINIMAL}},

    {"GET", "/v1/meshes/m/events", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/events?since=1", 200, NULL, {NULL}},
    {"HEAD", "/v1/meshes/m/events", 200, NULL, {NULL}},
    {"GET", "/v1/meshes/m/events?since=x", 400, NULL, {NULL}},
    {"GET", "/v1/meshes/none/events", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/m/events", 406, NULL, {"Accept", "application/json"}},
    /* The revision 1 existed before the mesh was replaced, and the revision 99 never did. */
    {"GET", "/v1/meshes/m?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m?revision=99", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/m?revision=0", 400, NULL, {NULL}},
    {"GET", "/v1/meshes/m/content?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/progressive?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/geometry?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/geometry?revision=99", 404, NULL, {NULL}},
    {"GET", "/v1/meshes/m/geometry?revision=9&since=1&layout=1", 400, NULL, {NULL}},
    {"GET", "/v1/meshes/m/boundaries?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/components?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/check?revision=1", 410, NULL, {NULL}},
    {"POST", "/v1/meshes/m/copy?revision=1", 410, NULL, {NULL}},
    {"POST",
     "/v1/meshes/m/query?revision=1",
     410,
     "{\"queries\":[{\"get\":{\"edge\":0}}]}",
     {NULL}},
    {"POST",
     "/v1/meshes/m/traverse?revision=1",
     410,
     "{\"walk\":\"loop\",\"from\":{\"halfedge\":0}}",
     {NULL}},
    {"GET", "/v1/meshes/m/materials?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/attributes?revision=1", 410, NULL, {NULL}},
    {"GET", "/v1/meshes/m/attributes/faces/selected?revision=1", 410, NULL, {NULL}},

    {"GET", "/v1/meshes/m", 202, NULL, {ASYNC}},
    {"GET", "/v1/meshes/m/content", 202, NULL, {ASYNC}},
    {"GET", "/v1/meshes/m/geometry", 202, NULL, {ASYNC}},
    {"GET", "/v1/meshes/m/progressive", 202, NULL, {ASYNC}},
    {"GET", "/v1/meshes/m/boundaries", 202, NULL, {ASYNC}},
    {"GET", "/v1/meshes/m/components", 202, NULL, {ASYNC}},
    {"POST", "/v1/meshes/m/query", 202, "{\"queries\":[]}", {ASYNC}},
    {"POST",
     "/v1/meshes/m/traverse",
     202,
     "{\"walk\":\"rings\",\"from\":{\"vertex\":1},\"depth\":1}",
     {ASYNC}},
    {"POST", "/v1/meshes/m/deform", 202, DRAG("1"), {ASYNC}},
    {"POST", "/v1/meshes?id=job", 202, CUBE, {ASYNC}},
    {"PUT", "/v1/meshes/job", 202, CUBE, {ASYNC}},
    {"POST", "/v1/meshes/m/copy", 202, NULL, {ASYNC}},
    {"POST", "/v1/meshes/m/edits", 202, "{\"op\":\"face_poke\",\"face\":1}", {ASYNC}},
    {"PUT", "/v1/meshes/large", 201, LARGE, {NULL}},
    {"PUT", "/v1/meshes/large/attributes/faces/a", 201, "{\"type\":\"bool\"}", {NULL}},
    {"GET", "/v1/meshes/large/attributes/faces/a", 202, NULL, {ASYNC}},
    {"POST", "/v1/meshes/large/edits", 202, "{\"op\":\"compact\"}", {ASYNC}},
    {"POST", "/v1/meshes/large/edits", 409, "{\"op\":\"face_poke\",\"face\":1}", {NULL}},
    {"PUT", "/v1/meshes/large/attributes/faces/a", 409, "{\"type\":\"bool\"}", {NULL}},
    {"PATCH", "/v1/meshes/large/attributes/faces/a", 409, "{\"ids\":[0],\"value\":true}", {NULL}},
    {"DELETE", "/v1/meshes/large/attributes/faces/a", 409, NULL, {NULL}},
    {"PATCH", "/v1/meshes/large", 409, "{\"name\":\"x\"}", {NULL}},
    {"PATCH", "/v1/meshes/large/edits/2", 409, "{\"name\":\"x\"}", {NULL}},
    {"PUT", "/v1/meshes/large", 409, CUBE, {NULL}},
    {"GET", "/v1/jobs", 200, NULL, {NULL}},
    {"GET", "/v1/jobs?cursor=?", 400, NULL, {NULL}},
    {"GET", "/v1/jobs/none", 404, NULL, {NULL}},
    {"GET", "/v1/jobs/none/events", 404, NULL, {NULL}},
    {"DELETE", "/v1/jobs/none", 404, NULL, {NULL}},

    {"GET", "/v1/token", 200, NULL, {NULL}},
    {"POST", "/v1/tickets", 200, "{\"path\":\"/v1/meshes\"}", {NULL}},
    {"POST", "/v1/tickets", 400, "{\"path\":\"/v1/undo\"}", {NULL}},
    {"POST", "/v1/tickets", 413, BIG, {NULL}},
    {"POST", "/v1/tickets", 415, "{}", {TEXT}},
    {"POST", "/v1/admin/reload", 200, NULL, {NULL}},
    {"GET", "/v1/operations", 200, NULL, {NULL}},
    {"GET", "/v1/operations", 304, NULL, {ANY}},
    {"GET", "/v1/problems", 200, NULL, {NULL}},
    {"GET", "/v1/problems", 304, NULL, {ANY}},
    {"GET", "/v1/openapi.json", 200, NULL, {NULL}},
    {"GET", "/v1/openapi.json", 304, NULL, {ANY}},
    {"GET", "/livez", 200, NULL, {NULL}},
    {"GET", "/readyz", 200, NULL, {NULL}},
    {"GET", "/metrics", 200, NULL, {NULL}},
    {"GET", "/version", 200, NULL, {NULL}},
    {"GET", "/v1", 200, NULL, {NULL}},
    {"GET", "/problems/closed_fan", 200, NULL, {NULL}},
    {"GET", "/problems/boundary_edge", 303, NULL, {NULL}},
    {"GET", "/problems/none", 404, NULL, {NULL}},
};

enum { MOST_ROUTES = 128, STATUSES = 600 };

static bool seen[MOST_ROUTES][STATUSES];

static int route_index(const char *method, const char *path)
{
    for (size_t i = 0; i < api_routes().count; i++) {
        if (strcmp(api_routes().rows[i].path, path) == 0 &&
            strcmp(api_routes().rows[i].method, method) == 0) {
            return (int)i;
        }
    }
    return -1;
}

static bool holds(const int *statuses, int status)
{
    for (; *statuses != 0; statuses++) {
        if (*statuses == status) {
            return true;
        }
    }
    return false;
}

/* Sends `request` and requires that the answer has the status `status`. */
static void take(api_bench *b, int status, const bench_request *request)
{
    const char *method = request->method;
    bench_reply r = bench_send_bytes(b, request);
    if (r.status != status) {
        fail_msg("%s %s: %d instead of %d: %s", method, request->target, r.status, status, r.body);
    }
    if (status >= 400) {
        assert_string_equal(bench_header(&r, "Content-Type"), "application/problem+json");
        assert_non_null(r.json);
        assert_int_equal(cJSON_GetObjectItem(r.json, "status")->valueint, status);
    }
    int i = route_index(method, r.route);
    if (i >= 0) {
        seen[i][status] = true;
        if (!holds(api_routes().rows[(size_t)i].statuses, status) &&
            !holds(api_route_common(), status)) {
            fail_msg("%s %s answers %d, which it does not declare", method, r.route, status);
        }
    }
    bench_reply_free(&r);
}

/* Gets a cursor of a list, then deletes the mesh and creates another one with the same id. The
 * cursor must then be answered with 410. */
static void take_stale_cursor(api_bench *b, const char *collection)
{
    char target[300];
    snprintf(target, sizeof target, "/v1/meshes/m/%s?limit=1", collection);
    bench_reply r = bench_send(b, "GET", target, NULL, NULL);
    assert_int_equal(r.status, 200);
    const cJSON *next = cJSON_GetObjectItem(r.json, "next");
    assert_true(cJSON_IsString(next));
    snprintf(target, sizeof target, "/v1/meshes/m/%s?cursor=%s", collection, next->valuestring);
    bench_reply_free(&r);
    take(b, 204, &(bench_request){"DELETE", "/v1/meshes/m", NULL, NULL, 0});
    take(b, 201, &(bench_request){"PUT", "/v1/meshes/m", NULL, CUBE, sizeof CUBE - 1});
    static const char poke[] = "{\"op\":\"face_poke\",\"face\":1}";
    take(b, 200, &(bench_request){"POST", "/v1/meshes/m/edits", NULL, poke, sizeof poke - 1});
    take(b, 200, &(bench_request){"POST", "/v1/meshes/m/undo", NULL, NULL, 0});
    take(b, 410, &(bench_request){"GET", target, NULL, NULL, 0});
}

/* Requests all routes of elements, which differ only in the kind of element and the relation.
 * Revision 1 of the mesh "r" is a 410, because the mesh was replaced. */
static void take_elements(api_bench *b)
{
    static const char mesh[] = "/v1/meshes/{mesh}/", id[] = "/{id}";
    static const char *const any[] = {ANY, NULL}, *const async[] = {ASYNC, NULL};
    char path[100], past[120];
    take(b, 201, &(bench_request){"PUT", "/v1/meshes/r", NULL, CUBE, sizeof CUBE - 1});
    take(b, 200, &(bench_request){"PUT", "/v1/meshes/r", NULL, CUBE, sizeof CUBE - 1});
    for (size_t i = 0; i < api_routes().count; i++) {
        const char *template = api_routes().rows[i].path, *at = strstr(template, id);
        if (at == NULL && api_routes().rows[i].run != api_elements_list) {
            continue;
        }
        const char *kind = template + sizeof mesh - 1;
        snprintf(path, sizeof path, "/v1/meshes/r/%.*s%s%s", (int)strcspn(kind, "/"), kind,
                 at == NULL ? "" : "/0", at == NULL ? "" : at + sizeof id - 1);
        snprintf(past, sizeof past, "%s?revision=1", path);
        take(b, 200, &(bench_request){"GET", path, NULL, NULL, 0});
        take(b, 304, &(bench_request){"GET", path, any, NULL, 0});
        take(b, 410, &(bench_request){"GET", past, NULL, NULL, 0});
        if (at == NULL) {
            take(b, 202, &(bench_request){"GET", path, async, NULL, 0});
        }
    }
}

/* Sends a request with its path as Idempotency-Key, and repeats it while the first one is running,
 * which is refused (409). A later repetition gets the first answer, and a request with the same key
 * and another body is refused (422). */
static void take_keyed(api_bench *b, const char *method, const char *path, const char *json)
{
    enum { LONG = 300 << 10 };
    const char *const keyed[] = {"Idempotency-Key", path, NULL};
    char *body = malloc(LONG);
    assert_non_null(body);
    memset(body, ' ', LONG);
    memcpy(body, json, strlen(json));
    api_step next;
    api_request request = {
        .method = method,
        .path = path,
        .query = "",
        .request_id = "r",
        .headers =
            {[API_HEADER_CONTENT_TYPE] = "application/json", [API_HEADER_IDEMPOTENCY_KEY] = path},
        .has_length = true,
        .length = LONG,
        .has_body = true};
    api_exchange *x = api_begin(bench_service(b), &request, &next);
    assert_non_null(x);
    size_t used;
    assert_int_equal(api_body(x, body, LONG, &used), API_MORE);
    assert_int_equal(api_end(x), API_WORK);
    take(b, 409, &(bench_request){method, path, keyed, body, LONG});
    api_work(x);
    int status = api_answer_of(x)->status;
    assert_true(status == 200 || status == 201);
    api_free(x);
    take(b, status, &(bench_request){method, path, keyed, body, LONG});
    take(b, 422, &(bench_request){method, path, keyed, body, LONG - 1});
    free(body);
}

static void take_keyed_edits(api_bench *b)
{
    static const char *const steps_of_keyed[] = {"edits", "undo", "redo"};
    static const char *const bodies[] = {"{\"op\":\"face_poke\",\"face\":0}", "{}", "{}"};
    take(b, 201, &(bench_request){"PUT", "/v1/meshes/k", NULL, CUBE, sizeof CUBE - 1});
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/k/%s", steps_of_keyed[i]);
        take_keyed(b, "POST", path, bodies[i]);
    }
    take_keyed(b, "PATCH", "/v1/meshes/k/edits/2", "{\"name\":\"z\"}");
}

/* A client with another token has the id that a client wants to show itself with (409). */
static void take_other_client(void)
{
    /* the SHA-256 hashes of the tokens "test" and "prueba" */
    api_bench *b = bench_new_guarded(
        "alice admin sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08\n"
        "bob read sha256:655e786674d9d3e77bc05ed1de37b4b6bc89f788829f9f3c679e7687b410c89b\n");
    static const char client[] = "{\"client\":\"a\"}";
    const bench_request request = {"PUT", "/v1/meshes/m/presence", NULL, client, sizeof client - 1};
    bench_use_token(b, "test");
    take(b, 201, &(bench_request){"PUT", "/v1/meshes/m", NULL, CUBE, sizeof CUBE - 1});
    take(b, 200, &request);
    bench_use_token(b, "prueba");
    take(b, 409, &request);
    bench_free(b);
}

static void take_job(api_bench *b)
{
    bench_reply r =
        bench_send(b, "POST", "/v1/meshes/m/copy", (const char *const[]){ASYNC, NULL}, NULL);
    assert_int_equal(r.status, 202);
    const char *path = bench_header(&r, "Location");
    char events[80];
    snprintf(events, sizeof events, "%s/events", path);
    take(b, 200, &(bench_request){"GET", path, NULL, NULL, 0});
    take(b, 200, &(bench_request){"GET", events, NULL, NULL, 0});
    take(b, 202, &(bench_request){"DELETE", path, NULL, NULL, 0});
    take(b, 204, &(bench_request){"DELETE", path, NULL, NULL, 0});
    bench_reply_free(&r);
}

static void take_result(api_bench *b)
{
    char path[80];
    bench_reply r =
        bench_send(b, "GET", "/v1/meshes/m/content", (const char *const[]){ASYNC, NULL}, NULL);
    assert_int_equal(r.status, 202);
    snprintf(path, sizeof path, "%s/result", bench_header(&r, "Location"));
    take(b, 202, &(bench_request){"GET", path, NULL, NULL, 0});
    bench_run_jobs(b, BENCH_JOBS);
    take(b, 200, &(bench_request){"GET", path, NULL, NULL, 0});
    take(b, 304, &(bench_request){"GET", path, (const char *const[]){ANY, NULL}, NULL, 0});
    take(b, 404, &(bench_request){"GET", "/v1/jobs/none/result", NULL, NULL, 0});
    bench_reply_free(&r);
}

static void take_costly_check(api_bench *b)
{
    fan_put(b, "/v1/meshes/fan", 3001, 1201);
    take(b, 413,
         &(bench_request){"GET", "/v1/meshes/fan/check?self_intersections=true", NULL, NULL, 0});
}

static void routes_answer_each_status_they_declare_and_no_other(void **state)
{
    (void)state;
    enum { TOO_BIG = 9 << 20 };
    char *big = malloc(TOO_BIG);
    assert_non_null(big);
    memset(big, ' ', TOO_BIG);
    api_bench *b = bench_new();
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const step *s = &steps[i];
        bool is_big = s->body != NULL && strcmp(s->body, BIG) == 0;
        size_t length = is_big ? TOO_BIG : s->body == NULL ? 0 : strlen(s->body);
        take(b, s->status,
             &(bench_request){s->method, s->target, s->headers, is_big ? big : s->body, length});
    }
    take_elements(b);
    take_stale_cursor(b, "vertices");
    take_stale_cursor(b, "edits");
    take_keyed(b, "POST", "/v1/meshes", CUBE);
    take_keyed(b, "PATCH", "/v1/meshes/m", "{\"name\":\"z\"}");
    take_keyed(b, "POST", "/v1/meshes/m/copy", "{}");
    static const char flag[] = "{\"type\":\"bool\"}";
    take(b, 201,
         &(bench_request){"PUT", "/v1/meshes/m/attributes/faces/a", NULL, flag, sizeof flag - 1});
    take_keyed(b, "PATCH", "/v1/meshes/m/attributes/faces/a", "{\"ids\":[0],\"value\":true}");
    take_keyed_edits(b);
    take_other_client();
    take_job(b);
    take_result(b);
    take_costly_check(b);
    take(b, 409, &(bench_request){"POST", "/v1/admin/backup", NULL, NULL, 0});
    bench_keep(b, "bytes");
    take(b, 200,
         &(bench_request){"POST", "/v1/admin/backup",
                          (const char *const[]){"Prefer", "wait=10", NULL}, NULL, 0});
    take(b, 202, &(bench_request){"POST", "/v1/admin/backup", NULL, NULL, 0});
    bench_run_jobs(b, BENCH_JOBS);
    take(b, 409,
         &(bench_request){"POST", "/v1/admin/backup",
                          (const char *const[]){"Prefer", "wait=10", NULL}, NULL, 0});
    bench_change_tokens(b, "nothing");
    take(b, 409, &(bench_request){"POST", "/v1/admin/reload", NULL, NULL, 0});
    size_t missing = 0;
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *route = &api_routes().rows[i];
        if (strncmp(route->path, "/assets", 7) == 0 || strcmp(route->path, "/") == 0 ||
            strncmp(route->path, "/docs", 5) == 0) {
            continue; /* web pages need the real server: tests/e2e and tests/web request them */
        }
        for (const int *status = route->statuses; *status != 0; status++) {
            if (!seen[i][*status]) {
                print_error("%s %s never answered %d\n", route->method, route->path, *status);
                missing++;
            }
        }
    }
    assert_int_equal(missing, 0);
    bench_free(b);
    free(big);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(routes_answer_each_status_they_declare_and_no_other)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
