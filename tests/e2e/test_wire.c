/* Bytes that a hostile or broken client may send. Each case must get its documented answer, and the
 * mesh must be unchanged in every bit afterwards. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static daemon_process *server;
static client *http;
static char mesh_path[128];
static char *content;

static int start(void **state)
{
    (void)state;
    server = daemon_start(NULL);
    http = client_new(server);
    reply r = client_post(http, "/v1/meshes", "{\"shape\":\"torus\"}");
    if (r.status != 201) {
        return -1;
    }
    snprintf(mesh_path, sizeof mesh_path, "/v1/meshes/%s", reply_string(&r, "id"));
    reply_free(&r);
    char path[160];
    snprintf(path, sizeof path, "%s/content", mesh_path);
    r = client_get(http, path);
    content = r.body;
    r.body = NULL;
    reply_free(&r);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    client_free(http);
    free(content);
    return daemon_stop(server);
}

static void expect_unchanged(void)
{
    char path[160];
    snprintf(path, sizeof path, "%s/content", mesh_path);
    reply r = client_get(http, path);
    assert_int_equal(r.status, 200);
    assert_string_equal(r.body, content);
    reply_free(&r);
}

/* Returns the request with the Origin that the daemon's own pages have in this run, which begins
 * with https over TLS. The caller must free it. */
static char *with_own_origin(const char *request)
{
    static const char wanted[] = "Origin: http://localhost";
    const char *at = transport_get() == TRANSPORT_TLS ? strstr(request, wanted) : NULL;
    size_t size = strlen(request) + 2;
    char *own = malloc(size);
    assert_non_null(own);
    if (at == NULL) {
        memcpy(own, request, size - 1);
    } else {
        (void)snprintf(own, size, "%.*sOrigin: https%s", (int)(at - request), request,
                       at + strlen("Origin: http"));
    }
    return own;
}

static void expect_raw(const char *request, int status)
{
    char *own = with_own_origin(request);
    char *answer = client_raw(server, own, strlen(own), 1, false);
    free(own);
    if (client_raw_status(answer) != status) {
        fail_msg("expected %d for:\n%s\ngot:\n%s", status, request, answer);
    }
    free(answer);
}

#define HOST "Host: localhost\r\n"
#define FILES                                                                                      \
    "Content-Type: multipart/form-data; boundary=x\r\nContent-Length: 92\r\n\r\n"                  \
    "--x\r\nContent-Disposition: form-data; name=\"a.obj\"\r\n\r\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 " \
    "2 3\n\r\n--x--"

static void hostile_requests_get_their_status_and_change_no_mesh(void **state)
{
    (void)state;
    static const struct {
        const char *request;
        int status;
    } rows[] = {
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Length: 2\r\nContent-Length: 3\r\n\r\n{}",
         400},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Length: 2\r\nContent-Length: 2\r\n\r\n{}",
         400},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
         400},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Transfer-Encoding: gzip\r\n\r\n{}",
         400},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n\r\n2\r\n{}\r\n0\r\n\r\n",
         400},
        {"GET /livez HTTP/1.1\r\n" HOST "Host: 127.0.0.1\r\n\r\n", 400},
        {"GET /livez HTTP/1.1\r\n\r\n", 400},
        {"GET /livez HTTP/1.1\r\nHost: evil.example\r\n\r\n", 421},
        {"GET /livez HTTP/1.1\r\nHost: localhost.evil.example\r\n\r\n", 421},
        {"GET /livez HTTP/1.1\r\nHost: [::1]:9\r\n\r\n", 200},
        {"GET /livez HTTP/1.1\r\nHost: 127.0.0.1:1234\r\n\r\n", 200},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Length: 10737418240\r\n\r\n",
         413},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: text/plain\r\n"
         "Content-Length: 2\r\n\r\n{}",
         415},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Encoding: gzip\r\nContent-Length: 2\r\n\r\n{}",
         400},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Encoding: gzip, gzip\r\nContent-Length: 2\r\n\r\n{}",
         415},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
         "Content-Encoding: gzip\r\nContent-Encoding: gzip\r\nContent-Length: 2\r\n\r\n{}",
         415},
        {"GET /livez HTTP/1.1\r\n" HOST
         "Accept-Encoding: gzip\r\nAccept-Encoding: identity;q=0, *;q=0\r\n\r\n",
         200},
        {"GET /livez HTTP/1.1\r\n" HOST
         "Accept-Encoding: identity;q=0\r\nAccept-Encoding: br\r\n\r\n",
         406},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: http://evil.example\r\n"
         "Content-Type: application/json\r\nContent-Length: 16\r\n\r\n{\"shape\":\"cube\"}",
         403},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: null\r\n"
         "Content-Type: application/json\r\nContent-Length: 16\r\n\r\n{\"shape\":\"cube\"}",
         403},
        /* A form on any web page can send the media type multipart/form-data without a preflight
         * request, so the daemon checks the origin. */
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: http://evil.example\r\n" FILES, 403},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: null\r\n" FILES, 403},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Sec-Fetch-Site: cross-site\r\n" FILES, 403},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Sec-Fetch-Site: same-site\r\n" FILES, 403},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: http://localhost\r\n" FILES, 201},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST FILES, 201},
        {"POST /v1/meshes HTTP/1.1\r\n" HOST "Origin: http://localhost\r\n"
         "Content-Type: application/json\r\nContent-Length: 16\r\n\r\n{\"shape\":\"cube\"}",
         201},
        {"GET /v1/../etc/passwd HTTP/1.1\r\n" HOST "\r\n", 404},
        {"GET /assets/../../../etc/passwd HTTP/1.1\r\n" HOST "\r\n", 404},
        {"GET /assets/%2e%2e/%2e%2e/etc/passwd HTTP/1.1\r\n" HOST "\r\n", 404},
        {"GET /assets/..%2f..%2fetc%2fpasswd HTTP/1.1\r\n" HOST "\r\n", 400},
        {"GET /v1/meshes/a%00b HTTP/1.1\r\n" HOST "\r\n", 400},
        {"GET /v1/meshes/%zz HTTP/1.1\r\n" HOST "\r\n", 400},
        {"GET //v1/meshes HTTP/1.1\r\n" HOST "\r\n", 404},
        {"GET /v1/meshes?unknown=1 HTTP/1.1\r\n" HOST "\r\n", 400},
        {"GET /v1/meshes?limit=0 HTTP/1.1\r\n" HOST "\r\n", 400},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        expect_raw(rows[i].request, rows[i].status);
    }
    expect_unchanged();
}

/* An ambiguous request must not leave a second request behind on its connection (request
 * smuggling). */
static void an_ambiguous_request_smuggles_no_second_one(void **state)
{
    (void)state;
    static const char request[] =
        "POST /v1/meshes HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
        "Content-Length: 0\r\nTransfer-Encoding: chunked\r\n\r\n"
        "0\r\n\r\nGET /livez HTTP/1.1\r\n" HOST "\r\n";
    char *answer = client_raw(server, request, sizeof request - 1, 0, false);
    assert_int_equal(client_raw_status(answer), 400);
    assert_null(strstr(answer + 1, "HTTP/1.1 200"));
    free(answer);
}

static void a_long_target_gets_414_and_150_headers_get_431(void **state)
{
    (void)state;
    enum { LONG = 20000 };
    char *request = malloc(LONG + 200);
    assert_non_null(request);
    int n = snprintf(request, 200, "GET /v1/meshes/");
    memset(request + n, 'a', LONG);
    static const char rest[] = " HTTP/1.1\r\n" HOST "\r\n";
    memcpy(request + n + LONG, rest, sizeof rest);
    expect_raw(request, 414);
    free(request);
    request = malloc(200 * 200);
    assert_non_null(request);
    n = snprintf(request, 100, "GET /livez HTTP/1.1\r\n" HOST);
    for (int i = 0; i < 150; i++) {
        n += snprintf(request + n, 200, "X-Header-%d: some value that is not too short\r\n", i);
    }
    snprintf(request + n, 10, "\r\n");
    expect_raw(request, 431);
    free(request);
}

static void an_edit_sent_in_part_changes_nothing(void **state)
{
    (void)state;
    char request[512];
    int n = snprintf(request, sizeof request,
                     "POST %s/edits HTTP/1.1\r\n" HOST "Content-Type: application/json\r\n"
                     "Content-Length: 400\r\n\r\n{\"op\":\"face_poke\",\"face\":0}",
                     mesh_path);
    for (int i = 0; i < 20; i++) {
        free(client_raw(server, request, (size_t)n, 0, true));
    }
    expect_unchanged();
}

static void a_bad_edit_gets_its_code_and_changes_nothing(void **state)
{
    (void)state;
    static const struct {
        const char *body;
        int status;
        const char *code;
    } rows[] = {
        {"", 400, "missing_body"},
        {"{", 400, "malformed_json"},
        {"[]", 400, "wrong_type"},
        {"{\"op\":\"face_poke\",\"face\":0,}", 400, "malformed_json"},
        {"{\"op\":\"face_poke\",\"face\":0} x", 400, "malformed_json"},
        {"{\"op\":\"face_poke\",\"face\":0,\"face\":1}", 400, "duplicate_member"},
        {"{\"op\":\"face_poke\",\"face\":0,\"extra\":1}", 400, "unknown_member"},
        {"{\"op\":\"face_poke\",\"face\":-1}", 400, NULL},
        {"{\"op\":\"face_poke\",\"face\":1.5}", 400, NULL},
        {"{\"op\":\"face_poke\",\"face\":\"0\"}", 400, NULL},
        {"{\"op\":\"face_poke\",\"face\":4294967296}", 400, NULL},
        {"{\"op\":\"face_poke\"}", 400, "missing_member"},
        {"{\"op\":\"none\",\"face\":0}", 400, "unknown_operation"},
        {"{\"op\":\"vertex_move\",\"vertex\":0,\"to\":[0,0,NaN]}", 400, "malformed_json"},
        {"{\"op\":\"vertex_move\",\"vertex\":0,\"to\":[0,0,1e999]}", 400, NULL},
        {"{\"op\":\"vertex_move\",\"vertex\":0,\"to\":[0,0]}", 400, NULL},
        {"{\"op\":\"edge_split\",\"edge\":0,\"t\":1.5}", 400, NULL},
        {"{\"ops\":[]}", 400, NULL},
        {"{\"ops\":[{\"op\":\"vertex_move\",\"vertex\":\"$a.vertex\",\"to\":[0,0,0]}]}", 400,
         "bad_reference"},
        {"{\"op\":\"face_poke\",\"face\":100000}", 422, "no_such_element"},
        {"{\"op\":\"face_add\",\"vertices\":[0,1]}", 422, "too_few_corners"},
        {"{\"op\":\"edge_split\",\"edge\":0,\"t\":0.5,\"expected_revision\":9}", 412,
         "stale_revision"},
    };
    char path[160];
    snprintf(path, sizeof path, "%s/edits", mesh_path);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        reply r = client_post(http, path, rows[i].body);
        if (r.status != rows[i].status) {
            fail_msg("%s: status %ld: %s", rows[i].body, r.status, r.body);
        }
        if (rows[i].code != NULL) {
            assert_string_equal(reply_string(&r, "code"), rows[i].code);
        }
        assert_true(strlen(reply_string(&r, "detail")) > 3);
        assert_true(strlen(reply_string(&r, "request_id")) > 0);
        char type[80];
        assert_string_equal(reply_header(&r, "Content-Type", type, sizeof type),
                            "application/problem+json");
        reply_free(&r);
    }
    expect_unchanged();
}

static void meshes_that_cannot_be_are_refused_with_their_code(void **state)
{
    (void)state;
#define SQUARE "\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1]]"
    static const struct {
        const char *body;
        int status;
        const char *code;
    } rows[] = {
        {"{" SQUARE ",\"faces\":[[0,1,2],[0,1,3]]}", 422, "orientation"},
        {"{" SQUARE ",\"faces\":[[0,1,2],[1,0,3],[0,1,4]]}", 422, "nonmanifold_edge"},
        {"{" SQUARE ",\"faces\":[[0,1,1]]}", 422, "repeated_corner"},
        {"{" SQUARE ",\"faces\":[[0,1]]}", 422, "too_few_corners"},
        {"{" SQUARE ",\"faces\":[[0,1,9]]}", 422, "bad_index"},
        {"{" SQUARE ",\"faces\":[[0,1,-1]]}", 400, NULL},
        {"{\"vertices\":[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[2,0,0],[0,2,0],[0,0,2]],"
         "\"faces\":[[0,2,1],[0,3,2],[0,1,3],[1,2,3],[0,5,4],[0,6,5],[0,4,6],[4,5,6]]}",
         422, "closed_fan"},
        {"{\"vertices\":[[0,0]]}", 400, NULL},
        {"{\"vertices\":[[0,0,1e999]]}", 400, NULL},
        {"{\"vertices\":[[0,0,0]],\"vertices\":[]}", 400, "duplicate_member"},
        {"{\"vertices\":[[0,0,0]],\"colour\":1}", 400, "unknown_member"},
        {"{\"shape\":\"cube\",\"vertices\":[]}", 400, "conflicting_members"},
        {"{\"shape\":\"teapot\"}", 400, NULL},
        {"{\"shape\":\"cube\",\"size\":-1}", 400, NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        reply r = client_post(http, "/v1/meshes", rows[i].body);
        if (r.status != rows[i].status) {
            fail_msg("%s: status %ld: %s", rows[i].body, r.status, r.body);
        }
        if (rows[i].code != NULL) {
            assert_string_equal(reply_string(&r, "code"), rows[i].code);
        }
        reply_free(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hostile_requests_get_their_status_and_change_no_mesh),
        cmocka_unit_test(an_ambiguous_request_smuggles_no_second_one),
        cmocka_unit_test(a_long_target_gets_414_and_150_headers_get_431),
        cmocka_unit_test(an_edit_sent_in_part_changes_nothing),
        cmocka_unit_test(a_bad_edit_gets_its_code_and_changes_nothing),
        cmocka_unit_test(meshes_that_cannot_be_are_refused_with_their_code),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
