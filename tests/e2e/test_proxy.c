/* A daemon behind a reverse proxy: the client address that it assumes, and the scheme of the URLs
 * in its answers. */
#include "tests/e2e/client.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Returns the line of the access log about the request whose request id is `id`. */
static const char *line_of(const char *log, const char *id)
{
    const char *at = strstr(log, id);
    assert_non_null(at);
    while (at > log && at[-1] != '\n') {
        at--;
    }
    return at;
}

static void assert_peer(const char *log, const char *id, const char *address)
{
    char text[100];
    const char *line = line_of(log, id);
    snprintf(text, sizeof text, "\"peer\":\"%s\"", address);
    const char *at = strstr(line, text);
    if (at == NULL || at > strchr(line, '\n')) {
        fail_msg("no %s in %.*s", text, (int)strcspn(line, "\n"), line);
    }
}

static void the_access_log_names_whom_a_trusted_proxy_names(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS(
        "--log", "access", "--trusted-proxy", "127.0.0.0/8,unix", "--trusted-proxy", "10.0.0.0/8"));
    client *c = client_new(d);
    reply_done(reply_expect(200, client_send(c, "GET", "/livez",
                                             ARGUMENTS("X-Request-Id: the-first-one",
                                                       "X-Forwarded-For: 6.6.6.6, 192.0.2.1"),
                                             NULL)));
    reply_done(reply_expect(
        200, client_send(c, "GET", "/livez",
                         ARGUMENTS("X-Request-Id: the-second-one",
                                   "Forwarded: for=\"[2001:db8::7]:80\", for=10.0.0.9"),
                         NULL)));
    reply r = reply_expect(
        400, client_send(c, "GET", "/livez",
                         ARGUMENTS("X-Request-Id: the-third-one", "Forwarded: for=6.6.6.6",
                                   "X-Forwarded-For: 192.0.2.1"),
                         NULL));
    assert_string_equal(reply_string(&r, "code"), "bad_header");
    reply_done(r);
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    assert_peer(log, "the-first-one", "192.0.2.1");
    assert_peer(log, "the-second-one", "2001:db8::7");
    free(log);
}

static void nobody_else_is_believed(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "access", "--trusted-proxy", "203.0.113.1",
                                               "--allow-host", "mesh.example"));
    client *c = client_new(d);
    char value[100];
    reply r = reply_expect(
        200, client_send(c, "GET", "/livez",
                         ARGUMENTS("X-Request-Id: the-first-one", "X-Forwarded-For: 192.0.2.1",
                                   "Forwarded: for=\"", "X-Forwarded-Proto: https"),
                         NULL));
    reply_done(r);
    client_free(c);
    char *log = daemon_stop_and_tell(d);
    const char *line = line_of(log, "the-first-one");
    snprintf(value, sizeof value, "%.*s", (int)strcspn(strstr(line, "\"peer\""), ",}"),
             strstr(line, "\"peer\""));
    assert_true(strcmp(value, "\"peer\":\"127.0.0.1\"") == 0 ||
                strncmp(value, "\"peer\":\"unix:uid=", 17) == 0);
    free(log);
}

/* Two things depend on the scheme that the proxy reports: the headers that a browser gets over
 * https, and the origins whose web pages may write. */
static void the_scheme_is_the_one_that_the_proxy_tells(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(
        ARGUMENTS("--trusted-proxy", "127.0.0.1,unix", "--allow-host", "mesh.example"));
    client *c = client_new(d);
    static const struct {
        const char *proto, *host, *origin, *told;
        long status;
    } rows[] = {
        {"https", "mesh.example", "https://mesh.example", "max-age=31536000", 201},
        {"https", "mesh.example", "http://mesh.example", "max-age=31536000", 403},
        {"https", "localhost:8443", "https://localhost:8443", "", 201},
        {"http", "mesh.example", "http://mesh.example", "", 201},
        {"http", "mesh.example", "https://mesh.example", "", 403},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char proto[60], host[60], origin[60], told[60];
        snprintf(proto, sizeof proto, "X-Forwarded-Proto: %s", rows[i].proto);
        snprintf(host, sizeof host, "Host: %s", rows[i].host);
        snprintf(origin, sizeof origin, "Origin: %s", rows[i].origin);
        static const char body[] = "{\"shape\":\"cube\"}";
        reply r = reply_expect(rows[i].status, client_send(c, "POST", "/v1/meshes",
                                                           ARGUMENTS(proto, host, origin), body));
        assert_string_equal(reply_header(&r, "Strict-Transport-Security", told, sizeof told),
                            rows[i].told);
        reply_done(r);
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_proxy_that_is_no_address_stops_the_start(void **state)
{
    (void)state;
    char said[400];
    assert_int_equal(daemon_run(ARGUMENTS("--trusted-proxy", "proxy.example"), said, sizeof said),
                     2);
    assert_non_null(strstr(said, "--trusted-proxy takes an address"));
    assert_non_null(strstr(said, "proxy.example"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_access_log_names_whom_a_trusted_proxy_names),
        cmocka_unit_test(nobody_else_is_believed),
        cmocka_unit_test(the_scheme_is_the_one_that_the_proxy_tells),
        cmocka_unit_test(a_proxy_that_is_no_address_stops_the_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
