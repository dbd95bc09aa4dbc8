/* Content codings of a real daemon: decompression bombs, which must take little memory, answers
 * that are compressed while they are sent, and clients that disconnect in the middle. */
#include "tests/e2e/client.h"

#include "tests/codings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

#define ARGUMENTS(...) ((const char *const[]){__VA_ARGS__, NULL})

static const char *const both[] = {"gzip", "zstd"};

static reply expect(long status, reply r)
{
    if (r.status != status) {
        fail_msg("status %ld instead of %ld: %.300s", r.status, status, r.body);
    }
    return r;
}

static void done(reply r)
{
    reply_free(&r);
}

static void put_grid(client *c, const char *path, int side)
{
    char body[128];
    snprintf(body, sizeof body, "{\"shape\":\"grid\",\"columns\":%d,\"rows\":%d}", side, side);
    done(expect(201, client_send(c, "PUT", path, NULL, body)));
}

/* A compressed body, and the media type of its decompressed form. */
typedef struct coded_body {
    const char *coding, *type;
    const char *bytes;
    size_t length;
} coded_body;

static reply send_coded(client *c, const char *method, const char *path, const coded_body *body)
{
    char encoding[60], content[60];
    snprintf(encoding, sizeof encoding, "Content-Encoding: %s", body->coding);
    snprintf(content, sizeof content, "Content-Type: %s", body->type);
    return client_send_bytes(c, &(client_request){method, path, ARGUMENTS(encoding, content),
                                                  body->bytes, body->length});
}

static void unfold(reply *r, const char *coding)
{
    char value[40];
    size_t length;
    assert_string_equal(reply_header(r, "Content-Encoding", value, sizeof value), coding);
    char *plain = coding_unpack(coding, r->body, r->length, &length);
    assert_non_null(plain);
    free(r->body);
    r->body = plain;
    r->length = length;
}

/* Sends a whole request without reading meanwhile, and requires an answer with the status `status`
 * even if the daemon closes the connection before it has read the whole body. */
static void refused(daemon_process *d, const char *target, const coded_body *body, int status)
{
    char *request = malloc(body->length + 400);
    assert_non_null(request);
    int head = snprintf(request, 400,
                        "%s HTTP/1.1\r\nHost: localhost\r\nContent-Type: %s\r\n"
                        "Content-Encoding: %s\r\nContent-Length: %zu\r\n\r\n",
                        target, body->type, body->coding, body->length);
    memcpy(request + head, body->bytes, body->length);
    char *answer = client_raw(d, request, (size_t)head + body->length, 1, false);
    if (client_raw_status(answer) != status) {
        fail_msg("%s in %s: %.500s", target, body->coding, answer);
    }
    free(answer);
    free(request);
}

/* Requires that the peak memory of the daemon rose by at most `most` bytes since `before`. A
 * sanitizer adds memory of its own, so nothing is compared in a build with a sanitizer. */
static void expect_rise(const daemon_process *d, size_t before, size_t most, const char *what)
{
    size_t rise = daemon_peak(d) - before;
#if !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
    print_message("note: %s: %.1f MB more at most\n", what, (double)rise / 1e6);
    assert_true(rise <= most);
#else
    (void)rise;
    (void)most;
    (void)what;
#endif
}

/* Returns a bomb that decompresses to 10 GiB: 10 MiB of gzip, or less of zstd. It consists of gzip
 * members or zstd frames of 10 MiB each. */
static char *bomb_of(const char *coding, char fill, size_t *length)
{
    enum { PART = 10 << 20, PARTS = 1024 };
    size_t one;
    char *part = malloc(PART);
    assert_non_null(part);
    memset(part, fill, PART);
    char *packed = coding_pack(coding, part, PART, &one);
    free(part);
    char *bomb = malloc(PARTS * one);
    assert_non_null(bomb);
    for (size_t i = 0; i < PARTS; i++) {
        memcpy(bomb + i * one, packed, one);
    }
    free(packed);
    *length = PARTS * one;
    return bomb;
}

static void bombs_stay_small(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    client *c = client_new(d);
    put_grid(c, "/v1/meshes/m", 10);
    for (size_t i = 0; i < 2; i++) {
        size_t length, before = daemon_peak(d);
        char *zeros = bomb_of(both[i], '\0', &length);
        refused(d, "POST /v1/meshes", &(coded_body){both[i], "model/obj", zeros, length},
                422); /* 422, because an OBJ file has no NUL bytes */
        refused(d, "POST /v1/meshes", &(coded_body){both[i], "application/json", zeros, length},
                400);
        refused(d, "POST /v1/meshes/m/edits",
                &(coded_body){both[i], "application/json", zeros, length}, 413);
        free(zeros);
        char *blanks = bomb_of(both[i], ' ', &length);
        refused(d, "PUT /v1/meshes/b", &(coded_body){both[i], "application/json", blanks, length},
                413);
        refused(d, "PUT /v1/meshes/b", &(coded_body){both[i], "model/obj", blanks, length}, 413);
        refused(d, "PUT /v1/meshes/b", &(coded_body){both[i], "model/x-off", blanks, length}, 413);
        /* A bomb that is compressed twice is decompressed only once, and the result is refused
         * because it is no mesh. */
        size_t folded;
        char *nested = coding_pack(both[1 - i], blanks, length, &folded);
        reply r = send_coded(c, "PUT", "/v1/meshes/b",
                             &(coded_body){both[1 - i], "model/obj", nested, folded});
        assert_true(r.status == 400 || r.status == 413);
        reply_free(&r);
        free(nested);
        free(blanks);
        expect_rise(d, before, 24 << 20, both[i]);
    }
    done(expect(404, client_get(c, "/v1/meshes/b")));
    done(expect(200, client_get(c, "/v1/meshes/m")));
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* A compressed body must also be read if every byte comes in a chunk of its own. */
static void pieces_may_be_of_one_byte(void **state)
{
    (void)state;
    static const char body[] = "{\"shape\":\"cube\",\"size\":3}";
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    for (size_t i = 0; i < 2; i++) {
        size_t length, at;
        char *packed = coding_pack(both[i], body, sizeof body - 1, &length), request[4096];
        at = (size_t)snprintf(request, sizeof request,
                              "POST /v1/meshes HTTP/1.1\r\nHost: localhost\r\n"
                              "Content-Type: application/json\r\nContent-Encoding: %s\r\n"
                              "Transfer-Encoding: chunked\r\n\r\n",
                              both[i]);
        for (size_t k = 0; k < length; k++) {
            memcpy(request + at, "1\r\n?\r\n", 6);
            request[at + 3] = packed[k];
            at += 6;
        }
        memcpy(request + at, "0\r\n\r\n", 5);
        char *answer = client_raw(d, request, at + 5, 1, false);
        assert_int_equal(client_raw_status(answer), 201);
        assert_non_null(strstr(answer, "\"vertices\":8,"));
        free(answer);
        free(packed);
    }
    assert_int_equal(daemon_stop(d), 0);
}

static const char *const targets[] = {
    "/v1/meshes/m/content?format=obj",
    "/v1/meshes/m/content?format=ply",
    "/v1/meshes/m/geometry",
    "/v1/meshes/m/vertices?limit=10000",
};

enum { TARGETS = sizeof targets / sizeof *targets, SIDE = 400 };

/* The body compresses so well that the bytes which arrive at once keep the only worker busy for
 * longer than it may work on one request at a time. All of it must be read, and requests of other
 * clients must be answered in between. */
static void dense_bodies_take_turns_with_others(void **state)
{
    (void)state;
    enum { LINES = 16000, LINE = 1200 };
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--workers", "1"));
    client *c = client_new(d);
    char *text = malloc((size_t)LINES * LINE), *at = text;
    assert_non_null(text);
    uint64_t random = 1;
    for (int i = 0; i < LINES; i++) {
        random = random * UINT64_C(6364136223846793005) + 1442695040888963407u;
        char *end = at + LINE;
        at += snprintf(at, LINE, "v %d %.15g 0\n#%d", i, (double)(random >> 11) * 0x1p-53,
                       (int)(random >> 40));
        memset(at, '-', (size_t)(end - at - 1));
        end[-1] = '\n';
        at = end;
    }
    for (size_t k = 0; k < 2; k++) {
        size_t packed;
        char *body = coding_pack(both[k], text, (size_t)LINES * LINE, &packed);
        printf("note: %s: one to %.0f\n", both[k], (double)LINES * LINE / (double)packed);
        char head[256];
        int length = snprintf(head, sizeof head,
                              "POST /v1/meshes HTTP/1.1\r\nHost: localhost\r\nContent-Length: %zu"
                              "\r\nContent-Type: model/obj\r\nContent-Encoding: %s\r\n"
                              "Connection: close\r\n\r\n",
                              packed, both[k]);
        char *request = malloc((size_t)length + packed);
        assert_non_null(request);
        memcpy(request, head, (size_t)length);
        memcpy(request + length, body, packed);
        int uploads = client_connect(d, 0);
        size_t sent = 0, all = (size_t)length + packed;
        while (sent < all) {
            ssize_t n = send(uploads, request + sent, all - sent, MSG_NOSIGNAL);
            assert_true(n > 0);
            sent += (size_t)n;
            done(expect(200, client_get(c, "/livez")));
        }
        char answer[4096] = "";
        size_t got = 0;
        for (ssize_t n; (n = recv(uploads, answer + got, sizeof answer - 1 - got, 0)) > 0;) {
            got += (size_t)n;
        }
        close(uploads);
        assert_int_equal(client_raw_status(answer), 201);
        assert_non_null(strstr(answer, "\"import\":{\"format\":\"obj\",\"vertices\":16000,"));
        free(request);
        free(body);
    }
    free(text);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void large_answers_are_coded_as_they_are_sent(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    client *c = client_new(d);
    char value[40];
    put_grid(c, "/v1/meshes/m", SIDE);
    for (size_t i = 0; i < TARGETS; i++) {
        reply plain = expect(200, client_get(c, targets[i]));
        size_t before = daemon_peak(d);
        for (size_t k = 0; k < 2; k++) {
            char accept[60];
            snprintf(accept, sizeof accept, "Accept-Encoding: %s", both[k]);
            reply r = expect(200, client_send(c, "GET", targets[i], ARGUMENTS(accept), NULL));
            assert_true(r.length < plain.length);
            assert_string_equal(reply_header(&r, "Content-Length", value, sizeof value), "");
            unfold(&r, both[k]);
            assert_int_equal(r.length, plain.length);
            assert_memory_equal(r.body, plain.body, r.length);
            reply_free(&r);
        }
        expect_rise(d, before, 6 << 20, targets[i]);
        reply_free(&plain);
    }
    /* A short answer is compressed before it is sent, so it has a Content-Length, and the answer to
     * HEAD has the same one. */
    const char *const zstd[] = {"Accept-Encoding: gzip;q=0.5, zstd", NULL};
    char length[40];
    reply r = expect(200, client_send(c, "GET", "/v1/meshes/m/faces?limit=50", zstd, NULL));
    snprintf(length, sizeof length, "%zu", r.length);
    assert_string_equal(reply_header(&r, "Content-Length", value, sizeof value), length);
    unfold(&r, "zstd");
    reply_free(&r);
    r = expect(200, client_send(c, "HEAD", "/v1/meshes/m/faces?limit=50", zstd, NULL));
    assert_string_equal(reply_header(&r, "Content-Length", value, sizeof value), length);
    reply_free(&r);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* Some clients read the beginning of a long compressed answer slowly and then disconnect. Other
 * clients send requests all the time, which must be answered. */
static void clients_go_away_while_it_is_coded(void **state)
{
    (void)state;
    enum { CLIENTS = 8, ROUNDS = 6 };
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    client *c = client_new(d);
    put_grid(c, "/v1/meshes/m", SIDE);
    for (int round = 0; round < ROUNDS; round++) {
        int fds[CLIENTS];
        for (int i = 0; i < CLIENTS; i++) {
            char request[200], byte;
            fds[i] = client_connect(d, 4096);
            int length = snprintf(request, sizeof request,
                                  "GET %s HTTP/1.1\r\nHost: localhost\r\n"
                                  "Accept-Encoding: %s\r\n\r\n",
                                  targets[i % TARGETS], both[round % 2]);
            assert_int_equal(send(fds[i], request, (size_t)length, MSG_NOSIGNAL), length);
            for (int k = 0; k < i * 100; k++) {
                assert_int_equal(recv(fds[i], &byte, 1, 0), 1);
            }
        }
        done(expect(200, client_get(c, "/v1/meshes/m/vertices/0")));
        for (int i = 0; i < CLIENTS; i++) {
            close(fds[i]);
        }
    }
    /* This client is still connected when the daemon is told to stop. */
    int left = client_connect(d, 4096);
    static const char request[] = "GET /v1/meshes/m/content?format=obj HTTP/1.1\r\n"
                                  "Host: localhost\r\nAccept-Encoding: gzip\r\n\r\n";
    char byte;
    assert_int_equal(send(left, request, sizeof request - 1, MSG_NOSIGNAL), sizeof request - 1);
    assert_int_equal(recv(left, &byte, 1, 0), 1);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
    close(left);
}

static double counted(client *c)
{
    reply r = expect(200, client_get(c, "/v1/meshes"));
    double value = reply_number(&r, "memory_bytes");
    reply_free(&r);
    return value;
}

/* The client sends half of a body and disconnects: the memory for what was read must be released,
 * both for a plain body and for a compressed one. */
static void an_upload_that_breaks_off_leaves_nothing(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off"));
    client *c = client_new(d);
    put_grid(c, "/v1/meshes/m", SIDE);
    reply file = expect(200, client_get(c, targets[0]));
    done(expect(204, client_send(c, "DELETE", "/v1/meshes/m", NULL, NULL)));
    double before = counted(c);
    static const char *const codings[] = {"identity", "gzip", "zstd"};
    for (size_t i = 0; i < 3; i++) {
        char head[300];
        size_t length = file.length, sent = 0;
        char *body = i == 0 ? NULL : coding_pack(codings[i], file.body, file.length, &length);
        const char *bytes = body == NULL ? file.body : body;
        int fd = client_connect(d, 0);
        int size = snprintf(head, sizeof head,
                            "PUT /v1/meshes/u HTTP/1.1\r\nHost: localhost\r\n"
                            "Content-Type: model/obj\r\nContent-Encoding: %s\r\n"
                            "Content-Length: %zu\r\n\r\n",
                            codings[i], length);
        assert_int_equal(send(fd, head, (size_t)size, MSG_NOSIGNAL), size);
        while (sent < length / 2) {
            ssize_t n = send(fd, bytes + sent, length / 2 - sent, MSG_NOSIGNAL);
            assert_true(n > 0);
            sent += (size_t)n;
        }
        while (counted(c) < before + 1e6) { /* waits until the daemon has read some of the body */
        }
        close(fd);
        /* waits until the daemon has noticed the disconnection */
        while (counted(c) > before + 1e5) {
        }
        free(body);
    }
    done(expect(404, client_get(c, "/v1/meshes/u")));
    reply_free(&file);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

/* The jobs of compressed uploads wait behind a job that runs until it is cancelled, so that the
 * test sees each of their states. */
static void jobs_of_coded_uploads_end_and_are_cancelled(void **state)
{
    (void)state;
    static const char lasting[] =
        "{\"shape\":\"torus\",\"major_segments\":4000,\"minor_segments\":4000}";
    static const char *const ids[] = {"/v1/meshes/made", "/v1/meshes/never"};
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--jobs", "1"));
    client *c = client_new(d);
    put_grid(c, "/v1/meshes/m", 60);
    reply file = expect(200, client_get(c, targets[1]));
    for (size_t i = 0; i < 2; i++) {
        size_t length;
        char *packed = coding_pack(both[i], file.body, file.length, &length), encoding[60];
        char first[80], jobs[2][80], events[100];
        snprintf(encoding, sizeof encoding, "Content-Encoding: %s", both[i]);
        reply r = expect(
            202, client_send(c, "PUT", "/v1/meshes/before",
                             ARGUMENTS("Prefer: respond-async", "Content-Type: application/json"),
                             lasting));
        reply_header(&r, "Location", first, sizeof first);
        reply_free(&r);
        client_await_running(c, first);
        for (int k = 0; k < 2; k++) {
            r = expect(202, client_send_bytes(
                                c, &(client_request){"PUT", ids[k],
                                                     ARGUMENTS("Prefer: respond-async",
                                                               "Content-Type: model/ply", encoding),
                                                     packed, length}));
            reply_header(&r, "Location", jobs[k], sizeof jobs[k]);
            reply_free(&r);
        }
        done(expect(202, client_send(c, "DELETE", jobs[1], NULL, NULL)));
        done(expect(202, client_send(c, "DELETE", first, NULL, NULL)));
        snprintf(events, sizeof events, "%s/events", jobs[0]);
        r = expect(200, client_get(c, events));
        assert_non_null(strstr(r.body, "\"progress\":1,"));
        reply_free(&r);
        r = expect(200, client_get(c, jobs[0]));
        assert_string_equal(reply_string(&r, "state"), "done");
        assert_int_equal((int)reply_number(&r, "result.counts.faces"), 3600);
        reply_free(&r);
        r = expect(200, client_get(c, jobs[1]));
        assert_string_equal(reply_string(&r, "state"), "cancelled");
        reply_free(&r);
        done(expect(404, client_get(c, "/v1/meshes/never")));
        done(expect(204, client_send(c, "DELETE", ids[0], NULL, NULL)));
        free(packed);
    }
    reply_free(&file);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

static void it_can_be_switched_off(void **state)
{
    (void)state;
    daemon_process *d = daemon_start(ARGUMENTS("--log", "off", "--no-compression"));
    client *c = client_new(d);
    char value[40];
    put_grid(c, "/v1/meshes/m", 30);
    reply r = expect(
        200, client_send(c, "GET", targets[0], ARGUMENTS("Accept-Encoding: gzip, zstd"), NULL));
    assert_string_equal(reply_header(&r, "Content-Encoding", value, sizeof value), "");
    reply_free(&r);
    /* A short body whose coding is x-gzip, the old name of gzip, must be read, too. */
    static const char body[] = "{\"shape\":\"cube\"}";
    size_t length;
    char *packed = coding_pack("gzip", body, sizeof body - 1, &length);
    done(expect(201, send_coded(c, "POST", "/v1/meshes",
                                &(coded_body){"x-gzip", "application/json", packed, length})));
    free(packed);
    client_free(c);
    assert_int_equal(daemon_stop(d), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bombs_stay_small),
        cmocka_unit_test(pieces_may_be_of_one_byte),
        cmocka_unit_test(dense_bodies_take_turns_with_others),
        cmocka_unit_test(large_answers_are_coded_as_they_are_sent),
        cmocka_unit_test(clients_go_away_while_it_is_coded),
        cmocka_unit_test(an_upload_that_breaks_off_leaves_nothing),
        cmocka_unit_test(jobs_of_coded_uploads_end_and_are_cancelled),
        cmocka_unit_test(it_can_be_switched_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
