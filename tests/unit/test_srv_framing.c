/* Requests that are ambiguous, too large, or for somebody else: refused, each with its code. */
#include "tests/unit/fixture.h"

#include "api/limits.h"
#include "server/http_framing.h"
#include "server/http_policy.h"

/* "Name: value\n" lines. */
static void set_fields(srv_head *head, const char *lines)
{
    head->field_count = 0;
    head->bytes = 0;
    while (*lines != '\0') {
        const char *colon = strchr(lines, ':'), *end = strchr(lines, '\n');
        assert_true(colon != NULL && end != NULL && colon < end);
        const char *value = colon + 1 + (colon[1] == ' ' ? 1 : 0);
        if (head->field_count < SRV_MAX_FIELDS) {
            head->fields[head->field_count] =
                (srv_field){lines, value, (size_t)(colon - lines), (size_t)(end - value)};
        }
        head->field_count++;
        head->bytes += (size_t)(end - lines);
        lines = end + 1;
    }
}

static int code_of(const char *method, const char *target, const char *version, const char *fields,
                   srv_framing *framing)
{
    srv_head head = {.method = method, .target = target, .version = version};
    api_problem problem = {0};
    set_fields(&head, fields);
    bool ok = srv_framing_check(&head, framing, &problem);
    assert_true(ok == (problem.code == HE_OK));
    return problem.code;
}

#define HOST "Host: localhost\n"

static void test_lines_and_fields(void **state)
{
    (void)state;
    static const struct {
        const char *method, *target, *version, *fields;
        int code;
    } rows[] = {
        {"GET", "/", "HTTP/1.1", HOST, HE_OK},
        {"PATCH", "/a?b=c&d", "HTTP/1.1", HOST, HE_OK},
        {"GET", "/", "HTTP/1.0", "", HE_OK},
        {"GET", "/", "HTTP/1.1", "", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.2", HOST, API_BAD_FRAMING},
        {"GET", "/", "HTTP/2.0", HOST, API_BAD_FRAMING},
        {"GET", "/", "http/1.1", HOST, API_BAD_FRAMING},
        {"GET", "/", "", HOST, API_BAD_FRAMING},
        {"", "/", "HTTP/1.1", HOST, API_BAD_FRAMING},
        {"G T", "/", "HTTP/1.1", HOST, API_BAD_FRAMING},
        {"G@T", "/", "HTTP/1.1", HOST, API_BAD_FRAMING},
        {"PROPPATCHPROPPATCH", "/", "HTTP/1.1", HOST, API_BAD_FRAMING},
        {"GET", "", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "*", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "a/b", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "?a=b", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/a b", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/a\tb", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/a#b", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/\xc3\xa9", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/\x7f", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "http://localhost/a", "HTTP/1.1", HOST, HE_OK},
        {"GET", "HTTP://localhost", "HTTP/1.1", HOST, HE_OK},
        {"GET", "http://localhost?x=1", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "https://localhost/", "HTTP/1.1", HOST, API_BAD_PATH},
        {"CONNECT", "localhost:80", "HTTP/1.1", HOST, API_BAD_PATH},
        {"GET", "/", "HTTP/1.1", HOST "Content-Length : 3\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "a b: 3\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST ": 3\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "X: a\rb\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "X: a\x01\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "X: a\x7f\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "X: a\tb \xc3\xa9\n", HE_OK},
        {"GET", "/", "HTTP/1.1", HOST HOST, API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.1", HOST "hOST: localhost\n", API_BAD_FRAMING},
        {"GET", "/", "HTTP/1.0", HOST HOST, API_BAD_FRAMING},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_framing framing;
        int code =
            code_of(rows[i].method, rows[i].target, rows[i].version, rows[i].fields, &framing);
        if (code != rows[i].code) {
            fail_msg("row %zu: %s %s: %s, not %s", i, rows[i].method, rows[i].target,
                     api_code_slug(code), api_code_slug(rows[i].code));
        }
    }
}

#define TE "Transfer-Encoding: "
#define CL "Content-Length: "

static void test_bodies(void **state)
{
    (void)state;
    static const struct {
        const char *fields;
        int code;
        bool chunked;
        int64_t length; /* -1: none */
    } rows[] = {
        {CL "0\n", HE_OK, false, 0},
        {CL "12\n", HE_OK, false, 12},
        {CL "0012\n", HE_OK, false, 12},
        {CL "9223372036854775807\n", HE_OK, false, INT64_MAX},
        {CL "99999999999999999999\n", API_BAD_FRAMING, false, -1},
        {CL "\n", API_BAD_FRAMING, false, -1},
        {CL "+5\n", API_BAD_FRAMING, false, -1},
        {CL "-1\n", API_BAD_FRAMING, false, -1},
        {CL "0x10\n", API_BAD_FRAMING, false, -1},
        {CL "1e1\n", API_BAD_FRAMING, false, -1},
        {CL "5 \n", API_BAD_FRAMING, false, -1},
        {CL "5, 5\n", API_BAD_FRAMING, false, -1},
        {CL "5;5\n", API_BAD_FRAMING, false, -1},
        {CL "5\n" CL "5\n", API_BAD_FRAMING, false, -1},
        {CL "5\n" CL "6\n", API_BAD_FRAMING, false, -1},
        {CL "5\ncontent-length: 5\n", API_BAD_FRAMING, false, -1},
        {TE "chunked\n", HE_OK, true, -1},
        {TE "CHUNKED\n", HE_OK, true, -1},
        {TE "chunked\n" CL "5\n", API_BAD_FRAMING, false, -1},
        {CL "0\n" TE "chunked\n", API_BAD_FRAMING, false, -1},
        {TE "chunked\n" TE "chunked\n", API_BAD_FRAMING, false, -1},
        {TE "chunked\n" TE "identity\n", API_BAD_FRAMING, false, -1},
        {TE "identity\n", API_BAD_FRAMING, false, -1},
        {TE "gzip\n", API_BAD_FRAMING, false, -1},
        {TE "gzip, chunked\n", API_BAD_FRAMING, false, -1},
        {TE "chunked, identity\n", API_BAD_FRAMING, false, -1},
        {TE "xchunked\n", API_BAD_FRAMING, false, -1},
        {TE "chunked \n", API_BAD_FRAMING, false, -1},
        {TE "\n", API_BAD_FRAMING, false, -1},
    };
    char fields[256];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_framing framing;
        snprintf(fields, sizeof fields, HOST "%s", rows[i].fields);
        int code = code_of("POST", "/", "HTTP/1.1", fields, &framing);
        if (code != rows[i].code) {
            fail_msg("%s: %s, not %s", rows[i].fields, api_code_slug(code),
                     api_code_slug(rows[i].code));
        }
        if (code == HE_OK) {
            assert_int_equal(framing.chunked, rows[i].chunked);
            assert_int_equal(framing.has_length, rows[i].length >= 0);
            assert_true(rows[i].length < 0 || framing.length == (uint64_t)rows[i].length);
        }
    }
    srv_framing framing;
    assert_int_equal(code_of("POST", "/", "HTTP/1.0", TE "chunked\n", &framing), API_BAD_FRAMING);
}

static void test_targets_are_split(void **state)
{
    (void)state;
    static const struct {
        const char *target, *path, *query, *authority;
    } rows[] = {
        {"/", "/", "", NULL},     {"/a/b?c=d?e", "/a/b", "c=d?e", NULL}, {"/a?", "/a", "", NULL},
        {"//a", "//a", "", NULL}, {"http://h:1/a?b", "/a", "b", "h:1"},  {"http://h", "/", "", "h"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_framing f;
        assert_int_equal(code_of("GET", rows[i].target, "HTTP/1.1", HOST, &f), HE_OK);
        assert_int_equal(f.path_length, strlen(rows[i].path));
        assert_memory_equal(f.path, rows[i].path, f.path_length);
        assert_string_equal(f.query, rows[i].query);
        assert_int_equal(f.authority == NULL, rows[i].authority == NULL);
        if (f.authority != NULL) {
            assert_int_equal(f.authority_length, strlen(rows[i].authority));
            assert_memory_equal(f.authority, rows[i].authority, f.authority_length);
        }
    }
}

static void test_sizes(void **state)
{
    (void)state;
    char target[API_MAX_URI + 2];
    srv_framing framing;
    memset(target, 'a', sizeof target);
    target[0] = '/';
    target[API_MAX_URI] = '\0';
    assert_int_equal(code_of("GET", target, "HTTP/1.1", HOST, &framing), HE_OK);
    target[API_MAX_URI] = 'a';
    target[API_MAX_URI + 1] = '\0';
    assert_int_equal(code_of("GET", target, "HTTP/1.1", HOST, &framing), API_URI_TOO_LONG);

    char fields[(SRV_MAX_FIELDS + 1) * 8 + 32];
    size_t at = (size_t)snprintf(fields, sizeof fields, HOST);
    for (int i = 1; i < SRV_MAX_FIELDS; i++) {
        at += (size_t)snprintf(fields + at, sizeof fields - at, "X%d: a\n", i);
    }
    assert_int_equal(code_of("GET", "/", "HTTP/1.1", fields, &framing), HE_OK);
    snprintf(fields + at, sizeof fields - at, "Y: a\n");
    assert_int_equal(code_of("GET", "/", "HTTP/1.1", fields, &framing), API_HEADERS_TOO_LARGE);

    srv_head head = {.method = "GET", .target = "/", .version = "HTTP/1.1"};
    api_problem problem = {0};
    set_fields(&head, HOST);
    head.bytes = SRV_MAX_HEAD;
    assert_true(srv_framing_check(&head, &framing, &problem));
    head.bytes++;
    assert_false(srv_framing_check(&head, &framing, &problem));
    assert_int_equal(api_problem_http(&problem), 431);
}

static void test_hosts(void **state)
{
    (void)state;
    static const srv_policy policy = {.hosts = {{"mesh.example", "10.1.2.3"}, 2}};
    static const struct {
        const char *host;
        bool allowed;
    } rows[] = {
        {"localhost", true},
        {"LocalHost", true},
        {"localhost:8080", true},
        {"localhost:", true},
        {"127.0.0.1", true},
        {"127.0.0.1:1", true},
        {"127.9.9.9:65535", true},
        {"[::1]", true},
        {"[::1]:8080", true},
        {"[0:0:0:0:0:0:0:1]", true},
        {"mesh.example", true},
        {"MESH.example:443", true},
        {"10.1.2.3:80", true},
        {"", false},
        {":80", false},
        {"evil.example", false},
        {"localhost.evil.example", false},
        {"evil.localhost", false},
        {"127.0.0.1.evil.example", false},
        {"128.0.0.1", false},
        {"10.1.2.4", false},
        {"0.0.0.0", false},
        {"[::2]", false},
        {"[::1", false},
        {"[::1]x", false},
        {"::1", false},
        {"localhost:80x", false},
        {"localhost:123456", false},
        {"localhost/", false},
        {"user@localhost", false},
        {"localhost,localhost", false},
        {"2130706433", false},
        {"0x7f000001", false},
        {"127.1", false},
        {"xmesh.example", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_problem problem = {0};
        bool allowed = srv_policy_host(&policy, rows[i].host, strlen(rows[i].host), &problem);
        if (allowed != rows[i].allowed) {
            fail_msg("Host: %s", rows[i].host);
        }
        assert_int_equal(problem.code, allowed ? (int)HE_OK : (int)API_WRONG_HOST);
    }
    api_problem problem = {0};
    assert_true(srv_policy_host(&policy, NULL, 0, &problem));
}

static void test_origins(void **state)
{
    (void)state;
    static const srv_policy policy = {.origins = {{"https://app.example", "null"}, 2}};
    static const struct {
        const char *method, *host, *origin, *site;
        bool allowed;
    } rows[] = {
        {"POST", "localhost:1", NULL, NULL, true},
        {"POST", "localhost:1", "http://localhost:1", NULL, true},
        {"POST", "localhost:1", "https://localhost:1", "same-origin", true},
        {"POST", "localhost", "http://localhost", NULL, true},
        {"POST", "localhost:80", "http://localhost", NULL, true},
        {"POST", "[::1]:8", "http://[::1]:8", NULL, true},
        {"POST", "localhost:1", "http://localhost:2", NULL, false},
        {"POST", "localhost:1", "http://127.0.0.1:1", NULL, false},
        {"POST", "localhost:1", "http://localhost", NULL, false},
        {"POST", "localhost:1", "null", NULL, false},
        {"POST", "localhost:1", "", NULL, false},
        {"POST", "localhost:1", "http://evil.example", NULL, false},
        {"POST", "localhost:1", "http://localhost:1.evil.example", NULL, false},
        {"POST", "localhost:1", "file://", NULL, false},
        {"PUT", "localhost:1", "http://evil.example", NULL, false},
        {"PATCH", "localhost:1", "http://evil.example", NULL, false},
        {"DELETE", "localhost:1", "http://evil.example", NULL, false},
        {"MADEUP", "localhost:1", "http://evil.example", NULL, false},
        {"GET", "localhost:1", "http://evil.example", "cross-site", true},
        {"HEAD", "localhost:1", "null", NULL, true},
        {"OPTIONS", "localhost:1", "http://evil.example", NULL, true},
        {"POST", "localhost:1", NULL, "cross-site", false},
        {"POST", "localhost:1", NULL, "Cross-Site", false},
        {"POST", "localhost:1", "http://localhost:1", "cross-site", false},
        {"POST", "localhost:1", NULL, "none", true},
        {"POST", "localhost:1", NULL, "same-origin", true},
        {"POST", "localhost:1", NULL, "same-site", false},
        {"DELETE", "localhost:1", NULL, "Same-Site", false},
        {"GET", "localhost:1", NULL, "same-site", true},
        {"POST", "localhost:1", "http://localhost:1", "same-site", true},
        {"POST", "localhost:1", "https://app.example", "same-site", true},
        {"POST", "localhost:1", "https://app.example", "cross-site", true},
        {"POST", "localhost:1", "http://app.example", NULL, false},
        {"POST", "localhost:1", "https://app.example.evil", NULL, false},
        {"POST", NULL, "http://localhost", NULL, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_problem problem = {0};
        if (srv_policy_origin(&policy, rows[i].method, rows[i].host, rows[i].origin, rows[i].site,
                              &problem) != rows[i].allowed) {
            fail_msg("row %zu: %s, Origin %s", i, rows[i].method,
                     rows[i].origin == NULL ? "-" : rows[i].origin);
        }
        assert_int_equal(problem.code, rows[i].allowed ? (int)HE_OK : (int)API_FOREIGN_ORIGIN);
    }
    assert_string_equal(srv_policy_cors(&policy, "https://app.example"), "https://app.example");
    assert_null(srv_policy_cors(&policy, "https://other.example"));
    assert_null(srv_policy_cors(&policy, "null"));
    assert_null(srv_policy_cors(&policy, NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lines_and_fields),
        cmocka_unit_test(test_bodies),
        cmocka_unit_test(test_targets_are_split),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_hosts),
        cmocka_unit_test(test_origins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
