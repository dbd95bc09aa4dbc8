/* The daemon as a process: its options, its log, its signals, and what it does at its limits. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"

#include <pthread.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static void expect_run(const char *const *arguments, int status, const char *words)
{
    char output[16384];
    int got = daemon_run(arguments, output, sizeof output);
    if (got != status || strstr(output, words) == NULL) {
        fail_msg("%s ...: exit %d instead of %d, or no \"%s\" in:\n%s", arguments[0], got, status,
                 words, output);
    }
}

static void options_are_obeyed_or_refused_with_a_reason(void **state)
{
    (void)state;
    expect_run(ARGUMENTS("--version"), 0, "hedged ");
    expect_run(ARGUMENTS("--help"), 0, "--listen");
    expect_run(ARGUMENTS("--help"), 0, "HEDGE_");
    expect_run(ARGUMENTS("--print-config", "--workers", "1"), 0, "workers");
    expect_run(ARGUMENTS("--no-such-option"), 2, "no-such-option");
    expect_run(ARGUMENTS("--workers", "many"), 2, "many");
    expect_run(ARGUMENTS("--listen", "nowhere"), 2, "nowhere");
    expect_run(ARGUMENTS("--store", "here"), 2, "sqlite:DIR");
    expect_run(ARGUMENTS("--store", "sqlite:"), 2, "sqlite:DIR");
    expect_run(ARGUMENTS("--store", "sqlite:/proc/1/none/none"), 1, "cannot make");
    expect_run(ARGUMENTS("--listen", "0.0.0.0:0"), 2, "other machines");
}

/* Reads the commit from the file that the build wrote beside the daemon. The file is empty if the
 * sources are no clone of the repository. */
static void read_commit(char out[64])
{
    const char *given = getenv("HEDGED"), *path = given == NULL ? "build/hedged" : given;
    char name[4096];
    snprintf(name, sizeof name, "%.*s/commit", (int)(strrchr(path, '/') - path), path);
    FILE *file = fopen(name, "r");
    assert_non_null(file);
    out[fread(out, 1, 63, file)] = '\0';
    assert_int_equal(fclose(file), 0);
    out[strcspn(out, "\n")] = '\0';
}

/* The short names of the options must give the same output as the long ones. */
static void help_and_version_have_short_spellings(void **state)
{
    (void)state;
    static const char *const spellings[][2] = {{"-h", "--help"}, {"-V", "--version"}};
    static char outputs[2][32768];
    for (size_t i = 0; i < 2; i++) {
        for (size_t j = 0; j < 2; j++) {
            assert_int_equal(daemon_run(ARGUMENTS(spellings[i][j]), outputs[j], sizeof outputs[j]),
                             0);
        }
        assert_string_equal(outputs[0], outputs[1]);
    }
    int lines = 0;
    for (const char *line = strstr(outputs[0], "hedged "); line != NULL; lines++) {
        line = strchr(line, '\n');
        line = line == NULL || line[1] == '\0' ? NULL : line + 1;
    }
    assert_int_equal(lines, 1);
    char commit[64], told[80];
    read_commit(commit);
    snprintf(told, sizeof told, "(commit %s)", commit);
    assert_true((strstr(outputs[0], "(commit ") != NULL) == (commit[0] != '\0'));
    assert_true(commit[0] == '\0' || strstr(outputs[0], told) != NULL);
}

/* All descriptions begin in one column, even if an option is too long to stand before its
 * description. */
static void help_is_in_two_columns(void **state)
{
    (void)state;
    enum { COLUMN = 29 };
    static char output[32768];
    int options = 0, long_ones = 0;
    assert_int_equal(daemon_run(ARGUMENTS("--help"), output, sizeof output), 0);
    char *rest = strstr(output, "  --");
    assert_non_null(rest);
    for (char *line = strtok_r(rest, "\n", &rest); line != NULL;
         line = strtok_r(NULL, "\n", &rest)) {
        const bool begins = strncmp(line, "  --", 4) == 0;
        const bool alone = begins && strstr(line + 2, "  ") == NULL && strlen(line) > COLUMN - 1 &&
                           line[COLUMN - 1] != ' ';
        options += begins;
        long_ones += alone;
        if (!alone && (strlen(line) <= COLUMN || line[COLUMN - 1] != ' ' || line[COLUMN] == ' ' ||
                       (!begins && strspn(line, " ") != COLUMN))) {
            fail_msg("\"%s\" has no description in column %d", line, COLUMN);
        }
    }
    assert_true(options > 40 && long_ones > 0);
}

static void an_address_in_use_is_named_and_healthcheck_finds_its_daemon(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(NULL);
    const char *address = strstr(daemon_url(d), "127");
    /* "127.0.0.1:PORT", or the path of a Unix socket */
    address = address == NULL ? daemon_url(d) : address;
    char output[4096];
    assert_int_equal(
        daemon_run(ARGUMENTS("--listen", address, "--store", "memory"), output, sizeof output), 1);
    assert_non_null(strstr(output, address));
    assert_int_equal(daemon_run(ARGUMENTS("--healthcheck", daemon_url(d)), output, sizeof output),
                     0);
    char url[64];
    snprintf(url, sizeof url, "%s", daemon_url(d));
    assert_int_equal(daemon_stop(d), 0);
    assert_int_not_equal(daemon_run(ARGUMENTS("--healthcheck", url), output, sizeof output), 0);
}

static void it_offers_samples_keeps_request_ids_and_outlives_sighup(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--samples"));
    client *c = client_new(d);
    reply r = client_get(c, "/v1/meshes");
    assert_int_equal(r.status, 200);
    assert_true(cJSON_GetArraySize(reply_find(&r, "items")) >= 3);
    reply_free(&r);
    r = client_send(c, "GET", "/livez", ARGUMENTS("X-Request-Id: my-own.id_1"), NULL);
    char id[128];
    assert_string_equal(reply_header(&r, "X-Request-Id", id, sizeof id), "my-own.id_1");
    reply_free(&r);
    r = client_send(c, "GET", "/livez", ARGUMENTS("X-Request-Id: bad\"id"), NULL);
    assert_string_not_equal(reply_header(&r, "X-Request-Id", id, sizeof id), "bad\"id");
    reply_free(&r);
    client_free(c);
    kill(daemon_pid(d), SIGHUP); /* SIGHUP must not stop the daemon, with or without tokens */
    c = client_new(d);
    r = client_get(c, "/livez");
    assert_int_equal(r.status, 200);
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Each request must leave one line of JSON, which is written before the daemon ends. */
static void each_request_leaves_a_line_of_json_in_the_log(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    for (int i = 0; i < 20; i++) {
        reply r = client_get(c, "/version");
        assert_int_equal(r.status, 200);
        reply_free(&r);
    }
    client_free(c);
    char *log = daemon_wait_log(d, "\"route\":\"/version\"", 20);
    char *line = strstr(log, "\"route\":\"/version\"");
    while (line > log && line[-1] != '\n') {
        line--;
    }
    cJSON *json = cJSON_Parse(line);
    assert_non_null(json);
    assert_int_equal(cJSON_GetObjectItem(json, "status")->valueint, 200);
    cJSON_Delete(json);
    free(log);
    assert_int_equal(daemon_stop(d), 0);
}

static char *log_of_a_request(daemon_process *d)
{
    client *c = client_new(d);
    reply_done(reply_expect(200, client_get(c, "/version")));
    client_free(c);
    return daemon_stop_and_tell(d);
}

static void a_terminal_is_told_what_to_open_and_spared_the_log(void **state)
{
    (void)state;
    daemon_process *d = daemon_start_on_terminal(NULL);
    char hint[400];
    const char *url = daemon_url(d);
    /* a browser cannot open a Unix socket, so the daemon suggests curl */
    if (transport_get() == TRANSPORT_UNIX) {
        snprintf(hint, sizeof hint,
                 ": listening on %s\ncurl --unix-socket %s http://localhost/v1/meshes asks hedge; "
                 "Ctrl-C stops it\n",
                 url, url + strlen("unix:"));
    } else {
        snprintf(hint, sizeof hint,
                 ": listening on %s\nhedge is at %s/ - open it in a browser; Ctrl-C stops it\n",
                 url, url);
    }
    char *log = log_of_a_request(d);
    assert_non_null(strstr(log, hint));
    assert_null(strstr(log, "/version"));
    assert_null(strstr(log, "{\""));
    free(log);

    log = log_of_a_request(daemon_start_on_terminal(ARGUMENTS("--log", "access")));
    assert_non_null(strstr(log, " GET /version 200 "));
    free(log);

    log = log_of_a_request(daemon_start(NULL));
    assert_null(strstr(log, "Ctrl-C"));
    assert_non_null(strstr(log, "\"route\":\"/version\""));
    free(log);
}

typedef struct worker {
    const daemon_process *daemon;
    int id, answered;
} worker;

/* Sends edits until the daemon has stopped; each answer that came must be complete. */
static void *edit_on(void *context)
{
    worker *w = context;
    client *c = client_new(w->daemon);
    char path[64];
    snprintf(path, sizeof path, "/v1/meshes/m%d/edits", w->id);
    for (;;) {
        reply r = client_post(c, path, "{\"op\":\"face_poke\",\"face\":0}");
        bool stopped = r.status != 200;
        w->answered += !stopped;
        reply_free(&r);
        if (stopped) {
            break;
        }
    }
    client_free(c);
    return NULL;
}

static void sigterm_ends_the_daemon_while_clients_write(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    enum { WORKERS = 4 };
    worker workers[WORKERS];
    pthread_t threads[WORKERS];
    for (int i = 0; i < WORKERS; i++) {
        char path[64];
        snprintf(path, sizeof path, "/v1/meshes/m%d", i);
        reply r = client_send(c, "PUT", path, NULL, "{\"shape\":\"cube\"}");
        assert_int_equal(r.status, 201);
        reply_free(&r);
        workers[i] = (worker){d, i, 0};
        assert_int_equal(pthread_create(&threads[i], NULL, edit_on, &workers[i]), 0);
    }
    reply r = client_get(c, "/v1/meshes/m0"); /* the writers have begun when this GET is answered */
    assert_int_equal(r.status, 200);
    reply_free(&r);
    client_free(c);
    /* `d` (the daemon) is freed only after all writers have seen the daemon end, because they use
     * it. */
    kill(daemon_pid(d), SIGTERM);
    for (int i = 0; i < WORKERS; i++) {
        pthread_join(threads[i], NULL);
    }
    assert_int_equal(daemon_stop(d), 0);
}

static void too_many_meshes_are_507_and_a_large_body_is_413(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--max-meshes", "2", "--max-upload", "1024"));
    client *c = client_new(d);
    const int expected[3] = {201, 201, 507};
    for (int i = 0; i < 3; i++) {
        reply r = client_post(c, "/v1/meshes", "{\"shape\":\"cube\"}");
        assert_int_equal(r.status, expected[i]);
        if (r.status == 507) {
            assert_string_equal(reply_string(&r, "code"), "too_many_meshes");
        }
        reply_free(&r);
    }
    char big[2001];
    memset(big, ' ', 2000);
    big[2000] = '\0';
    reply r = client_post(c, "/v1/meshes", big);
    assert_int_equal(r.status, 413);
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void harmless_signals_do_not_end_it(void **state)
{
    (void)state;
    static const int numbers[] = {SIGHUP,    SIGPIPE, SIGALRM, SIGUSR1,   SIGUSR2,
                                  SIGVTALRM, SIGPROF, SIGPOLL, SIGSTKFLT, SIGPWR};
    daemon_process *d = daemon_start(NULL);
    client *c = client_new(d);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        assert_int_equal(kill(daemon_pid(d), numbers[i]), 0);
        reply_done(reply_expect(200, client_get(c, "/livez")));
    }
    for (int number = SIGRTMIN; number <= SIGRTMAX; number++) {
        assert_int_equal(kill(daemon_pid(d), number), 0);
    }
    reply_done(reply_expect(200, client_get(c, "/livez")));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_are_obeyed_or_refused_with_a_reason),
        cmocka_unit_test(help_and_version_have_short_spellings),
        cmocka_unit_test(help_is_in_two_columns),
        cmocka_unit_test(an_address_in_use_is_named_and_healthcheck_finds_its_daemon),
        cmocka_unit_test(it_offers_samples_keeps_request_ids_and_outlives_sighup),
        cmocka_unit_test(each_request_leaves_a_line_of_json_in_the_log),
        cmocka_unit_test(a_terminal_is_told_what_to_open_and_spared_the_log),
        cmocka_unit_test(sigterm_ends_the_daemon_while_clients_write),
        cmocka_unit_test(too_many_meshes_are_507_and_a_large_body_is_413),
        cmocka_unit_test(harmless_signals_do_not_end_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
