/* A daemon that speaks TLS, and a daemon on a Unix socket: which clients can connect, and what a
 * new certificate changes. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"
#include "tests/store_folder.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static char folder[FOLDER_PATH];
static char certificate[FOLDER_PATH + 20], key[FOLDER_PATH + 20], first[FOLDER_PATH + 20];

/* Runs a shell command; returns its status, and its output in `said`. */
static int shell(char *said, size_t size, const char *format, ...)
{
    char command[2000];
    va_list values;
    va_start(values, format);
    vsnprintf(command, sizeof command, format, values);
    va_end(values);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(said, 1, size - 1, pipe);
    said[length] = '\0';
    return pclose(pipe);
}

static void copy(const char *from, const char *to)
{
    char said[200];
    assert_int_equal(shell(said, sizeof said, "cp %s %s", from, to), 0);
}

static daemon_process *start(void)
{
    return daemon_start(ARGUMENTS("--tls-cert", certificate, "--tls-key", key));
}

/* Connects with openssl s_client and the options `options`; `said` becomes its output. */
static void s_client(const daemon_process *d, const char *options, char *said, size_t size)
{
    shell(said, size,
          "openssl s_client -connect 127.0.0.1:%d -cipher DEFAULT@SECLEVEL=0 %s </dev/null 2>&1",
          daemon_port(d), options);
}

static void versions_before_1_2_are_refused(void **state)
{
    (void)state;
    daemon_process *d = start();
    char said[20000];
    static const char *const old[] = {"-tls1", "-tls1_1"};
    for (size_t i = 0; i < 2; i++) {
        s_client(d, old[i], said, sizeof said);
        /* The output must show that the client began a handshake and that the daemon ended it. */
        if (strstr(said, "Cipher is (NONE)") == NULL || strstr(said, "unexpected eof") == NULL) {
            fail_msg("%s: %s", old[i], said);
        }
    }
    s_client(d, "-tls1_2", said, sizeof said);
    assert_non_null(strstr(said, "New, TLSv1.2, Cipher is ECDHE-"));
    s_client(d, "-tls1_3", said, sizeof said);
    assert_non_null(strstr(said, "New, TLSv1.3, Cipher is TLS_"));
    assert_int_equal(daemon_stop(d), 0);
}

/* In TLS 1.2 a client may ask for another handshake, which openssl does at an input line "R". The
 * input of openssl stays open, so openssl ends only if the daemon closes the connection. */
static void a_client_that_renegotiates_is_closed(void **state)
{
    (void)state;
    char said[20000], address[40], out[FOLDER_PATH + 20];
    int input[2], waited;
    daemon_process *d = start();
    snprintf(address, sizeof address, "127.0.0.1:%d", daemon_port(d));
    snprintf(out, sizeof out, "%s/said", folder);
    assert_int_equal(pipe(input), 0);
    pid_t pid = fork();
    assert_true(pid >= 0);
    if (pid == 0) {
        dup2(input[0], STDIN_FILENO);
        close(input[0]);
        close(input[1]);
        if (freopen(out, "w", stdout) == NULL || dup2(STDOUT_FILENO, STDERR_FILENO) < 0) {
            _exit(126);
        }
        execlp("openssl", "openssl", "s_client", "-connect", address, "-tls1_2", (char *)NULL);
        _exit(127);
    }
    close(input[0]);
    assert_int_equal(write(input[1], "R\n", 2), 2);
    assert_int_equal(waitpid(pid, &waited, 0), pid);
    close(input[1]);
    shell(said, sizeof said, "cat %s", out);
    if (strstr(said, "RENEGOTIATING\nclosed") == NULL) {
        fail_msg("%s", said);
    }
    assert_int_equal(daemon_stop(d), 0);
}

static void a_new_certificate_is_for_new_connections(void **state)
{
    (void)state;
    char said[20000];
    transport_make_pair("before", certificate, key);
    copy(certificate, first);
    daemon_process *d = start();
    client *c = client_new(d);
    client_trust(c, first);
    reply_done(reply_expect(200, client_get(c, "/livez")));

    transport_make_pair("after", certificate, key);
    kill(daemon_pid(d), SIGHUP);
    free(daemon_wait_log(d, "new connections use the certificate", 1));
    s_client(d, "", said, sizeof said);
    assert_non_null(strstr(said, "subject=CN = after"));
    /* The client `c` trusts only the old certificate. It keeps the connection that it opened before
     * the change, so the new certificate does not matter there. */
    reply_done(reply_expect(200, client_get(c, "/livez")));
    client *other = client_new(d);
    client_trust(other, certificate);
    reply_done(reply_expect(200, client_get(other, "/livez")));
    client_free(other);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_bad_pair_leaves_the_one_before_in_force(void **state)
{
    (void)state;
    char said[20000], other[FOLDER_PATH + 20];
    snprintf(other, sizeof other, "%s/other.pem", folder);
    transport_make_pair("kept", certificate, key);
    copy(certificate, first);
    daemon_process *d = start();
    transport_make_pair("unused", other, key);
    kill(daemon_pid(d), SIGHUP);
    char *log = daemon_wait_log(d, "the previous settings stay in effect", 1);
    assert_non_null(strstr(log, "does not belong to the first certificate in"));
    assert_non_null(strstr(log, certificate));
    free(log);
    client *c = client_new(d);
    client_trust(c, first);
    reply r = client_post(c, "/v1/admin/reload", NULL);
    assert_true(r.status >= 400);
    assert_non_null(strstr(r.body, key));
    reply_done(r);
    client_free(c);
    s_client(d, "", said, sizeof said);
    assert_non_null(strstr(said, "subject=CN = kept"));
    assert_int_equal(daemon_stop(d), 0);
}

static void what_cannot_serve_stops_the_start(void **state)
{
    (void)state;
    char said[20000], other[FOLDER_PATH + 20];
    snprintf(other, sizeof other, "%s/second.pem", folder);
    transport_make_pair("one", certificate, key);
    transport_make_pair("two", first, other);
    const struct {
        const char *certificate, *key, *why;
    } rows[] = {
        {certificate, other, "does not belong to the first certificate in"},
        {key, key, "has no certificate in PEM: No certificate was found\""},
        {certificate, certificate, "has no private key in PEM"},
        {"/nowhere/c.pem", key, "/nowhere/c.pem cannot be read: No such file"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        int status =
            daemon_run(ARGUMENTS("--listen", "127.0.0.1:0", "--store", "memory", "--tls-cert",
                                 rows[i].certificate, "--tls-key", rows[i].key),
                       said, sizeof said);
        assert_int_equal(status, 1);
        if (strstr(said, rows[i].why) == NULL) {
            fail_msg("row %zu: %s", i, said);
        }
    }
    assert_int_equal(daemon_run(ARGUMENTS("--tls-cert", certificate), said, sizeof said), 2);
    assert_non_null(strstr(said, "--tls-cert needs --tls-key"));
    assert_int_equal(daemon_run(ARGUMENTS("--tls-key", key), said, sizeof said), 2);
    assert_non_null(strstr(said, "--tls-key needs --tls-cert"));
    assert_int_equal(
        daemon_run(ARGUMENTS("--listen", "unix:x", "--tls-cert", certificate, "--tls-key", key),
                   said, sizeof said),
        2);
}

/* Framing faults, such as line feeds without carriage returns or an invalid size of a chunk, must
 * be refused over TLS as they are over TCP. */
static void what_comes_over_tls_is_checked_byte_for_byte(void **state)
{
    (void)state;
    transport_make_pair("checked", certificate, key);
    daemon_process *d = start();
    char said[20000];
    static const char *const requests[] = {
        "GET /livez HTTP/1.1\\nHost: localhost\\n\\n",
        "GET /livez HTTP/1.1\\r\\nHost: localhost\\r\\nContent-Length: 1\\r\\nContent-Length: "
        "2\\r\\n\\r\\n",
        "POST /v1/meshes HTTP/1.1\\r\\nHost: localhost\\r\\nTransfer-Encoding: "
        "chunked\\r\\n\\r\\nZZ\\r\\n",
    };
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        shell(said, sizeof said,
              "printf '%s' | openssl s_client -quiet -ign_eof -connect 127.0.0.1:%d 2>/dev/null",
              requests[i], daemon_port(d));
        if (strncmp(said, "HTTP/1.1 400 ", 13) != 0) {
            fail_msg("request %zu: %s", i, said);
        }
    }
    assert_int_equal(daemon_stop(d), 0);
}

static void a_handshake_that_is_not_finished_is_closed(void **state)
{
    (void)state;
    transport_make_pair("slow", certificate, key);
    daemon_process *d = daemon_start(ARGUMENTS("--tls-cert", certificate, "--tls-key", key,
                                               "--header-timeout", "1", "--idle-timeout", "3600"));
    char byte;
    int fd = client_connect(d, 0);
    assert_true(read(fd, &byte, 1) <= 0);
    close(fd);
    /* The failed handshake is counted when its connection is closed, which may be a moment
     * later. */
    client *c = client_new(d);
    client_trust(c, certificate);
    bool failed;
    do {
        reply r = reply_expect(200, client_get(c, "/metrics"));
        assert_non_null(strstr(r.body, "\nhedge_tls_handshakes_total{result=\"completed\"} 1\n"));
        failed = strstr(r.body, "\nhedge_tls_handshakes_total{result=\"failed\"} 1\n") != NULL;
        reply_free(&r);
    } while (!failed);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void a_health_check_speaks_as_its_daemon_does(void **state)
{
    (void)state;
    char said[400], listen[FOLDER_PATH + 20];
    transport_make_pair("healthy", certificate, key);
    daemon_process *d = start();
    assert_int_equal(daemon_run(ARGUMENTS("--healthcheck", daemon_url(d)), said, sizeof said), 0);
    snprintf(listen, sizeof listen, "%s", daemon_url(d) + strlen("https://"));
    assert_int_equal(daemon_run(ARGUMENTS("--listen", listen, "--tls-cert", certificate,
                                          "--tls-key", key, "--healthcheck"),
                                said, sizeof said),
                     0);
    assert_int_equal(daemon_run(ARGUMENTS("--listen", listen, "--healthcheck"), said, sizeof said),
                     1);
    assert_int_equal(daemon_stop(d), 0);
    snprintf(listen, sizeof listen, "unix:%s/healthy", folder);
    d = daemon_start(ARGUMENTS("--listen", listen));
    assert_int_equal(daemon_run(ARGUMENTS("--listen", listen, "--healthcheck"), said, sizeof said),
                     0);
    assert_int_equal(daemon_run(ARGUMENTS("--healthcheck", listen), said, sizeof said), 0);
    assert_int_equal(daemon_stop(d), 0);
    assert_int_equal(daemon_run(ARGUMENTS("--healthcheck", listen), said, sizeof said), 1);
}

static void a_unix_socket_is_made_and_removed(void **state)
{
    (void)state;
    char listen[FOLDER_PATH + 20], said[20000], longest[200];
    struct stat found;
    snprintf(listen, sizeof listen, "unix:%s/socket", folder);
    daemon_process *d = daemon_start(ARGUMENTS("--listen", listen, "--log", "access"));
    assert_string_equal(daemon_url(d), listen);
    assert_int_equal(stat(listen + 5, &found), 0);
    assert_int_equal(found.st_mode & 07777, 0660);
    client *c = client_new(d);
    reply_done(reply_expect(201, client_post(c, "/v1/meshes", "{\"shape\":\"cube\"}")));
    /* The socket of a running daemon must not be taken over by a second daemon. */
    assert_int_equal(
        daemon_run(ARGUMENTS("--listen", listen, "--store", "memory"), said, sizeof said), 1);
    assert_non_null(strstr(said, "another program listens on this socket"));
    reply_done(reply_expect(200, client_get(c, "/livez")));
    char *log = daemon_wait_log(d, "\"peer\":\"unix:uid=", 2);
    free(log);
    client_free(c);
    daemon_kill(d);
    assert_int_equal(stat(listen + 5, &found), 0);
    /* A socket that a killed daemon left behind must be replaced. */
    d = daemon_start(ARGUMENTS("--listen", listen));
    assert_int_equal(daemon_stop(d), 0);
    assert_int_not_equal(stat(listen + 5, &found), 0);
    /* A file that is no socket must not be removed, even if it has the name of the socket. */
    assert_int_equal(shell(said, sizeof said, "echo x >%s", listen + 5), 0);
    assert_int_equal(
        daemon_run(ARGUMENTS("--listen", listen, "--store", "memory"), said, sizeof said), 1);
    assert_non_null(strstr(said, "and is not a socket"));
    memset(longest, 'x', sizeof longest);
    memcpy(longest, "unix:", 5);
    longest[5 + 108] = '\0';
    assert_int_equal(daemon_run(ARGUMENTS("--listen", longest), said, sizeof said), 2);
}

/* A client of a Unix socket that reads nothing of a long answer must be disconnected, as over
 * TCP. */
static void a_slow_reader_of_a_unix_socket_is_closed(void **state)
{
    (void)state;
    char listen[FOLDER_PATH + 20];
    snprintf(listen, sizeof listen, "unix:%s/slow", folder);
    daemon_process *d = daemon_start(
        ARGUMENTS("--listen", listen, "--log", "access", "--body-grace", "1", "--min-rate", "64K"));
    client *c = client_new(d);
    reply_done(reply_expect(201, client_post(c, "/v1/meshes?id=large",
                                             "{\"shape\":\"icosphere\",\"subdivisions\":6}")));
    int fd = client_connect(d, 0);
    static const char request[] =
        "GET /v1/meshes/large/content?format=obj HTTP/1.1\r\nHost: localhost\r\n\r\n";
    assert_int_equal(write(fd, request, sizeof request - 1), (int)sizeof request - 1);
    /* The request is logged when the daemon closes the connection; the client reads nothing
     * before. */
    free(daemon_wait_log(d, "/v1/meshes/large/content", 1));
    close(fd);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static int make_folder(void **state)
{
    (void)state;
    /* TRANSPORT in the environment does not matter here: each test sets the options of its
     * transport */
    transport_choose(TRANSPORT_TCP);
    folder_make(folder);
    snprintf(certificate, sizeof certificate, "%s/certificate.pem", folder);
    snprintf(key, sizeof key, "%s/key.pem", folder);
    snprintf(first, sizeof first, "%s/first.pem", folder);
    transport_make_pair("localhost", certificate, key);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    folder_remove(folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(versions_before_1_2_are_refused),
        cmocka_unit_test(a_client_that_renegotiates_is_closed),
        cmocka_unit_test(a_new_certificate_is_for_new_connections),
        cmocka_unit_test(a_bad_pair_leaves_the_one_before_in_force),
        cmocka_unit_test(what_cannot_serve_stops_the_start),
        cmocka_unit_test(what_comes_over_tls_is_checked_byte_for_byte),
        cmocka_unit_test(a_handshake_that_is_not_finished_is_closed),
        cmocka_unit_test(a_health_check_speaks_as_its_daemon_does),
        cmocka_unit_test(a_unix_socket_is_made_and_removed),
        cmocka_unit_test(a_slow_reader_of_a_unix_socket_is_closed),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
