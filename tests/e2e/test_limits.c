/* Limits per client in a real daemon: of requests, of connections, and of meshes, also after a
 * restart. */
#include "tests/e2e/client.h"
#include "tests/store_folder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* The SHA-256 hash of the token "test". */
#define HASH "sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"

/* The limit is one request a second. A client that sends a thousand requests without pause must be
 * refused at some point, however slow the machine is. */
static void an_address_that_asks_without_end_is_told_to_wait(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--address-requests", "1", "--limit-burst", "3"));
    client *c = client_new(d);
    char value[100];
    long status = 200;
    for (int i = 0; i < 1000 && status == 200; i++) {
        reply r = client_get(c, "/v1/meshes");
        status = r.status;
        if (status == 429) {
            assert_string_equal(reply_string(&r, "code"), "rate_limit");
            assert_true(strtol(reply_header(&r, "Retry-After", value, sizeof value), NULL, 10) > 0);
            assert_string_equal(reply_header(&r, "RateLimit-Policy", value, sizeof value),
                                "\"requests\";q=3;w=3");
        }
        reply_done(r);
    }
    assert_int_equal(status, 429);
    for (int i = 0; i < 20; i++) {
        reply_done(reply_expect(200, client_get(c, "/livez")));
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void one_connection_too_many_is_told_so_and_closed(void **state)
{
    (void)state;
    static const char ask[] = "GET /v1/meshes HTTP/1.1\r\nHost: localhost\r\n\r\n";
    daemon_process *d = daemon_start(ARGUMENTS("--address-connections", "2"));
    client *first = client_new(d), *second = client_new(d);
    reply_done(reply_expect(200, client_get(first, "/v1/meshes")));
    reply_done(reply_expect(200, client_get(second, "/v1/meshes")));
    char *answer = client_raw(d, ask, sizeof ask - 1, 2, false); /* reads until the daemon closes */
    assert_int_equal(client_raw_status(answer), 429);
    assert_non_null(strstr(answer, "too_many_connections"));
    assert_non_null(strstr(answer, "Connection: close"));
    free(answer);
    client_free(second);
    int status = 429;
    while (status == 429) { /* waits until the daemon has noticed the closed connection */
        answer = client_raw(d, ask, sizeof ask - 1, 1, false);
        status = client_raw_status(answer);
        free(answer);
    }
    assert_int_equal(status, 200);
    client_free(first);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_quota_counts_meshes_from_before_a_restart(void **state)
{
    (void)state;
    static const char bearer[] = "Authorization: Bearer test", cube[] = "{\"shape\":\"cube\"}";
    char folder[FOLDER_PATH], store[FOLDER_PATH + 10], path[FOLDER_PATH + 10];
    folder_make(folder);
    snprintf(store, sizeof store, "sqlite:%s", folder);
    snprintf(path, sizeof path, "%s.tokens", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "alice write %s meshes=2\n", HASH);
    assert_int_equal(fclose(file), 0);
    const char *const arguments[] = {"--store", store, "--tokens", path, NULL};
    const char *const headers[] = {bearer, NULL};
    daemon_process *d = daemon_start(arguments);
    client *c = client_new(d);
    for (int i = 0; i < 2; i++) {
        const char *id = i == 0 ? "/v1/meshes/a" : "/v1/meshes/b";
        reply_done(reply_expect(201, client_send(c, "PUT", id, headers, cube)));
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    d = daemon_start(arguments);
    c = client_new(d);
    reply r = reply_expect(507, client_send(c, "POST", "/v1/meshes", headers, cube));
    assert_string_equal(reply_string(&r, "code"), "quota");
    reply_done(r);
    reply_done(reply_expect(204, client_send(c, "DELETE", "/v1/meshes/a", headers, NULL)));
    reply_done(reply_expect(201, client_send(c, "POST", "/v1/meshes", headers, cube)));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    unlink(path);
    folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_address_that_asks_without_end_is_told_to_wait),
        cmocka_unit_test(one_connection_too_many_is_told_so_and_closed),
        cmocka_unit_test(a_quota_counts_meshes_from_before_a_restart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
