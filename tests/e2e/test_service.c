/* The daemon as a service of the operating system: it tells systemd its state, and it reads its
 * settings from a file. */
#include "tests/e2e/client.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

/* Opens the socket on which systemd would receive messages. `name`, the value of NOTIFY_SOCKET, is
 * a file or, with '@', a name in the kernel's abstract namespace. */
static int be_systemd(const char *name)
{
    struct sockaddr_un own = {.sun_family = AF_UNIX};
    size_t length = strlen(name);
    assert_true(length < sizeof own.sun_path);
    memcpy(own.sun_path, name, length);
    if (name[0] == '@') {
        own.sun_path[0] = '\0';
    }
    int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    assert_true(fd >= 0);
    assert_int_equal(bind(fd, (struct sockaddr *)&own,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length)),
                     0);
    setenv("NOTIFY_SOCKET", name, 1);
    return fd;
}

/* Receives the next message that is not a watchdog heartbeat; `text` must hold 512 bytes. */
static void hear(int fd, char *text)
{
    do {
        ssize_t length = recv(fd, text, 511, 0);
        assert_true(length > 0);
        text[length] = '\0';
    } while (strcmp(text, "WATCHDOG=1") == 0);
}

static void expect_message(int fd, const char *expected)
{
    char text[512];
    ssize_t length = recv(fd, text, sizeof text - 1, 0);
    assert_true(length > 0);
    text[length] = '\0';
    assert_string_equal(text, expected);
}

/* Requires the message READY, with the STATUS that systemd then shows. */
static void expect_ready(int fd, const daemon_process *d)
{
    char expected[256], text[512];
    snprintf(expected, sizeof expected, "READY=1\nSTATUS=listening on %s", daemon_url(d));
    hear(fd, text);
    assert_string_equal(text, expected);
}

static void systemd_hears_of_start_life_and_stop(void **state)
{
    (void)state;
    char folder[] = "/tmp/notify-XXXXXX", file[64], name[64];
    assert_non_null(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/socket", folder);
    snprintf(name, sizeof name, "@hedge-notify-%d", (int)getpid());
    const char *const names[] = {file, name};
    setenv("WATCHDOG_USEC", "100000", 1);
    for (size_t i = 0; i < 2; i++) {
        int fd = be_systemd(names[i]);
        daemon_process *d = daemon_start(ARGUMENTS("--log", "access"));
        expect_ready(fd, d);
        expect_message(fd, "WATCHDOG=1");
        expect_message(fd, "WATCHDOG=1");
        free(daemon_wait_log(d, "/livez", 2));
        kill(daemon_pid(d), SIGTERM);
        char text[512];
        hear(fd, text);
        assert_string_equal(text, "STOPPING=1\nSTATUS=stopping");
        assert_int_equal(daemon_stop(d), 0);
        close(fd);
    }
    unsetenv("WATCHDOG_USEC");
    unsetenv("NOTIFY_SOCKET");
    unlink(file);
    rmdir(folder);
}

/* If WATCHDOG_PID names another process, this daemon must send no heartbeats. */
static void a_watchdog_of_another_process_is_not_fed(void **state)
{
    (void)state;
    char name[64];
    snprintf(name, sizeof name, "@hedge-watched-%d", (int)getpid());
    int fd = be_systemd(name);
    setenv("WATCHDOG_USEC", "1000", 1);
    setenv("WATCHDOG_PID", "1", 1);
    daemon_process *d = daemon_start(NULL);
    expect_ready(fd, d);
    assert_int_equal(daemon_stop(d), 0);
    expect_message(fd, "STOPPING=1\nSTATUS=stopping");
    unsetenv("WATCHDOG_PID");
    unsetenv("WATCHDOG_USEC");
    unsetenv("NOTIFY_SOCKET");
    close(fd);
}

/* Fills the queue of the socket `to` with heartbeats, which hear() skips. A sender may have only so
 * many unread messages, so there are several senders. */
static void fill(int to)
{
    struct sockaddr_un name;
    socklen_t length = sizeof name;
    size_t sent;
    assert_int_equal(getsockname(to, (struct sockaddr *)&name, &length), 0);
    do {
        int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        assert_true(fd >= 0);
        sent = 0;
        while (sendto(fd, "WATCHDOG=1", 10, 0, (struct sockaddr *)&name, length) > 0) {
            sent++;
        }
        close(fd);
    } while (sent > 0);
}

/* The daemon must not wait for a systemd that reads no messages. Once systemd reads them again, it
 * must be told that the daemon is ready, or it would end the daemon. */
static void a_systemd_that_reads_nothing_delays_nothing(void **state)
{
    (void)state;
    char name[64], text[512];
    snprintf(name, sizeof name, "@hedge-full-%d", (int)getpid());
    int fd = be_systemd(name);
    fill(fd);
    daemon_process *d = daemon_start(NULL);
    assert_int_equal(daemon_stop(d), 0);
    /* The daemon checks itself for the watchdog only after it has sent READY for the first time. */
    setenv("WATCHDOG_USEC", "100000", 1);
    d = daemon_start(ARGUMENTS("--log", "access"));
    unsetenv("WATCHDOG_USEC");
    free(daemon_wait_log(d, "/livez", 1));
    expect_ready(fd, d);
    assert_int_equal(daemon_stop(d), 0);
    hear(fd, text);
    assert_string_equal(text, "STOPPING=1\nSTATUS=stopping");
    unsetenv("NOTIFY_SOCKET");
    close(fd);
}

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    assert_int_equal(fputs(text, out) < 0, 0);
    assert_int_equal(fclose(out), 0);
}

static void a_file_holds_the_settings(void **state)
{
    (void)state;
    char file[] = "/tmp/settings-XXXXXX", output[16384], expected[128];
    int fd = mkstemp(file);
    assert_true(fd >= 0);
    close(fd);
    write_file(file, "# one a line\n\n  listen = 127.0.0.1:0\nmax-meshes=2\nsamples = 0\n");
    setenv("HEDGE_CONFIG", file, 1);
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    for (int i = 0; i < 3; i++) {
        reply r = client_post(c, "/v1/meshes", "{\"shape\":\"cube\"}");
        assert_int_equal(r.status, i < 2 ? 201 : 507);
        reply_free(&r);
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);

    write_file(file, "samples\nmax-meshs = 2\n");
    assert_int_equal(
        daemon_run(ARGUMENTS("--print-config", "--log-format=text"), output, sizeof output), 2);
    snprintf(expected, sizeof expected, "%s:2: there is no setting \"max-meshs\"", file);
    assert_non_null(strstr(output, expected));
    unsetenv("HEDGE_CONFIG");
    unlink(file);
}

#define TOKEN_LINE \
    "me read sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08\n"

/* A reload of the settings must be reported to systemd: when it begins, by the monotonic clock,
 * when it has ended, and whether it succeeded. */
static void systemd_hears_of_a_reload(void **state)
{
    (void)state;
    char tokens[] = "/tmp/notify-tokens-XXXXXX", name[64], text[512], expected[256];
    int file = mkstemp(tokens);
    assert_true(file >= 0);
    close(file);
    write_file(tokens, TOKEN_LINE);
    snprintf(name, sizeof name, "@hedge-reload-%d", (int)getpid());
    int fd = be_systemd(name);
    daemon_process *d = daemon_start(ARGUMENTS("--tokens", tokens));
    expect_ready(fd, d);
    for (int round = 0; round < 3; round++) {
        struct timespec before;
        unsigned long long when = 0;
        clock_gettime(CLOCK_MONOTONIC, &before);
        write_file(tokens, round == 1 ? "no token at all\n" : TOKEN_LINE);
        kill(daemon_pid(d), SIGHUP);
        hear(fd, text);
        assert_int_equal(sscanf(text, "RELOADING=1\nMONOTONIC_USEC=%llu", &when), 1);
        assert_true(when >= (unsigned long long)before.tv_sec * 1000000);
        if (round == 1) {
            hear(fd, text);
            snprintf(expected, sizeof expected, "READY=1\nSTATUS=not reloaded: the tokens of %s",
                     tokens);
            assert_int_equal(strncmp(text, expected, strlen(expected)), 0);
        } else {
            expect_ready(fd, d);
        }
    }
    assert_int_equal(daemon_stop(d), 0);
    close(fd);
    unsetenv("NOTIFY_SOCKET");
    unlink(tokens);
}

static void variables_that_no_option_has_are_named(void **state)
{
    (void)state;
    setenv("HEDGE_PORT", "tcp://10.0.0.1:8080", 1);
    setenv("HEDGE_MAX_MESHS", "3", 1);
    setenv("HEDGE_MAX_MESHES", "3", 1);
    daemon_process *d = daemon_start(NULL);
    unsetenv("HEDGE_PORT");
    unsetenv("HEDGE_MAX_MESHS");
    unsetenv("HEDGE_MAX_MESHES");
    char *said = daemon_stop_and_tell(d);
    const char *line = strstr(said, "environment variables that belong to no option are ignored: ");
    assert_non_null(line);
    assert_non_null(strstr(line, "HEDGE_PORT"));
    assert_non_null(strstr(line, "HEDGE_MAX_MESHS"));
    assert_null(strstr(line, "HEDGE_MAX_MESHES"));
    assert_null(strstr(line, "10.0.0.1"));
    free(said);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(systemd_hears_of_start_life_and_stop),
        cmocka_unit_test(a_watchdog_of_another_process_is_not_fed),
        cmocka_unit_test(a_systemd_that_reads_nothing_delays_nothing),
        cmocka_unit_test(systemd_hears_of_a_reload),
        cmocka_unit_test(a_file_holds_the_settings),
        cmocka_unit_test(variables_that_no_option_has_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
