/* A daemon with --tokens: the requests that it admits, and what changes when it reloads the file of
 * tokens. */
#include "tests/e2e/client.h"
#include "tests/e2e/listener.h"
#include "tests/store_folder.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* A token that the daemon's own command has made, and the line of the file of tokens about it. */
typedef struct made {
    char token[64], line[256], header[100];
} made;

static made make(const char *name, const char *role)
{
    char said[400];
    made m;
    assert_int_equal(daemon_run(ARGUMENTS("--new-token", name, role), said, sizeof said), 0);
    assert_int_equal(sscanf(said, "%63[^\n]\n%255[^\n]\n", m.token, m.line), 2);
    snprintf(m.header, sizeof m.header, "Authorization: Bearer %s", m.token);
    return m;
}

static char folder[FOLDER_PATH], path[FOLDER_PATH + 10];

static void write_file(const char *first, const char *second)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "# a test's\n%s\n%s\n", first, second);
    assert_int_equal(fclose(file), 0);
}

static reply ask(client *c, const made *who, const char *method, const char *target,
                 const char *body)
{
    return client_send(c, method, target, who == NULL ? NULL : ARGUMENTS(who->header), body);
}

static void a_daemon_asks_for_tokens_and_reads_its_file_again(void **state)
{
    (void)state;
    made alice = make("alice", "write"), boss = make("boss", "admin");
    write_file(alice.line, boss.line);
    daemon_process *d = daemon_start(ARGUMENTS("--tokens", path));
    client *c = client_new(d);
    char challenge[200];
    reply r = reply_expect(401, ask(c, NULL, "GET", "/v1/meshes", NULL));
    assert_string_equal(reply_header(&r, "WWW-Authenticate", challenge, sizeof challenge),
                        "Bearer realm=\"hedge\"");
    reply_done(r);
    reply_done(reply_expect(200, ask(c, NULL, "GET", "/livez", NULL)));
    reply_done(reply_expect(201, ask(c, &alice, "PUT", "/v1/meshes/m", "{\"shape\":\"cube\"}")));
    reply_done(reply_expect(403, ask(c, &alice, "POST", "/v1/admin/reload", NULL)));
    r = reply_expect(200, ask(c, &alice, "GET", "/v1/token", NULL));
    assert_string_equal(reply_string(&r, "name"), "alice");
    reply_done(r);

    listener *l = listener_open_as(d, "/v1/meshes/m/events", alice.token);
    listener *stays = listener_open_as(d, "/v1/meshes/m/events", boss.token);
    assert_int_equal(l->status, 200);
    write_file("wrong", boss.line);
    assert_int_equal(kill(daemon_pid(d), SIGHUP), 0);
    char *log = daemon_wait_log(d, "line 2: the line does not have the form NAME ROLE", 1);
    assert_null(strstr(log, alice.token));
    free(log);
    r = reply_expect(409, ask(c, &boss, "POST", "/v1/admin/reload", NULL));
    assert_non_null(strstr(reply_string(&r, "detail"), "line 2"));
    reply_done(r);
    reply_done(reply_expect(200, ask(c, &alice, "GET", "/v1/meshes/m", NULL)));

    write_file("#", boss.line);
    assert_int_equal(kill(daemon_pid(d), SIGHUP), 0);
    free(daemon_wait_log(d, "1 tokens are accepted", 1));
    assert_string_equal(listener_next(l, true), "bye");
    assert_string_equal(listener_string(l, "reason"), "token");
    assert_string_equal(listener_next(l, true), "");
    reply_done(reply_expect(401, ask(c, &alice, "GET", "/v1/meshes/m", NULL)));
    reply_done(reply_expect(200, ask(c, &boss, "PATCH", "/v1/meshes/m", "{\"name\":\"x\"}")));
    assert_string_equal(listener_next(stays, true), "metadata");
    listener_close(l);
    listener_close(stays);
    client_free(c);
    log = daemon_stop_and_tell(d);
    assert_null(strstr(log, alice.token));
    assert_null(strstr(log, boss.token));
    free(log);
}

/* Sends POST /v1/admin/reload on a connection of its own, which is returned. */
static int begin_reload(const daemon_process *d, const made *who)
{
    char request[400];
    const int length = snprintf(request, sizeof request,
                                "POST /v1/admin/reload HTTP/1.1\r\nHost: localhost\r\n%s\r\n"
                                "Content-Length: 0\r\n\r\n",
                                who->header);
    int fd = client_connect(d, 0);
    assert_int_equal(write(fd, request, (size_t)length), length);
    return fd;
}

static void end_reload(int fd)
{
    char answer[13] = "";
    for (size_t used = 0; used < 12;) {
        const ssize_t got = read(fd, answer + used, 12 - used);
        assert_true(got > 0);
        used += (size_t)got;
    }
    assert_string_equal(answer, "HTTP/1.1 200");
    close(fd);
}

/* A reload that began before a token was removed must not bring it back when it ends after another
 * reload. The first reload reads a pipe, so that the test decides when it ends. */
static void a_reload_does_not_undo_a_later_one(void **state)
{
    (void)state;
    made alice = make("alice", "write"), boss = make("boss", "admin");
    char other[FOLDER_PATH + 10];
    snprintf(other, sizeof other, "%s/pipe", folder);
    write_file(alice.line, boss.line);
    daemon_process *d = daemon_start(ARGUMENTS("--tokens", path));
    client *c = client_new(d);
    assert_int_equal(mkfifo(other, 0600), 0);
    assert_int_equal(rename(other, path), 0);
    int first = begin_reload(d, &boss);
    FILE *feed = fopen(path, "w"); /* returns when the daemon has opened the pipe, too */
    assert_non_null(feed);
    assert_int_equal(unlink(path), 0);
    write_file("#", boss.line);
    int second = begin_reload(d, &boss);
    /* These requests give the second reload time to end first, which it must not do. */
    for (int i = 0; i < 100; i++) {
        reply_done(reply_expect(200, ask(c, &alice, "GET", "/v1/token", NULL)));
    }
    fprintf(feed, "%s\n%s\n", alice.line, boss.line);
    assert_int_equal(fclose(feed), 0);
    end_reload(first);
    end_reload(second);
    reply_done(reply_expect(401, ask(c, &alice, "GET", "/v1/token", NULL)));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_wrong_file_is_no_start(void **state)
{
    (void)state;
    char said[8192];
    write_file("alice read sha256:", "");
    assert_int_equal(
        daemon_run(ARGUMENTS("--listen", "127.0.0.1:0", "--store", "memory", "--tokens", path),
                   said, sizeof said),
        1);
    assert_non_null(strstr(said, "line 2: the hash (field 3)"));
    assert_int_equal(daemon_run(ARGUMENTS("--listen", "127.0.0.1:0", "--store", "memory",
                                          "--tokens", "/nowhere/tokens"),
                                said, sizeof said),
                     1);
    assert_non_null(strstr(said, "No such file"));
    assert_int_equal(daemon_run(ARGUMENTS("--listen", "0.0.0.0:0"), said, sizeof said), 2);
    assert_non_null(strstr(said, "give a file with --tokens, or set --insecure"));
    assert_int_equal(daemon_run(ARGUMENTS("--new-token", "a b"), said, sizeof said), 2);
    assert_int_equal(daemon_run(ARGUMENTS("--new-token", "a", "root"), said, sizeof said), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_daemon_asks_for_tokens_and_reads_its_file_again),
        cmocka_unit_test(a_reload_does_not_undo_a_later_one),
        cmocka_unit_test(a_wrong_file_is_no_start),
    };
    folder_make(folder);
    snprintf(path, sizeof path, "%s/tokens", folder);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    folder_remove(folder);
    return failed;
}
