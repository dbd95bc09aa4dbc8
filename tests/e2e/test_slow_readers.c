/* Clients that read a large mesh slowly must not delay other clients that edit or read the same
 * mesh. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"
#include "tests/sanitized.h"

#include "server/http/limits.h"

#include <errno.h>
#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

/* The mesh has SIDE x SIDE quads: a million, and fewer under a sanitizer, which is slow. */
enum { SIDE = SANITIZED ? 500 : 1000 };

enum { SLOW = 4, RECEIVE_BUFFER = 1 << 16, FIRST = 1024, EDITS = 20 };

typedef struct slow_client {
    int fd;
    char first[FIRST];
} slow_client;

/* Sends a request and reads only the first KiB of the answer. */
static void begin_slowly(slow_client *s, const daemon_process *d, const char *path)
{
    char request[256];
    int length = snprintf(request, sizeof request,
                          "GET %s HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n", path);
    s->fd = client_connect(d, RECEIVE_BUFFER);
    assert_int_equal(send(s->fd, request, (size_t)length, MSG_NOSIGNAL), length);
    assert_int_equal(recv(s->fd, s->first, FIRST, MSG_WAITALL), FIRST);
    assert_memory_equal(s->first, "HTTP/1.1 200", 12);
}

/* A buffer from which single bytes of a socket are read. */
typedef struct incoming {
    int fd;
    /* `at` is the number of bytes taken from the buffer, `got` the number received into it */
    size_t at, got;
    char bytes[1 << 16];
} incoming;

/* Reads a byte; returns false at the end of the stream. */
static bool next_byte(incoming *in, char *out)
{
    if (in->at == in->got) {
        ssize_t n = recv(in->fd, in->bytes, sizeof in->bytes, 0);
        assert_true(n >= 0);
        in->at = 0;
        in->got = (size_t)n;
    }
    if (in->got == 0) {
        return false;
    }
    *out = in->bytes[in->at++];
    return true;
}

/* Reads the rest of a chunked answer, which must equal `whole`. */
static void end_quickly(slow_client *s, const char *whole, size_t length)
{
    char line[64], c;
    incoming *in = malloc(sizeof *in);
    assert_non_null(in);
    char *body = strstr(s->first, "\r\n\r\n");
    assert_non_null(body);
    assert_non_null(strstr(s->first, "chunked"));
    size_t read = 0;
    *in = (incoming){.fd = s->fd, .got = (size_t)(s->first + FIRST - (body + 4))};
    memcpy(in->bytes, body + 4, in->got);
    for (;;) {
        size_t used = 0;
        while (next_byte(in, &c) && c != '\n' && used < 60) {
            line[used++] = c;
        }
        line[used] = '\0';
        size_t chunk = (size_t)strtoull(line, NULL, 16);
        if (chunk == 0) {
            break;
        }
        for (size_t i = 0; i < chunk; i++) {
            assert_true(next_byte(in, &c));
            assert_true(read < length && whole[read] == c);
            read++;
        }
        assert_true(next_byte(in, &c) && c == '\r');
        assert_true(next_byte(in, &c) && c == '\n');
    }
    assert_int_equal(read, length);
    close(s->fd);
    free(in);
}

/* There are more slow clients than workers. They read nothing between begin_slowly and end_quickly;
 * if they delayed the requests that are sent meanwhile, the test would never end. */
static void slow_downloads_delay_nobody(void **state)
{
    (void)state;
    daemon_process *d = daemon_start((const char *const[]){
        "--log", "off", "--workers", "2", "--body-grace", "3600", "--idle-timeout", "3600", NULL});
    client *c = client_new(d);
    char body[128];
    snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", SIDE, SIDE);
    reply_done(reply_expect(201, client_send(c, "PUT", "/v1/meshes/m", NULL, body)));
    reply before = reply_expect(200, client_get(c, "/v1/meshes/m/content?format=off"));

    static slow_client slow[SLOW];
    for (int i = 0; i < SLOW; i++) {
        begin_slowly(&slow[i], d, "/v1/meshes/m/content?format=off");
    }
    for (int i = 0; i < EDITS; i++) {
        snprintf(body, sizeof body, "{\"op\":\"vertex_move\",\"vertex\":%d,\"by\":[0,0,1]}", i);
        reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/edits", body)));
        snprintf(body, sizeof body, "/v1/meshes/m/vertices/%d", i);
        reply r = reply_expect(200, client_get(c, body));
        assert_true(reply_number(&r, "position.2") == 1);
        reply_free(&r);
        reply_done(reply_expect(200, client_get(c, "/v1/meshes/m/faces/0/edges")));
    }
    reply_done(reply_expect(200, client_post(c, "/v1/meshes/m/undo", NULL)));
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/m")));
    reply after = reply_expect(200, client_get(c, "/v1/meshes/m/content?format=off"));
    assert_true(after.length != before.length ||
                memcmp(after.body, before.body, after.length) != 0);
    reply_done(reply_expect(204, client_send(c, "DELETE", "/v1/meshes/m", NULL, NULL)));

    /* Each slow client must get the mesh as it was when the client sent its request. */
    for (int i = 0; i < SLOW; i++) {
        end_quickly(&slow[i], before.body, before.length);
    }
    reply_free(&after);
    reply_free(&before);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* --- clients that do not read at all --- */

/* The memory of closed connections that the daemon may keep, since it keeps some buffers for the
 * next connections. */
enum { KEPT_BYTES = 8 << 20 };

enum {
    IDLERS = 100,
    PATIENCE_MILLIS = 60 * 1000,
    LOOKS = 200000,
    SMALL_SIDE = 30,
    LARGE_SIDE = 300
};

static void put_grid(client *c, int side)
{
    char body[128];
    snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", side, side);
    reply_done(reply_expect(201, client_send(c, "PUT", "/v1/meshes/m", NULL, body)));
}

static void ask_and_wait(const daemon_process *d, int sockets[IDLERS])
{
    static const char request[] =
        "GET /v1/meshes/m/content?format=obj HTTP/1.1\r\nHost: localhost\r\n\r\n";
    for (int i = 0; i < IDLERS; i++) {
        sockets[i] = client_connect(d, 1);
        assert_int_equal(send(sockets[i], request, sizeof request - 1, MSG_NOSIGNAL),
                         sizeof request - 1);
    }
}

/* Requires that every connection is closed. The daemon resets the connection of a client that reads
 * too little, so the client sees an error. */
static void expect_all_closed(int sockets[IDLERS])
{
    for (int i = 0; i < IDLERS; i++) {
        struct pollfd wait = {.fd = sockets[i], .events = 0};
        assert_int_equal(poll(&wait, 1, PATIENCE_MILLIS), 1);
        assert_true((wait.revents & (POLLERR | POLLHUP)) != 0);
        close(sockets[i]);
    }
}

/* Options of a daemon that lets connections be idle for an hour, so that only its rule about the
 * minimum rate of reading can close the connections of this test. */
static const char *const impatient[] = {
    "--log", "off", "--body-grace", "1", "--min-rate", "4K", "--idle-timeout", "3600", NULL};

static void a_reader_who_stops_is_closed_though_all_of_the_answer_was_sent(void **state)
{
    (void)state;
    int sockets[IDLERS];
    daemon_process *d = daemon_start(impatient);
    client *c = client_new(d);
    put_grid(c, SMALL_SIDE);
    ask_and_wait(d, sockets);
    expect_all_closed(sockets);
    reply_done(reply_expect(200, client_get(c, "/livez")));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Returns the number of bytes that wait in the daemon's sockets for clients to read them. Memory
 * that the kernel uses to manage these bytes does not count. */
static size_t waiting_bytes(const daemon_process *d)
{
    char line[512];
    size_t all = 0;
    FILE *file = fopen("/proc/net/tcp", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) != NULL) {
        unsigned port = 0, sent = 0;
        if (sscanf(line, " %*u: %*8x:%4x %*8x:%*4x %*2x %8x:", &port, &sent) == 2 &&
            (int)port == daemon_port(d)) {
            all += sent;
        }
    }
    fclose(file);
    return all;
}

static double counted(client *c)
{
    reply r = reply_expect(200, client_get(c, "/v1/meshes"));
    double bytes = reply_number(&r, "memory_bytes");
    reply_free(&r);
    return bytes;
}

/* Instead of sleeping, the test waits by requesting the metrics again and again, so that the wait
 * is bounded by a number of requests and not by time. */
static void what_readers_leave_in_sockets_is_little_and_counted(void **state)
{
    (void)state;
    transport_skip_over(TRANSPORT_UNIX, "/proc tells no bytes of Unix sockets");
    int sockets[IDLERS];
    daemon_process *d = daemon_start((const char *const[]){"--log", "off", "--body-grace", "3600",
                                                           "--idle-timeout", "3600", NULL});
    client *c = client_new(d);
    put_grid(c, LARGE_SIDE);
    reply_done(reply_expect(200, client_get(c, "/v1/meshes/m/content?format=obj")));
    double before = counted(c);
    ask_and_wait(d, sockets);
    int looks = 0;
    while (waiting_bytes(d) < IDLERS * SRV_FIRST_SEND_BUFFER / 2 && looks < LOOKS) {
        looks++;
        (void)counted(c);
    }
    size_t waiting = waiting_bytes(d);
    assert_true(waiting >= IDLERS * SRV_FIRST_SEND_BUFFER / 2);
    while (counted(c) < before + (double)waiting && looks < 2 * LOOKS) {
        looks++;
    }
    print_message("note: %d clients who read nothing: %.1f MB in sockets, counted %.1f MB more\n",
                  IDLERS, (double)waiting / 1e6, (counted(c) - before) / 1e6);
    assert_true(counted(c) >= before + (double)waiting);
    /* The daemon enlarges the send buffer only of clients that read well. The clients of this test
     * read nothing, so their buffers must be small. */
    assert_true(waiting_bytes(d) <= (size_t)IDLERS * SRV_SEND_BUFFER / 2);
    for (int i = 0; i < IDLERS; i++) {
        close(sockets[i]);
    }
    while (counted(c) > before + KEPT_BYTES && looks < 3 * LOOKS) {
        looks++;
    }
    assert_true(counted(c) <= before + KEPT_BYTES);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slow_downloads_delay_nobody),
        cmocka_unit_test(a_reader_who_stops_is_closed_though_all_of_the_answer_was_sent),
        cmocka_unit_test(what_readers_leave_in_sockets_is_little_and_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
