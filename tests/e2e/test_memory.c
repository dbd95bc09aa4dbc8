/* The memory that the daemon counts must be the memory that it takes, and the daemon must refuse
 * requests that would exceed its memory budget. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

/* Options that raise the time limit of reads, because on a busy machine a read of a million quads
 * takes long. */
#define PATIENT "--read-seconds", "600"

static double counted(client *c, const char *member)
{
    reply r = reply_expect(200, client_get(c, "/v1/meshes"));
    double value = reply_number(&r, member);
    reply_free(&r);
    return value;
}

static void put_grid(client *c, const char *path, int side, long status)
{
    char body[128];
    snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", side, side);
    reply_done(reply_expect(status, client_send(c, "PUT", path, NULL, body)));
}

static const char lift[] = "{\"op\":\"transform\",\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,1,0,0,0,1]}";

/* A sanitizer adds memory of its own, so resident memory is not compared in a build with a
 * sanitizer. */
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)

static double resident(const daemon_process *d)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/statm", daemon_pid(d));
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    long size, pages;
    assert_int_equal(fscanf(file, "%ld %ld", &size, &pages), 2);
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE);
}

static void compare(client *c, const daemon_process *d, const double start[2], const char *what)
{
    double count = counted(c, "memory_bytes") - start[0], real = resident(d) - start[1];
    print_message("note: %s: counted %.1f MB, resident %.1f MB\n", what, count / 1e6, real / 1e6);
    assert_true(count > 0.85 * real && count < 1.15 * real);
}

static void what_is_counted_is_what_is_taken(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", PATIENT, NULL});
    client *c = client_new(d);
    const double start[2] = {counted(c, "memory_bytes"), resident(d)};
    put_grid(c, "/v1/meshes/m", 1000, 201);
    compare(c, d, start, "a million quads");
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/m/content?format=stl")));
    compare(c, d, start, "with a snapshot");
    for (int i = 0; i < 3; i++) {
        reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/edits", lift)));
    }
    compare(c, d, start, "with three revisions of each vertex");
    for (int i = 0; i < 2000; i++) {
        char body[80];
        snprintf(body, sizeof body, "{\"op\":\"face_poke\",\"face\":%d}", 100 * i);
        reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/edits", body)));
    }
    compare(c, d, start, "with 2,000 faces poked");
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/undo", NULL)));
    put_grid(c, "/v1/meshes/m", 700, 200);
    compare(c, d, start, "replaced by half as many");
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Reads one answer to /livez, which may arrive in parts. */
static void take_answer(int fd)
{
    char text[4096];
    size_t length = 0;
    do {
        ssize_t got = recv(fd, text + length, sizeof text - 1 - length, 0);
        assert_true(got > 0);
        length += (size_t)got;
        text[length] = '\0';
    } while (strstr(text, "\r\n\r\n{\"status\":\"alive\"}") == NULL);
    assert_memory_equal(text, "HTTP/1.1 200", 12);
}

/* IDLE_BYTES and IDLE_TLS_BYTES are the limits on the resident memory of an idle connection; a TLS
 * session has keys and buffers of its own. */
enum { CONNECTIONS = 1000, LOOKS = 200000, IDLE_BYTES = 10 * 1024, IDLE_TLS_BYTES = 16 * 1024 };

/* Each of many connections sends one request, for which libmicrohttpd uses its buffer, and then
 * stays idle. Another client reads the counted memory until it has fallen. The number of these
 * reads is limited, not the time. */
static void a_connection_at_rest_holds_little(void **state)
{
    (void)state;
    static const char request[] = "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n";
    static int sockets[CONNECTIONS];
    daemon_process *d =
        daemon_start((const char *const[]){"--log", "off", "--idle-timeout", "3600", NULL});
    client *c = client_new(d);
    const double start[2] = {counted(c, "memory_bytes"), resident(d)};
    for (int i = 0; i < CONNECTIONS; i++) {
        sockets[i] = client_connect(d, 0);
        assert_int_equal(send(sockets[i], request, sizeof request - 1, MSG_NOSIGNAL),
                         sizeof request - 1);
        take_answer(sockets[i]);
    }
    double used = counted(c, "memory_bytes") - start[0];
    int looks = 0;
    while (counted(c, "memory_bytes") - start[0] > CONNECTIONS * 1024 && looks < LOOKS) {
        looks++;
    }
    double count = (counted(c, "memory_bytes") - start[0]) / CONNECTIONS;
    double real = (resident(d) - start[1]) / CONNECTIONS;
    print_message("note: a connection: counted %.1f KiB after its request, %.1f KiB at rest, "
                  "resident %.1f KiB\n",
                  used / CONNECTIONS / 1024, count / 1024, real / 1024);
    assert_true(count <= 1024);
    assert_true(real <= (transport_get() == TRANSPORT_TLS ? IDLE_TLS_BYTES : IDLE_BYTES));
    for (int i = 0; i < CONNECTIONS; i++) {
        assert_int_equal(send(sockets[i], request, sizeof request - 1, MSG_NOSIGNAL),
                         sizeof request - 1);
        take_answer(sockets[i]);
        close(sockets[i]);
    }
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

#endif

/* Returns whether the daemon reports that its memory is full, both in /readyz and in /metrics. */
static bool is_full(client *c)
{
    reply r = reply_expect(200, client_get(c, "/readyz"));
    bool full = strcmp(reply_string(&r, "memory"), "full") == 0;
    reply_free(&r);
    r = reply_expect(200, client_get(c, "/metrics"));
    full = full && strstr(r.body, "\nhedge_memory_full 1\n") != NULL;
    reply_free(&r);
    return full;
}

enum { MANY = 400, SIDE = 100, SMALLER_SIDE = 66 };

/* Creates grids "<letter>0", "<letter>1", ... of side * side faces, until the budget has no space
 * for another one. Returns how many were created. */
static int fill_with_grids(client *c, char letter, int side)
{
    char path[64], body[64];
    snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", side, side);
    long status = 201;
    int made = 0;
    while (made < MANY && status == 201) {
        snprintf(path, sizeof path, "/v1/meshes/%c%d", letter, made);
        reply r = client_send(c, "PUT", path, NULL, body);
        status = r.status;
        reply_free(&r);
        made += status == 201;
    }
    assert_int_equal(status, 507);
    return made;
}

static void delete_grids(client *c, char letter, int count)
{
    char path[64];
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, "/v1/meshes/%c%d", letter, i);
        reply_done(reply_expect(204, client_send(c, "DELETE", path, NULL, NULL)));
    }
}

static void what_does_not_fit_the_budget_is_refused(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(
        (const char *const[]){"--log", "off", PATIENT, "--memory-budget", "40M", NULL});
    client *c = client_new(d);
    assert_true(counted(c, "memory_budget") == 40 << 20);
    put_grid(c, "/v1/meshes/m", SIDE, 201);
    reply before = reply_expect(200, client_get(c, "/v1/meshes/m/content"));
    int made = fill_with_grids(c, 'g', SIDE);
    assert_true(made > 2 && made < MANY);

    /* When the budget is used up, an edit that needs more memory must be refused as a whole, but
     * small requests must still be answered. */
    int edits = 0;
    long status = 200;
    while (edits < MANY && status == 200) {
        reply r = client_post(c, "/v1/meshes/m/edits", lift);
        status = r.status;
        edits += status == 200;
        reply_free(&r);
    }
    assert_int_equal(status, 507);
    assert_true(counted(c, "memory_bytes") <= counted(c, "memory_budget"));
    /* The memory that is left is too little for the edit, but may be more than a 64th of the
     * budget, below which the daemon reports that memory is full. Smaller grids use it up. The
     * daemon looks at its memory once a second. */
    int smaller = fill_with_grids(c, 's', SMALLER_SIDE);
    while (!is_full(c)) {
    }
    reply r = reply_expect(200, client_get(c, "/v1/meshes/m/vertices/77"));
    assert_int_equal((int)reply_number(&r, "position.2"), edits);
    reply_free(&r);
    r = reply_expect(200, client_get(c, "/v1/meshes/m/vertices/77/faces"));
    assert_int_equal((int)reply_number(&r, "revision"), 1 + edits);
    reply_free(&r);
    delete_grids(c, 'g', made);
    delete_grids(c, 's', smaller);

    /* After meshes were deleted there is memory again. Undo must then show that no part of a
     * refused edit was done. */
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/edits", lift)));
    for (int i = 0; i < edits + 1; i++) {
        reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/undo", NULL)));
    }
    reply after = reply_expect(200, client_get(c, "/v1/meshes/m/content"));
    assert_string_equal(before.body, after.body);
    put_grid(c, "/v1/meshes/again", SIDE, 201);
    reply_free(&before);
    reply_free(&after);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
        cmocka_unit_test(what_is_counted_is_what_is_taken),
        cmocka_unit_test(a_connection_at_rest_holds_little),
#endif
        cmocka_unit_test(what_does_not_fit_the_budget_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
