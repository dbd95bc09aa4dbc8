/* Tests of finding the target, the body and the headers of a request, and of refusing requests that
 * are meant for other servers. Ambiguous requests and too large requests are tested in
 * test_srv_syntax.c. */
#include "tests/unit/fixture.h"

#include "server/http/syntax/http_framing.h"
#include "server/http/http_headers.h"
#include "server/http/http_policy.h"
#include "tests/failing.h"

static srv_head head_of(const char *target)
{
    return (srv_head){.method = "GET", .target = target, .version = "HTTP/1.1"};
}

static void a_target_is_a_path_or_an_address_of_this_server(void **state)
{
    (void)state;
    static const char *const refused[] = {
        "", "*", "a/b", "?a=b", "https://localhost/", "localhost:80", "http://localhost?x=1"};
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        srv_head head = head_of(refused[i]);
        srv_framing framing;
        api_problem problem = {0};
        assert_false(srv_framing_read(&head, false, &framing, &problem));
        assert_int_equal(problem.code, API_BAD_PATH);
    }
}

static void a_target_of_https_is_one_where_it_came_over_tls(void **state)
{
    (void)state;
    srv_head head = head_of("https://mesh.example/v1/meshes?limit=1");
    srv_framing framing;
    api_problem problem = {0};
    assert_true(srv_framing_read(&head, true, &framing, &problem));
    assert_int_equal(framing.authority_length, strlen("mesh.example"));
    assert_string_equal(framing.query, "limit=1");
    assert_false(srv_framing_read(&head, false, &framing, &problem));
}

static void a_target_is_split(void **state)
{
    (void)state;
    static const struct {
        const char *target, *path, *query, *authority;
    } rows[] = {
        {"/", "/", "", NULL},
        {"/a/b?c=d?e", "/a/b", "c=d?e", NULL},
        {"/a?", "/a", "", NULL},
        {"//a", "//a", "", NULL},
        {"http://h:1/a?b", "/a", "b", "h:1"},
        {"http://h", "/", "", "h"},
        {"HTTP://h", "/", "", "h"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_head head = head_of(rows[i].target);
        srv_framing f;
        api_problem problem = {0};
        assert_true(srv_framing_read(&head, false, &f, &problem));
        assert_int_equal(problem.code, HE_OK);
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

static void a_body_is_announced_by_a_length_or_by_chunks(void **state)
{
    (void)state;
    static const struct {
        const char *name, *value;
        bool chunked, has_length;
        uint64_t length;
    } rows[] = {
        {"X", "a", false, false, 0},
        {"Content-Length", "0", false, true, 0},
        {"content-length", "12", false, true, 12},
        {"Content-Length", "00000000000000000000000000012", false, true, 12},
        {"CONTENT-LENGTH", "9223372036854775807", false, true, INT64_MAX},
        {"Transfer-Encoding", "chunked", true, false, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        srv_head head = head_of("/");
        srv_framing f;
        api_problem problem = {0};
        head.fields[0] = (srv_field){"hOST", "h", 4, 1};
        head.fields[1] =
            (srv_field){rows[i].name, rows[i].value, strlen(rows[i].name), strlen(rows[i].value)};
        head.field_count = 2;
        assert_true(srv_framing_read(&head, false, &f, &problem));
        assert_string_equal(f.host, "h");
        assert_int_equal(f.chunked, rows[i].chunked);
        assert_int_equal(f.has_length, rows[i].has_length);
        assert_true(f.length == rows[i].length);
    }
}

static void add_field(srv_head *head, const char *name, const char *value)
{
    head->fields[head->field_count++] = (srv_field){name, value, strlen(name), strlen(value)};
}

static void lines_of_a_list_are_joined_and_the_first_of_others_counts(void **state)
{
    (void)state;
    srv_head head = head_of("/");
    const char *values[API_REQUEST_HEADERS];
    char *joined = NULL;
    add_field(&head, "if-match", "\"a\"");
    add_field(&head, "Content-Encoding", "gzip");
    add_field(&head, "Content-Type", "model/obj");
    add_field(&head, "IF-MATCH", "");
    add_field(&head, "Accept-", "a");
    add_field(&head, "content-type", "model/stl");
    add_field(&head, "Content-encoding", "zstd");
    add_field(&head, "Prefer", "wait=1");
    add_field(&head, "If-Match", "\"b\", \"c\"");
    add_field(&head, "Accept", "");
    assert_true(srv_headers_read(&head, values, &joined));
    assert_string_equal(values[API_HEADER_IF_MATCH], "\"a\",,\"b\", \"c\"");
    assert_string_equal(values[API_HEADER_CONTENT_ENCODING], "gzip,zstd");
    assert_string_equal(values[API_HEADER_CONTENT_TYPE], "model/obj");
    assert_string_equal(values[API_HEADER_PREFER], "wait=1");
    assert_string_equal(values[API_HEADER_ACCEPT], "");
    assert_null(values[API_HEADER_ACCEPT_ENCODING]);
    assert_null(values[API_HEADER_IF_NONE_MATCH]);
    assert_null(values[API_HEADER_SEC_FETCH_SITE]);
    he_mem_free(joined);
}

static void headers_ask_for_memory_only_where_lines_are_joined(void **state)
{
    (void)state;
    srv_head head = head_of("/");
    const char *values[API_REQUEST_HEADERS];
    char *joined = NULL;
    add_field(&head, "Accept", "text/html");
    add_field(&head, "Idempotency-Key", "a");
    add_field(&head, "Idempotency-Key", "b");
    add_field(&head, "X-Other", "1");
    add_field(&head, "X-Other", "2");
    failing_at(1);
    bool good = srv_headers_read(&head, values, &joined);
    failing_off();
    assert_true(good);
    assert_null(joined);
    assert_ptr_equal(values[API_HEADER_ACCEPT], head.fields[0].value);
    assert_ptr_equal(values[API_HEADER_IDEMPOTENCY_KEY], head.fields[1].value);
    add_field(&head, "Accept", "text/plain");
    failing_at(1);
    good = srv_headers_read(&head, values, &joined);
    failing_off();
    assert_false(good);
    assert_null(joined);
}

static void hosts_are_allowed_only_if_local_or_listed(void **state)
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

static void writes_are_allowed_only_from_own_or_listed_origins(void **state)
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
        if (srv_policy_origin(&policy,
                              &(srv_sender){.method = rows[i].method,
                                            .host = rows[i].host,
                                            .origin = rows[i].origin,
                                            .fetch_site = rows[i].site},
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

static void the_origin_has_the_scheme_by_which_the_request_came(void **state)
{
    (void)state;
    static const srv_policy policy = {.hosts = {{"mesh.example"}, 1}};
    static const struct {
        const char *origin;
        srv_scheme scheme;
        bool allowed;
    } rows[] = {
        {"https://mesh.example", SRV_SCHEME_HTTPS, true},
        {"http://mesh.example", SRV_SCHEME_HTTPS, false},
        {"http://mesh.example:443", SRV_SCHEME_HTTPS, false},
        {"https://mesh.example", SRV_SCHEME_HTTP, false},
        {"http://mesh.example", SRV_SCHEME_HTTP, true},
        {"https://mesh.example", SRV_SCHEME_UNKNOWN, true},
        {"http://mesh.example", SRV_SCHEME_UNKNOWN, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        api_problem problem = {0};
        const srv_sender sender = {.method = "POST",
                                   .host = "mesh.example",
                                   .origin = rows[i].origin,
                                   .scheme = rows[i].scheme};
        assert_int_equal(srv_policy_origin(&policy, &sender, &problem), rows[i].allowed);
    }
}

static void browsers_are_told_of_names_and_not_of_addresses_or_localhost(void **state)
{
    (void)state;
    static const srv_policy policy = {
        .hosts = {{"mesh.example", "10.1.2.3", "localhost", "::2"}, 4}};
    static const struct {
        const char *host;
        bool name;
    } rows[] = {
        {"mesh.example", true},   {"Mesh.Example:8443", true}, {"other.example", false},
        {"10.1.2.3:8443", false}, {"localhost", false},        {"localhost:8443", false},
        {"127.0.0.1", false},     {"[::2]:1", false},          {NULL, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(srv_policy_is_name(&policy, rows[i].host), rows[i].name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_target_is_a_path_or_an_address_of_this_server),
        cmocka_unit_test(a_target_of_https_is_one_where_it_came_over_tls),
        cmocka_unit_test(a_target_is_split),
        cmocka_unit_test(a_body_is_announced_by_a_length_or_by_chunks),
        cmocka_unit_test(lines_of_a_list_are_joined_and_the_first_of_others_counts),
        cmocka_unit_test(headers_ask_for_memory_only_where_lines_are_joined),
        cmocka_unit_test(hosts_are_allowed_only_if_local_or_listed),
        cmocka_unit_test(writes_are_allowed_only_from_own_or_listed_origins),
        cmocka_unit_test(the_origin_has_the_scheme_by_which_the_request_came),
        cmocka_unit_test(browsers_are_told_of_names_and_not_of_addresses_or_localhost),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
