/* Tests of choosing the handler of a request, and of everything that happens before and after the
 * handler runs, in a service whose store has one mesh, "m". */
#include "api/describe/routes.h"
#include "api/json/json_scan.h"
#include "api/request/exchange.h"
#include "query/adjacency.h"

#include "fixture.h"
#include "tests/writing.h"
#include "tests/failing.h"

#include <cjson/cJSON.h>

static api_kept *page_file, *script_file;

static const api_asset *find_asset(void *context, const char *path)
{
    static api_asset page, script;
    (void)context;
    page = (api_asset){"text/html; charset=utf-8", false, page_file};
    script = (api_asset){"text/javascript", true, script_file};
    return strcmp(path, "/") == 0 ? &page : strcmp(path, "/assets/a.js") == 0 ? &script : NULL;
}

static bool not_ready(void *context)
{
    return *(bool *)context;
}

static bool is_ready = true, memory_is_full;

static bool is_full(void *context)
{
    (void)context;
    return memory_is_full;
}

static st_store *store;
static st_mesh *only; /* the only mesh, whose id is "m" */
static api_service *service;

static int set_up(void **state)
{
    (void)state;
    api_options options = {.version = "1.2.3",
                           .max_upload = 100,
                           .asset = find_asset,
                           .ready = not_ready,
                           .is_full = is_full,
                           .ready_context = &is_ready};
    store = st_store_new(&(st_store_options){
        .undo_budget = 1 << 20, .max_meshes = 10, .journal = st_journal_memory()});
    assert_non_null(store);
    assert_int_equal(st_create(store, "m", "", fixture_mesh("012"), NULL, &only), ST_OK);
    page_file = api_kept_new("<p>", 3);
    script_file = api_kept_new("x()", 3);
    assert_true(page_file != NULL && script_file != NULL);
    service = api_service_new(store, api_routes(), &options);
    return service == NULL;
}

static int tear_down(void **state)
{
    (void)state;
    api_service_free(service);
    st_release(only);
    st_store_free(store);
    api_kept_free(page_file);
    api_kept_free(script_file);
    return 0;
}

/* --- requests --- */

typedef struct sent {
    const char *line;    /* for example "GET /v1/meshes?limit=1" */
    const char *headers; /* for example "Name: value\n..." */
    const char *body;    /* NULL if the request has no body */
} sent;

/* The values of the request's headers. They must stay valid until api_free has freed the
 * exchange. */
typedef struct header_list {
    char value[API_REQUEST_HEADERS][256];
} header_list;

static void read_headers(const char *text, header_list *list, api_request *request)
{
    for (const char *at = text; at != NULL && *at != '\0';) {
        size_t name = strcspn(at, ":"), size = strcspn(at, "\n");
        assert_true(name + 2 <= size);
        api_request_header header = api_request_header_find(at, name);
        if (header < API_REQUEST_HEADERS) {
            char *value = list->value[header];
            snprintf(value, sizeof list->value[header], "%.*s", (int)(size - name - 2),
                     at + name + 2);
            request->headers[header] = value;
        }
        at += size + (at[size] == '\n');
    }
}

static api_exchange *send_line(const sent *r, header_list *headers)
{
    char method[16] = "", path[4096] = "";
    size_t space = strcspn(r->line, " ");
    snprintf(method, sizeof method, "%.*s", (int)space, r->line);
    const char *target = r->line + space + 1;
    size_t length = strcspn(target, "?");
    snprintf(path, sizeof path, "%.*s", (int)length, target);
    api_request request = {.method = method,
                           .path = path,
                           .query = target[length] == '?' ? target + length + 1 : "",
                           .request_id = "id-1",
                           .has_body = r->body != NULL,
                           .has_length = r->body != NULL,
                           .length = r->body == NULL ? 0 : strlen(r->body)};
    read_headers(r->headers, headers, &request);
    return api_handle(service, &request, r->body, r->body == NULL ? 0 : strlen(r->body));
}

static const char *answer_header(const api_answer *answer, const char *name)
{
    for (size_t i = 0; i < answer->header_count; i++) {
        if (strcmp(answer->headers[i].name, name) == 0) {
            return answer->headers[i].value;
        }
    }
    return NULL;
}

static bool has_text(const api_answer *answer, const char *text)
{
    size_t size = strlen(text);
    for (size_t i = 0; answer->bytes != NULL && i + size <= (size_t)answer->length; i++) {
        if (memcmp(answer->bytes + i, text, size) == 0) {
            return true;
        }
    }
    return false;
}

/* Returns whether the answer is a problem whose member "code" is `slug`. */
static bool has_code(const api_answer *answer, const char *slug)
{
    char member[80];
    snprintf(member, sizeof member, "\"code\":\"%s\"", slug);
    return has_text(answer, member);
}

#define JSON       "Content-Type: application/json"
#define OTHER_SITE "Sec-Fetch-Site: cross-site"

static const struct {
    sent request;
    int status;
    const char *code; /* code of the expected problem */
} answers[] = {
    {{"GET /livez", NULL, NULL}, 200, NULL},
    {{"GET /readyz", NULL, NULL}, 200, NULL},
    {{"GET /version", NULL, NULL}, 200, NULL},
    {{"HEAD /version", NULL, NULL}, 200, NULL},
    {{"GET /", NULL, NULL}, 200, NULL},
    {{"GET /", "If-None-Match: \"6fde8c182feba3fd\"", NULL}, 304, NULL},
    {{"GET /?page=1", NULL, NULL}, 200, NULL},
    {{"GET /docs/x", "Accept: text/html", NULL}, 404, "no_such_route"},
    {{"GET /docs/x?zzz=1", NULL, NULL}, 400, "unknown_parameter"},
    {{"GET /assets/a.js", NULL, NULL}, 200, NULL},
    {{"GET /assets/b.js", NULL, NULL}, 404, "no_such_route"},
    {{"GET /assets/../a.js", NULL, NULL}, 404, "no_such_route"},
    {{"GET /problems/link_condition", NULL, NULL}, 200, NULL},
    {{"GET /problems/nothing", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/operations", NULL, NULL}, 200, NULL},
    {{"GET /v1/openapi.json", NULL, NULL}, 200, NULL},
    {{"GET /v1/meshes/m", NULL, NULL}, 200, NULL},
    /* unknown paths */
    {{"GET /v1", NULL, NULL}, 200, NULL},
    {{"GET /v1/admin", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/mesh", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/meshes/", NULL, NULL}, 308, NULL},
    {{"GET //v1/meshes", NULL, NULL}, 404, "no_such_route"},
    {{"GET /V1/meshes", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/meshes/m/corners", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/meshes/m/vertices/0/loop", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/meshes/m/vertices/0/edges/1", NULL, NULL}, 404, "no_such_route"},
    {{"GET /v1/meshes%2Fm", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m%2Fn", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m/attributes/vertices%2Ff", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m/attributes%2Fvertices/f", NULL, NULL}, 400, "bad_path"},
    {{"GET /assets%2Fmain.js", NULL, NULL}, 400, "bad_path"},
    {{"GET /docs%2F", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m%00", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m%zz", NULL, NULL}, 400, "bad_path"},
    {{"GET /v1/meshes/m%FF", NULL, NULL}, 400, "bad_path"},
    /* unknown meshes and elements */
    {{"GET /v1/meshes/other", NULL, NULL}, 404, "no_such_mesh"},
    {{"GET /v1/meshes/..", NULL, NULL}, 404, "no_such_mesh"},
    {{"GET /v1/meshes/%2e%2e", NULL, NULL}, 404, "no_such_mesh"},
    {{"GET /v1/meshes/a%20b", NULL, NULL}, 404, "no_such_mesh"},
    {{"PUT /v1/meshes/a%20b", JSON, "{}"}, 400, "bad_id"},
    {{"GET /v1/meshes/m/vertices/x", NULL, NULL}, 404, "no_such_element"},
    {{"GET /v1/meshes/m/vertices/-1", NULL, NULL}, 404, "no_such_element"},
    {{"GET /v1/meshes/m/vertices/4294967296", NULL, NULL}, 404, "no_such_element"},
    {{"GET /v1/meshes/other/vertices/0", NULL, NULL}, 404, "no_such_mesh"},
    /* wrong methods */
    {{"BREW /livez", NULL, NULL}, 405, "method_not_allowed"},
    {{"get /livez", NULL, NULL}, 405, "method_not_allowed"},
    {{"POST /v1/meshes/m", JSON, "{}"}, 405, "method_not_allowed"},
    {{"BREW /nowhere", NULL, NULL}, 404, "no_such_route"},
    {{"OPTIONS /v1/meshes/m", NULL, NULL}, 204, NULL},
    {{"OPTIONS /nowhere", NULL, NULL}, 404, "no_such_route"},
    /* wrong query parameters */
    {{"GET /v1/operations?x=1", NULL, NULL}, 400, "unknown_parameter"},
    {{"GET /v1/meshes?Limit=1", NULL, NULL}, 400, "unknown_parameter"},
    {{"GET /v1/meshes?limit=1&limit=1", NULL, NULL}, 400, "repeated_parameter"},
    {{"GET /v1/meshes?limit=0", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes?limit=10001", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes?limit=-1", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes?limit=1.0", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes?limit=", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes?limit", NULL, NULL}, 400, "bad_query"},
    {{"GET /v1/meshes/m/vertices/0/edges?cw=1", NULL, NULL}, 400, "bad_parameter"},
    {{"GET /v1/meshes/m/components?by=face", NULL, NULL}, 400, "bad_parameter"},
    /* missing and unexpected bodies */
    {{"GET /livez", NULL, "x"}, 400, "unexpected_body"},
    {{"GET /livez", NULL, ""}, 200, NULL},
    {{"POST /v1/meshes/m/query", JSON, NULL}, 400, "missing_body"},
    {{"POST /v1/meshes/m/query", JSON, ""}, 400, "missing_body"},
    {{"POST /v1/meshes/m/query", NULL, "{}"}, 415, "unsupported_media_type"},
    {{"POST /v1/meshes/m/query", "Content-Type: text/plain", "{}"}, 415, "unsupported_media_type"},
    {{"POST /v1/meshes/m/query", "Content-Type: application/json; charset=latin1", "{}"},
     415,
     "unsupported_media_type"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: br", "{}"}, 415, "unsupported_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: deflate", "{}"},
     415,
     "unsupported_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: gzip, gzip", "{}"},
     415,
     "unsupported_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: gzip, identity", "{}"},
     415,
     "unsupported_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: gzip;q=1", "{}"},
     415,
     "unsupported_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: gzip", "{}"}, 400, "bad_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: ZSTD", "{}"}, 400, "bad_encoding"},
    {{"POST /v1/meshes/m/query", JSON "\nContent-Encoding: Identity", "{\"a\":"},
     400,
     "malformed_json"},
    {{"GET /livez", "Content-Encoding: br", NULL}, 200, NULL},
    {{"POST /v1/meshes/m/query", JSON, "{\"queries\":"}, 400, "malformed_json"},
    {{"POST /v1/meshes/m/query", JSON, "{\"a\":1,\"a\":1}"}, 400, "duplicate_member"},
    {{"POST /v1/meshes/m/undo", "Content-Type: text/plain", "{}"}, 415, "unsupported_media_type"},
    /* A browser lets a page of another site send a form without asking the server first, but only
     * with certain media types. A request with one of these types must be refused even if it has no
     * body. */
    {{"POST /v1/meshes/m/copy", "Content-Type: text/plain", NULL}, 415, "unsupported_media_type"},
    {{"POST /v1/meshes/m/copy", "Content-Type: text/plain", ""}, 415, "unsupported_media_type"},
    {{"POST /v1/meshes/m/undo", "Content-Type: text/plain", NULL}, 415, "unsupported_media_type"},
    {{"POST /v1/meshes/m/redo", "Content-Type: application/x-www-form-urlencoded", NULL},
     415,
     "unsupported_media_type"},
    /* requests from pages of other sites */
    {{"GET /v1/meshes/m/check", OTHER_SITE, NULL}, 403, "foreign_origin"},
    {{"HEAD /v1/meshes/m/check", OTHER_SITE, NULL}, 403, NULL},
    {{"GET /v1/meshes/m", "Sec-Fetch-Site: Cross-Site", NULL}, 403, "foreign_origin"},
    {{"GET /v1/meshes/m/content", OTHER_SITE, NULL}, 403, "foreign_origin"},
    {{"GET /v1/meshes/m/vertices", OTHER_SITE, NULL}, 403, "foreign_origin"},
    {{"GET /version", OTHER_SITE, NULL}, 200, NULL},
    {{"GET /", OTHER_SITE, NULL}, 200, NULL},
    {{"GET /v1/operations", OTHER_SITE, NULL}, 200, NULL},
    {{"GET /v1/meshes/m", "Sec-Fetch-Site: same-origin", NULL}, 200, NULL},
    {{"GET /v1/meshes/m", "Sec-Fetch-Site: same-site", NULL}, 200, NULL},
    {{"GET /v1/meshes/m", "Sec-Fetch-Site: none", NULL}, 200, NULL},
    /* The service of this test accepts bodies of at most 100 bytes. */
    {{"POST /v1/meshes", JSON,
      "{\"name\":\"012345678901234567890123456789012345678901234567890123456789012345678901234567"
      "8901234567890123456789\"}"},
     413,
     "body_too_large"},
    /* requests whose header Accept excludes every type that the server can send */
    {{"GET /version", "Accept: text/html", NULL}, 406, "not_acceptable"},
    {{"GET /version", "Accept: application/json;q=0", NULL}, 406, "not_acceptable"},
    {{"GET /version", "Accept: text/html, */*;q=0.1", NULL}, 200, NULL},
    {{"GET /version", "Accept: ", NULL}, 200, NULL},
    {{"GET /version", "Accept-Encoding: identity;q=0, br", NULL}, 406, "not_acceptable"},
    {{"GET /version", "Accept-Encoding: *;q=0", NULL}, 406, "not_acceptable"},
    {{"GET /version", "Accept-Encoding: br", NULL}, 200, NULL},
    {{"GET /version", "Accept-Encoding: ", NULL}, 200, NULL},
    {{"GET /v1/meshes/m/events", "Accept-Encoding: gzip, identity;q=0", NULL},
     406,
     "not_acceptable"},
    {{"GET /problems/syntax", "Accept: application/json", NULL}, 406, "not_acceptable"},
};

static void requests_are_answered(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof answers / sizeof answers[0]; i++) {
        header_list headers;
        api_exchange *x = send_line(&answers[i].request, &headers);
        assert_non_null(x);
        const api_answer *answer = api_answer_of(x);
        if (answer->status != answers[i].status ||
            (answers[i].code != NULL && !has_code(answer, answers[i].code))) {
            fail_msg("%s: %d %.*s", answers[i].request.line, answer->status,
                     (int)(answer->bytes == NULL ? 0 : answer->length), answer->bytes);
        }
        assert_string_equal(answer_header(answer, "X-Request-Id"), "id-1");
        assert_string_equal(answer_header(answer, "X-Content-Type-Options"), "nosniff");
        assert_non_null(answer_header(answer, "Cache-Control"));
        const char *type = answer_header(answer, "Content-Type");
        assert_true(answer->status < 400 ||
                    (type != NULL && strcmp(type, "application/problem+json") == 0));
        assert_true(answer->status != 405 || answer_header(answer, "Allow") != NULL);
        assert_non_null(answer->route);
        api_free(x);
    }
}

static void pages_of_a_configured_origin_may_ask_for_everything(void **state)
{
    (void)state;
    api_request request = {.method = "GET",
                           .path = "/v1/meshes/m",
                           .query = "",
                           .request_id = "id-1",
                           .headers = {[API_HEADER_SEC_FETCH_SITE] = "cross-site"}};
    for (int consent = 0; consent < 2; consent++) {
        request.has_consent = consent != 0;
        api_exchange *x = api_handle(service, &request, NULL, 0);
        assert_non_null(x);
        assert_int_equal(api_answer_of(x)->status, consent != 0 ? 200 : 403);
        api_free(x);
    }
}

static void unknown_names_are_answered_with_those_that_exist(void **state)
{
    (void)state;
    static const struct {
        sent request;
        const char *detail;
    } cases[] = {
        {{"GET /v1/meshes?limt=1", NULL, NULL},
         "this path has no query parameter \\\"limt\\\"; did you mean \\\"limit\\\"?"},
        {{"POST /v1/meshes", JSON, "{\"shape\":\"cub\"}"}, "did you mean \\\"cube\\\"?"},
        {{"POST /v1/meshes", JSON, "{\"shape\":\"ring\"}"}, "; there are tetrahedron, cube,"},
        {{"POST /v1/meshes", JSON, "{\"shape\":\"cube\",\"sise\":1}"},
         "this object cannot have a member \\\"sise\\\"; did you mean \\\"size\\\"?"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        header_list headers;
        api_exchange *x = send_line(&cases[i].request, &headers);
        const api_answer *answer = api_answer_of(x);
        assert_int_equal(answer->status, 400);
        if (!has_text(answer, cases[i].detail)) {
            fail_msg("%.*s", (int)answer->length, answer->bytes);
        }
        api_free(x);
    }
}

static void a_slash_too_many_at_the_end_leads_to_the_path_without_it(void **state)
{
    (void)state;
    static const struct {
        sent request;
        const char *location; /* NULL: the answer is 404 */
    } cases[] = {
        {{"GET /docs/", NULL, NULL}, "../docs"},
        {{"HEAD /docs/", NULL, NULL}, "../docs"},
        {{"GET /v1/", NULL, NULL}, "../v1"},
        {{"GET /v1/meshes/?limit=2", NULL, NULL}, "../meshes?limit=2"},
        {{"GET /v1/meshes/m/faces/0/", NULL, NULL}, "../0"},
        {{"GET /nowhere/", NULL, NULL}, NULL},
        {{"GET /docs//", NULL, NULL}, NULL},
        {{"GET //", NULL, NULL}, NULL},
        {{"POST /v1/meshes/", JSON, "{}"}, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        header_list headers;
        api_exchange *x = send_line(&cases[i].request, &headers);
        const api_answer *answer = api_answer_of(x);
        const char *location = answer_header(answer, "Location");
        assert_int_equal(answer->status, cases[i].location != NULL ? 308 : 404);
        assert_true(cases[i].location == NULL || strcmp(location, cases[i].location) == 0);
        api_free(x);
    }
}

/* Requires that a GET of `path`, which ends in a slash, leads to the last segment without it. */
static void expect_redirect(const char *path, const char *query)
{
    char expected[API_MAX_URI + 8];
    const size_t length = strlen(path) - 1;
    size_t begin = length;
    while (path[begin - 1] != '/') {
        begin--;
    }
    snprintf(expected, sizeof expected, "../%.*s%s%s", (int)(length - begin), path + begin,
             query[0] == '\0' ? "" : "?", query);
    const api_request request = {.method = "GET", .path = path, .query = query, .request_id = "r"};
    api_exchange *x = api_handle(service, &request, NULL, 0);
    assert_int_equal(api_answer_of(x)->status, 308);
    assert_string_equal(answer_header(api_answer_of(x), "Location"), expected);
    api_free(x);
}

static void a_long_path_or_query_is_redirected_as_a_whole(void **state)
{
    (void)state;
    static const char *const folders[] = {"/docs/", "/assets/"};
    char query[API_MAX_URI + 1], path[API_MAX_URI + 1];
    for (size_t bytes = 1000; bytes <= API_MAX_URI - 6; bytes += bytes < 1040 ? 1 : 2384) {
        memset(query, 'a', bytes);
        query[bytes] = '\0';
        expect_redirect("/docs/", query);
    }
    memset(query, 'a', API_MAX_URI - 6);
    query[API_MAX_URI - 6] = '\0';
    expect_redirect("/docs/", query);
    for (size_t i = 0; i < 2; i++) {
        /* The escapes are three times as long as the segment that they stand for. */
        int used = snprintf(path, sizeof path, "%s", folders[i]);
        for (unsigned k = 0; k < API_MAX_SEGMENT; k++) {
            used += snprintf(path + used, sizeof path - (size_t)used, "%%61");
        }
        snprintf(path + used, sizeof path - (size_t)used, "/");
        expect_redirect(path, "");
        query[API_MAX_URI - strlen(path)] = '\0';
        expect_redirect(path, query);
    }
}

static void a_range_of_a_file_is_answered_whole_and_said_not_to_be_taken(void **state)
{
    (void)state;
    header_list headers;
    const sent request = {"GET /v1/meshes/m/content?format=obj", "Range: bytes=0-9", NULL};
    api_exchange *x = send_line(&request, &headers);
    assert_int_equal(api_answer_of(x)->status, 200);
    assert_string_equal(answer_header(api_answer_of(x), "Accept-Ranges"), "none");
    api_free(x);
}

static void allow_lists_the_methods_of_a_path(void **state)
{
    (void)state;
    static const struct {
        const char *line, *allow;
    } lines[] = {
        {"TRACE /v1/meshes", "GET, HEAD, POST, OPTIONS"},
        {"POST /v1/meshes/m", "GET, HEAD, PATCH, PUT, DELETE, OPTIONS"},
        {"DELETE /v1/meshes/m/edits", "POST, GET, HEAD, OPTIONS"},
        {"OPTIONS /v1/meshes/m/undo", "POST, OPTIONS"},
        {"PUT /v1/meshes/m/faces/3/edges", "GET, HEAD, OPTIONS"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        header_list headers;
        sent r = {lines[i].line, NULL, NULL};
        api_exchange *x = send_line(&r, &headers);
        assert_string_equal(answer_header(api_answer_of(x), "Allow"), lines[i].allow);
        api_free(x);
    }
}

static void readiness_is_the_servers_to_say(void **state)
{
    (void)state;
    header_list headers;
    sent r = {"GET /readyz", NULL, NULL};
    is_ready = false;
    api_exchange *x = send_line(&r, &headers);
    assert_int_equal(api_answer_of(x)->status, 503);
    assert_non_null(answer_header(api_answer_of(x), "Retry-After"));
    api_free(x);
    is_ready = true;
    for (int full = 0; full < 2; full++) {
        memory_is_full = full == 1;
        x = send_line(&r, &headers);
        assert_int_equal(api_answer_of(x)->status, 200);
        assert_non_null(strstr(api_answer_of(x)->bytes,
                               full == 1 ? "\"memory\":\"full\"" : "\"memory\":\"free\""));
        api_free(x);
    }
    memory_is_full = false;
}

static void too_long_a_target_is_414(void **state)
{
    (void)state;
    char *path = malloc(API_MAX_URI + 3);
    assert_non_null(path);
    memset(path, 'a', API_MAX_URI + 2);
    path[0] = '/';
    path[API_MAX_URI + 2] = '\0';
    api_request request = {.method = "GET", .path = path, .query = "", .request_id = "r"};
    api_exchange *x = api_handle(service, &request, NULL, 0);
    assert_int_equal(api_answer_of(x)->status, 414);
    api_free(x);
    path[API_MAX_URI] = '\0';
    x = api_handle(service, &request, NULL, 0);
    assert_int_equal(api_answer_of(x)->status, 404);
    api_free(x);
    free(path);
}

static void a_body_without_a_length_meets_the_cap_as_it_comes(void **state)
{
    (void)state;
    api_request request = {
        .method = "GET", .path = "/livez", .query = "", .request_id = "r", .has_body = true};
    api_step step;
    api_exchange *x = api_begin(service, &request, &step);
    assert_int_equal(step, API_MORE);
    size_t used;
    assert_int_equal(api_body(x, "", 0, &used), API_MORE);
    assert_int_equal(api_body(x, "x", 1, &used), API_READY);
    assert_int_equal(api_answer_of(x)->status, 400);
    assert_true(api_answer_of(x)->close);
    assert_int_equal(api_body(x, "x", 1, &used), API_READY);
    assert_int_equal(api_end(x), API_READY);
    api_free(x);
}

static void costly_work_leaves_the_worker(void **state)
{
    (void)state;
    he_mesh *large;
    st_mesh_info info;
    he_soup soup;
    he_soup_init(&soup, NULL);
    for (int i = 0; i <= API_COSTLY_ELEMENTS; i++) {
        assert_int_equal(he_soup_add_vertex(&soup, (he_vec3){i, 0, 0}, NULL), HE_OK);
    }
    assert_int_equal(he_build(&soup, HE_BUILD_TAKE, &large, NULL, NULL), HE_OK);
    he_soup_clear(&soup);
    assert_int_equal(writing_replace(only, large, NULL, &info), ST_OK);
    api_request request = {.method = "GET", .path = "/v1/meshes/m", .query = "", .request_id = "r"};
    api_step step;
    api_exchange *x = api_begin(service, &request, &step);
    assert_int_equal(step, API_MORE);
    assert_int_equal(api_end(x), API_WORK);
    api_work(x);
    assert_int_equal(api_answer_of(x)->status, 200);
    assert_int_equal(api_answer_of(x)->shown.incarnation, info.incarnation);
    assert_int_equal(api_answer_of(x)->shown.position, info.position);
    api_free(x);
    assert_int_equal(writing_replace(only, fixture_mesh("012"), NULL, NULL), ST_OK);
}

static void a_large_document_is_read_off_the_worker(void **state)
{
    (void)state;
    size_t length = API_COSTLY_UPLOAD + 1;
    char *body = malloc(length);
    assert_non_null(body);
    memset(body, ' ', length);
    memcpy(body, "{\"a\":1,\"a\":2}", 13);
    api_request request = {.method = "POST",
                           .path = "/v1/meshes/m/query",
                           .query = "",
                           .request_id = "r",
                           .headers = {[API_HEADER_CONTENT_TYPE] = "application/json"},
                           .has_body = true};
    api_step step;
    api_exchange *x = api_begin(service, &request, &step);
    assert_int_equal(step, API_MORE);
    size_t used;
    assert_int_equal(api_body(x, body, length, &used), API_MORE);
    assert_int_equal(api_end(x), API_WORK);
    api_work(x);
    assert_int_equal(api_answer_of(x)->status, 400);
    assert_true(has_code(api_answer_of(x), "duplicate_member"));
    api_free(x);
    free(body);
}

/* Fails if a JSON object has two members with the same name. The objects may have any number of
 * members: the OpenAPI document has more than 256 schemas, which the parser of request bodies would
 * refuse. */
static void expect_no_repeated_member(const cJSON *value, const char *line)
{
    const cJSON *child;
    cJSON_ArrayForEach(child, value)
    {
        for (const cJSON *other = value->child; cJSON_IsObject(value) && other != child;
             other = other->next) {
            if (strcmp(other->string, child->string) == 0) {
                fail_msg("%s: \"%s\" is given twice", line, child->string);
            }
        }
        expect_no_repeated_member(child, line);
    }
}

static void documents_of_the_tables_are_json(void **state)
{
    (void)state;
    static const char *const lines[] = {"GET /v1/operations", "GET /v1/openapi.json"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        header_list headers;
        sent r = {lines[i], NULL, NULL};
        api_exchange *x = send_line(&r, &headers);
        const api_answer *answer = api_answer_of(x);
        api_problem problem = {0};
        const api_in_options options = {.values = 1000000};
        const api_bytes text = {answer->bytes, (size_t)answer->length};
        if (!api_json_scan(text, &options, &problem)) {
            fail_msg("%s: %s at %s", lines[i], problem.detail, problem.pointer);
        }
        cJSON *document = cJSON_ParseWithLength(answer->bytes, (size_t)answer->length);
        assert_non_null(document);
        expect_no_repeated_member(document, lines[i]);
        cJSON_Delete(document);
        api_free(x);
    }
}

/* Checks that the entries of the route table are complete and consistent. */
static void rows_are_whole(void **state)
{
    (void)state;
    for (size_t i = 0; i < api_routes().count; i++) {
        const api_route *route = &api_routes().rows[i];
        assert_non_null(route->run);
        assert_non_null(route->name);
        assert_non_null(route->summary);
        assert_non_null(route->produces);
        assert_int_equal(route->body_kind == API_BODY_UPLOAD, route->body != NULL);
        assert_int_equal(route->body_kind == API_BODY_NONE, route->consumes == NULL);
        assert_true(route->statuses[0] >= 200 && route->statuses[0] < 300);
        assert_true((route->flags & API_FIXED) || route->doc != NULL);
        assert_int_equal(route->statuses[API_ROUTE_STATUSES - 1], 0);
        assert_null(route->parameters[API_ROUTE_PARAMETERS - 1]);
        for (size_t s = 0; route->statuses[s] != 0; s++) {
            for (const int *common = api_route_common(); *common != 0; common++) {
                assert_int_not_equal(route->statuses[s], *common);
            }
            assert_true(s == 0 || route->statuses[s] > route->statuses[s - 1]);
        }
        for (size_t j = 0; j < i; j++) {
            assert_true(strcmp(route->path, api_routes().rows[j].path) != 0 ||
                        strcmp(route->method, api_routes().rows[j].method) != 0);
            assert_string_not_equal(route->name, api_routes().rows[j].name);
        }
    }
}

static const api_route *row_named(const char *name)
{
    for (size_t i = 0; i < api_routes().count; i++) {
        if (strcmp(api_routes().rows[i].name, name) == 0) {
            return &api_routes().rows[i];
        }
    }
    return NULL;
}

static void each_relation_of_each_kind_has_a_row(void **state)
{
    (void)state;
    size_t rows = 0;
    for (size_t i = 0; i < api_routes().count; i++) {
        rows += api_routes().rows[i].relation != NULL;
        assert_null(strstr(api_routes().rows[i].path, "{kind}"));
    }
    assert_int_equal(rows, he_relation_count());
    for (size_t i = 0; i < he_relation_count(); i++) {
        const he_relation *relation = he_relation_at(i);
        char name[64], response[64], path[100];
        snprintf(name, sizeof name, "list_%s_%s", he_kind_name(relation->of), relation->name);
        snprintf(response, sizeof response, "%s_%s", he_kind_name(relation->of), relation->name);
        snprintf(path, sizeof path, "/v1/meshes/{mesh}/%s/{id}/%s", he_kind_plural(relation->of),
                 relation->name);
        const api_route *row = row_named(name);
        assert_non_null(row);
        assert_string_equal(row->path, path);
        assert_string_equal(row->response, response);
        assert_string_equal(row->relation, relation->name);
        assert_int_equal(row->kind, relation->of);
    }
}

static void what_is_not_there_is_refused_with_what_is(void **state)
{
    (void)state;
    static const struct {
        const char *line, *detail;
    } paths[] = {
        {"GET /v1/meshes/m/vertices/0/loop",
         "\"loop\" is not one of vertices, outgoing, incoming, edges, faces"},
        {"POST /v1/meshes/m/edges/0/edges", "\"edges\" is not one of vertices, halfedges, faces"},
        {"GET /v1/meshes/m/attributes/corners/a",
         "\"corners\" is not one of vertices, halfedges, edges, faces, mesh"},
        {"GET /v1/mesh", "\"mesh\" is not one of meshes, jobs, token, tickets, admin, operations, "
                         "problems, openapi.json"},
        {"GET /v1/admin", "the path must continue with one of reload, backup"},
        {"GET /v1/meshes/m/vertices/0/edges/1",
         "the server has no path \"/v1/meshes/m/vertices/0/edges/1\""},
    };
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        header_list headers;
        const sent request = {paths[i].line, NULL, NULL};
        api_exchange *x = send_line(&request, &headers);
        assert_non_null(x);
        assert_int_equal(api_answer_of(x)->status, 404);
        assert_int_equal(x->problem.code, API_NO_SUCH_ROUTE);
        assert_string_equal(x->problem.detail, paths[i].detail);
        api_free(x);
    }
}

/* Whichever allocation fails, the request must get a complete answer, unless api_handle returns no
 * exchange at all. */
static void every_failed_allocation_is_answered(void **state)
{
    (void)state;
    static const sent requests[] = {
        {"GET /version", NULL, NULL},
        {"GET /v1/operations", NULL, NULL},
        {"GET /v1/meshes/m", NULL, NULL},
        {"GET /v1/meshes/m/vertices/0?x=1", NULL, NULL},
        {"POST /v1/meshes/m/query", JSON, "{\"queries\":7}"},
        {"OPTIONS /livez", NULL, NULL},
    };
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++) {
        failing f = {.may_succeed = true};
        while (failing_next(&f)) {
            header_list headers;
            api_exchange *x = send_line(&requests[i], &headers);
            failing_end(&f, x != NULL);
            if (x != NULL && !f.is_over && api_answer_of(x)->status != 507 &&
                api_answer_of(x)->status >= 400) {
                /* The answer is an error, even if no allocation fails. If one does fail, the error
                 * must nevertheless have a body. */
                assert_true(api_answer_of(x)->length > 0);
            }
            assert_true(x == NULL || api_answer_of(x)->status >= 200);
            api_free(x);
        }
        assert_true(f.n > 1);
    }
}

static void documents_are_written_and_compressed_once(void **state)
{
    (void)state;
    static const char *const lines[] = {"GET /v1/operations", "GET /v1/openapi.json",
                                        "GET /assets/a.js"};
    static const char *const accepted[] = {NULL, "Accept-Encoding: gzip", "Accept-Encoding: zstd"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        for (size_t k = 0; k < sizeof accepted / sizeof *accepted; k++) {
            const sent request = {lines[i], accepted[k], NULL};
            header_list headers;
            api_exchange *first = send_line(&request, &headers);
            api_exchange *second = send_line(&request, &headers);
            assert_int_equal(api_answer_of(first)->status, 200);
            assert_ptr_equal(api_answer_of(first)->bytes, api_answer_of(second)->bytes);
            const char *coding = answer_header(api_answer_of(first), "Content-Encoding");
            assert_true((coding == NULL) == (k == 0 || i == 2)); /* a.js is too short to compress */
            api_free(first);
            api_free(second);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(requests_are_answered),
        cmocka_unit_test(documents_are_written_and_compressed_once),
        cmocka_unit_test(pages_of_a_configured_origin_may_ask_for_everything),
        cmocka_unit_test(unknown_names_are_answered_with_those_that_exist),
        cmocka_unit_test(a_slash_too_many_at_the_end_leads_to_the_path_without_it),
        cmocka_unit_test(a_long_path_or_query_is_redirected_as_a_whole),
        cmocka_unit_test(a_range_of_a_file_is_answered_whole_and_said_not_to_be_taken),
        cmocka_unit_test(allow_lists_the_methods_of_a_path),
        cmocka_unit_test(readiness_is_the_servers_to_say),
        cmocka_unit_test(too_long_a_target_is_414),
        cmocka_unit_test(a_body_without_a_length_meets_the_cap_as_it_comes),
        cmocka_unit_test(costly_work_leaves_the_worker),
        cmocka_unit_test(a_large_document_is_read_off_the_worker),
        cmocka_unit_test(documents_of_the_tables_are_json),
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(each_relation_of_each_kind_has_a_row),
        cmocka_unit_test(what_is_not_there_is_refused_with_what_is),
        cmocka_unit_test(every_failed_allocation_is_answered),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
