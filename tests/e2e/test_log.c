/* The log that the daemon writes to standard error: each line must have its format, the start and
 * the stop have their lines, trace ids appear, settings can be reloaded, and no secret appears. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})
#define TRACE          "4bf92f3577b34da6a3ce929d0e0e4736"
#define PARENT         "00f067aa0ba902b7"

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_true(fputs(text, out) >= 0);
    assert_int_equal(fclose(out), 0);
}

static const char *member(const cJSON *json, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, name);
    return cJSON_IsString(item) ? item->valuestring : "";
}

/* The lines of a log, parsed as JSON, except the line that says that the daemon is ready. */
typedef struct lines {
    cJSON *all[200];
    size_t count;
} lines;

static lines read_lines(char *log)
{
    lines l = {.count = 0};
    int plain = 0;
    for (char *line = log, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        cJSON *json = cJSON_ParseWithOpts(line, NULL, 1);
        if (json == NULL) {
            assert_true(strstr(line, ": listening on http") != NULL ||
                        strstr(line, ": listening on unix:") != NULL);
            plain++;
            continue;
        }
        assert_true(cJSON_IsObject(json));
        assert_string_not_equal(member(json, "time"), "");
        assert_string_not_equal(member(json, "level"), "");
        assert_true(l.count < 200);
        l.all[l.count++] = json;
    }
    assert_true(plain <= 1);
    return l;
}

static void free_lines(lines *l)
{
    for (size_t i = 0; i < l->count; i++) {
        cJSON_Delete(l->all[i]);
    }
}

static const cJSON *line_with(const lines *l, const char *name, const char *value)
{
    for (size_t i = 0; i < l->count; i++) {
        if (strcmp(member(l->all[i], name), value) == 0) {
            return l->all[i];
        }
    }
    fail_msg("no line has \"%s\": \"%s\"", name, value);
    return NULL;
}

static void json_says_what_starts_with_which_options_and_why_it_stops(void **state)
{
    (void)state;
    char reason[64], url[300];
    daemon_process *d = daemon_start(ARGUMENTS("--log", "access", "--max-meshes", "7"));
    snprintf(url, sizeof url, "%s", daemon_url(d));
    client *c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/version")));
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    lines l = read_lines(log);
    const cJSON *start = line_with(&l, "message", "hedged starts");
    assert_string_not_equal(member(start, "version"), "");
    assert_true(cJSON_HasObjectItem(start, "commit"));
    static const char *const libraries[] = {"libmicrohttpd", "SQLite", "cJSON", "zlib", "zstd"};
    for (size_t i = 0; i < sizeof libraries / sizeof *libraries; i++) {
        assert_string_not_equal(member(cJSON_GetObjectItem(start, "libraries"), libraries[i]), "");
    }
    const cJSON *options =
        cJSON_GetObjectItem(line_with(&l, "message", "options in effect"), "options");
    assert_string_equal(member(options, "max-meshes"), "7");
    assert_string_equal(member(options, "listen"),
                        transport_get() == TRANSPORT_UNIX ? url : "127.0.0.1:0");
    assert_string_equal(member(options, "log-level"), "info");
    assert_int_equal(cJSON_GetObjectItem(line_with(&l, "event", "request"), "status")->valueint,
                     200);
    const cJSON *stop = line_with(&l, "message", "hedged stops");
    snprintf(reason, sizeof reason, "SIGTERM from process %d", (int)getpid());
    assert_string_equal(member(stop, "reason"), reason);
    assert_string_equal(member(l.all[l.count - 1], "message"), "hedged has stopped");
    free_lines(&l);
    free(log);
}

static void what_keeps_it_from_starting_is_a_line_of_json_too(void **state)
{
    (void)state;
    char output[16384];
    const char *const *const cases[] = {
        ARGUMENTS("--listen", "nowhere"),
        ARGUMENTS("--no-such-option"),
        ARGUMENTS("--listen", "127.0.0.1:0", "--store", "memory", "--tokens", "/nowhere/tokens"),
        ARGUMENTS("--listen", "127.0.0.1:0", "--store", "sqlite:/proc/1/none/none"),
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(daemon_run(cases[i], output, sizeof output), i < 2 ? 2 : 1);
        lines l = read_lines(output);
        assert_string_not_equal(member(line_with(&l, "level", "error"), "message"), "");
        if (i >= 2) {
            assert_string_equal(member(line_with(&l, "message", "hedged stops"), "reason"),
                                "the daemon could not start");
        }
        free_lines(&l);
    }
    assert_int_equal(
        daemon_run(ARGUMENTS("--log-format", "text", "--listen", "nowhere"), output, sizeof output),
        2);
    assert_non_null(strstr(output, "Z error --listen takes "));
}

static void text_is_for_readers_and_the_default_of_a_terminal(void **state)
{
    (void)state;
    for (int terminal = 0; terminal < 2; terminal++) {
        daemon_process *d =
            terminal == 1 ? daemon_start_on_terminal(ARGUMENTS("--log", "access"))
                          : daemon_start(ARGUMENTS("--log", "access", "--log-format", "text"));
        client *c = client_new(d);
        reply_done(reply_expect(200, client_get(c, "/version")));
        client_free(c);
        char *log = daemon_stop_and_tell(d);
        assert_non_null(strstr(log, "Z info hedged starts version="));
        char line[100];
        snprintf(line, sizeof line, "Z info %s GET /version 200 in=0 out=", transport_peer());
        assert_non_null(strstr(log, line));
        assert_non_null(strstr(log, "Z info hedged stops reason=\"SIGTERM from process "));
        assert_null(strstr(log, "{\""));
        free(log);
    }
    daemon_process *d = daemon_start_on_terminal(ARGUMENTS("--log-format", "json"));
    char *log = daemon_stop_and_tell(d);
    lines l = read_lines(log);
    free_lines(&l);
    free(log);
}

static void a_level_says_no_more_than_asked_beside_the_requests(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "access", "--log-level", "error"));
    client *c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/version")));
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    lines l = read_lines(log);
    assert_int_equal(l.count, 1);
    assert_string_equal(member(l.all[0], "event"), "request");
    free_lines(&l);
    free(log);

    d = daemon_start(ARGUMENTS("--log", "off", "--log-level", "debug"));
    kill(daemon_pid(d), SIGHUP);
    free(daemon_wait_log(d, "SIGHUP from process", 1));
    c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/version")));
    client_free(c);
    log = daemon_stop_and_tell(d);
    l = read_lines(log);
    (void)line_with(&l, "level", "debug");
    assert_null(strstr(log, "/version"));
    free_lines(&l);
    free(log);
}

/* Sends a request with the header line `header`. If `trace_id` is not NULL, the answer must belong
 * to the trace with this id. */
static void ask_in_trace(client *c, const char *header, const char *trace_id, char flag, char *span)
{
    char answered[128], expected[64];
    reply r = client_send(c, "GET", "/version",
                          (const char *const[]){header, "tracestate: a=b", NULL}, NULL);
    assert_int_equal(r.status, 200);
    reply_header(&r, "traceparent", answered, sizeof answered);
    if (trace_id != NULL) {
        snprintf(expected, sizeof expected, "00-%s-", trace_id);
        assert_int_equal(strncmp(answered, expected, strlen(expected)), 0);
    }
    assert_int_equal(strlen(answered), 55);
    assert_int_equal(answered[54], flag);
    memcpy(span, answered + 36, 16);
    span[16] = '\0';
    assert_string_not_equal(span, PARENT);
    assert_string_equal(reply_header(&r, "tracestate", answered, sizeof answered), "");
    reply_free(&r);
}

static void a_trace_is_answered_and_in_the_line_of_its_request(void **state)
{
    (void)state;
    char span[17], other[17], text[128];
    daemon_process *d = daemon_start(ARGUMENTS("--log", "access"));
    client *c = client_new(d);
    ask_in_trace(c, "traceparent: 00-" TRACE "-" PARENT "-01", TRACE, '1', span);
    ask_in_trace(c, "traceparent: 00-" TRACE "-malformed-01", NULL, '0', other);
    reply r = client_get(c, "/livez");
    assert_string_equal(reply_header(&r, "traceparent", text, sizeof text), "");
    reply_free(&r);
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    lines l = read_lines(log);
    const cJSON *line = line_with(&l, "trace_id", TRACE);
    assert_string_equal(member(line, "parent_id"), PARENT);
    assert_string_equal(member(line, "span_id"), span);
    line = line_with(&l, "span_id", other);
    assert_false(cJSON_HasObjectItem(line, "parent_id"));
    assert_string_not_equal(member(line, "trace_id"), TRACE);
    assert_false(cJSON_HasObjectItem(line_with(&l, "path", "/livez"), "trace_id"));
    free_lines(&l);
    free(log);
}

static void a_page_of_another_origin_may_send_and_read_a_trace(void **state)
{
    (void)state;
    char text[1024];
    daemon_process *d = daemon_start(ARGUMENTS("--allow-origin", "https://a.example"));
    client *c = client_new(d);
    reply r =
        client_send(c, "OPTIONS", "/v1/meshes",
                    ARGUMENTS("Origin: https://a.example", "Access-Control-Request-Method: POST",
                              "Access-Control-Request-Headers: authorization,traceparent"),
                    NULL);
    reply_header(&r, "Access-Control-Allow-Headers", text, sizeof text);
    assert_non_null(strstr(text, "Authorization"));
    assert_non_null(strstr(text, "traceparent"));
    reply_free(&r);
    r = client_send(
        c, "GET", "/v1/meshes",
        ARGUMENTS("Origin: https://a.example", "traceparent: 00-" TRACE "-" PARENT "-01"), NULL);
    assert_int_equal(r.status, 200);
    reply_header(&r, "Access-Control-Expose-Headers", text, sizeof text);
    assert_non_null(strstr(text, "traceparent"));
    assert_string_not_equal(reply_header(&r, "traceparent", text, sizeof text), "");
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_reload_reads_the_settings_of_the_log_again(void **state)
{
    (void)state;
    char file[] = "/tmp/log-settings-XXXXXX", trust[256];
    int fd = mkstemp(file);
    assert_true(fd >= 0);
    close(fd);
    write_file(file, "log-level = warning\nlog = off\nmax-meshes = 5\n");
    daemon_process *d = daemon_start(ARGUMENTS("--config", file));
    client *c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/version")));

    write_file(file, "log-level = debug\nlog-format = text\nlog = access\nmax-meshes = 6\n");
    kill(daemon_pid(d), SIGHUP);
    snprintf(trust, sizeof trust, "Z info the settings of the log were read again from %s", file);
    free(daemon_wait_log(d, trust, 1));
    reply_done(reply_expect(200, client_get(c, "/livez")));

    write_file(file, "log-level = loud\n");
    kill(daemon_pid(d), SIGHUP);
    free(daemon_wait_log(d, "; the previous settings stay in effect", 1));
    reply_done(reply_expect(200, client_get(c, "/readyz")));
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    assert_null(strstr(log, "hedged starts"));
    assert_null(strstr(log, "/version"));
    assert_non_null(strstr(log, " GET /livez 200 "));
    assert_non_null(strstr(log, " GET /readyz 200 "));
    assert_non_null(
        strstr(log, "a new value of max-meshes, which takes effect only after a restart"));
    assert_null(strstr(log, "a new value of log"));
    free(log);
    unlink(file);
}

/* The daemon knows tokens from a header, from a URL in which they are by mistake, and as hashes in
 * its file; and it knows a ticket from a query. None of these may appear in the log, at any level
 * and in either format. */
static void no_token_and_no_ticket_is_ever_said(void **state)
{
    (void)state;
    static const char *const formats[] = {"json", "text"};
    char file[] = "/tmp/log-tokens-XXXXXX", said[1024];
    int fd = mkstemp(file);
    assert_true(fd >= 0);
    close(fd);
    assert_int_equal(daemon_run(ARGUMENTS("--new-token", "me", "admin"), said, sizeof said), 0);
    char token[64], line[256];
    assert_int_equal(sscanf(said, "%63[^\n]\n%255[^\n]\n", token, line), 2);
    write_file(file, line);
    const char *hash = strrchr(line, ' ') + 1;
    char bearer[256], path[1024];
    snprintf(bearer, sizeof bearer, "Authorization: Bearer %s", token);
    for (size_t i = 0; i < 2; i++) {
        daemon_process *d =
            daemon_start(ARGUMENTS("--tokens", file, "--log", "access", "--log-level", "debug",
                                   "--slow", "1", "--log-format", formats[i]));
        client *c = client_new(d);
        const char *const as_me[] = {bearer, "Content-Type: application/json", NULL};
        reply r = client_send(c, "PUT", "/v1/meshes/m", as_me, "{\"shape\":\"cube\"}");
        assert_int_equal(r.status, 201);
        reply_free(&r);
        static const char wanted[] = "{\"path\":\"/v1/meshes/m\"}";
        r = client_send(c, "POST", "/v1/tickets", as_me, wanted);
        assert_int_equal(r.status, 200);
        char ticket[512];
        snprintf(ticket, sizeof ticket, "%s", reply_string(&r, "path"));
        reply_free(&r);
        assert_non_null(strchr(ticket, '?'));
        reply_done(reply_expect(200, client_get(c, ticket)));
        reply_done(reply_expect(401, client_get(c, ticket)));
        snprintf(path, sizeof path, "/v1/meshes/m?token=%s", token);
        r = client_get(c, path);
        assert_int_equal(r.status, 401);
        assert_null(strstr(r.body == NULL ? "" : r.body, token));
        reply_free(&r);
        kill(daemon_pid(d), SIGHUP);
        free(daemon_wait_log(d, "tokens are accepted", 1));
        client_free(c);
        char *log = daemon_stop_and_tell(d);
        assert_non_null(strstr(log, "/v1/tickets"));
        assert_null(strstr(log, token));
        assert_null(strstr(log, hash));
        assert_null(strstr(log, strchr(ticket, '=') + 1));
        free(log);
    }
    unlink(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_says_what_starts_with_which_options_and_why_it_stops),
        cmocka_unit_test(what_keeps_it_from_starting_is_a_line_of_json_too),
        cmocka_unit_test(text_is_for_readers_and_the_default_of_a_terminal),
        cmocka_unit_test(a_level_says_no_more_than_asked_beside_the_requests),
        cmocka_unit_test(a_trace_is_answered_and_in_the_line_of_its_request),
        cmocka_unit_test(a_page_of_another_origin_may_send_and_read_a_trace),
        cmocka_unit_test(a_reload_reads_the_settings_of_the_log_again),
        cmocka_unit_test(no_token_and_no_ticket_is_ever_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
