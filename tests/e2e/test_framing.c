/* Malformed requests, each sent at once, in pieces, and behind well-formed requests on one
 * connection. The well-formed requests must be answered in order, then the malformed one with its
 * problem document, and after a framing fault nothing more. */
#include "tests/e2e/client.h"
#include "tests/framing_cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmocka.h>

enum { DEEP = 100, MOST_ANSWERS = DEEP + 4, WHOLE = 1 << 30, WAIT_MILLIS = 60000 };

#define GOOD "GET /livez HTTP/1.1\r\nHost: localhost\r\n\r\n"
/* A last, well-formed request. It makes the daemon close the connection after its answer, if the
 * daemon still reads requests. */
#define LAST "GET /readyz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"

static daemon_process *server;

static int start(void **state)
{
    (void)state;
    static const char *const options[] = {"--log", "off", NULL};
    server = daemon_start(options);
    return 0;
}

static int stop(void **state)
{
    (void)state;
    return daemon_stop(server);
}

typedef struct answer {
    int status;
    const char *head, *body;
    size_t head_length, body_length;
} answer;

/* The answers that came on a connection, without the interim ones (1xx). */
typedef struct answers {
    char *bytes;
    size_t length;
    size_t count;
    answer items[MOST_ANSWERS];
    bool whole; /* the last answer is complete, and no bytes follow it */
} answers;

/* Returns the value of a header in the answer, up to the end of its line; NULL if absent. */
static const char *header_of(const answer *a, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = a->head; line < a->head + a->head_length;
         line = strstr(line, "\r\n") + 2) {
        if (strncasecmp(line, name, length) == 0 && line[length] == ':') {
            return line + length + 2;
        }
    }
    return NULL;
}

static void cut(answers *all)
{
    const char *at = all->bytes, *end = all->bytes + all->length;
    while (at < end && all->count < MOST_ANSWERS) {
        answer a = {.head = at, .status = client_raw_status(at)};
        const char *empty = strstr(at, "\r\n\r\n");
        if (a.status == 0 || empty == NULL) {
            return;
        }
        a.head_length = (size_t)(empty + 2 - at);
        a.body = empty + 4;
        const char *size = header_of(&a, "Content-Length");
        a.body_length = size == NULL ? 0 : (size_t)strtoull(size, NULL, 10);
        if (a.body_length > (size_t)(end - a.body)) {
            return;
        }
        at = a.body + a.body_length;
        if (a.status >= 200) {
            all->items[all->count++] = a;
        }
    }
    all->whole = at == end;
}

/* Sends the bytes in pieces of `piece` bytes, and reads meanwhile and afterwards until the server
 * closes the connection. */
static answers exchange(const char *bytes, size_t length, size_t piece)
{
    int fd = client_connect(server, 0), on = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    answers all = {.bytes = malloc(1)};
    size_t sent = 0;
    for (bool open = true; open;) {
        struct pollfd wait = {.fd = fd, .events = (short)(POLLIN | (sent < length ? POLLOUT : 0))};
        if (poll(&wait, 1, WAIT_MILLIS) <= 0) {
            fail_msg("neither an answer nor a close");
        }
        if ((wait.revents & POLLOUT) != 0) {
            size_t now = length - sent < piece ? length - sent : piece;
            ssize_t n = send(fd, bytes + sent, now, MSG_NOSIGNAL | MSG_DONTWAIT);
            /* if the daemon refuses further bytes, its answer is still read */
            sent = n > 0 ? sent + (size_t)n : length;
        }
        if ((wait.revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
            char buffer[16384];
            ssize_t n = recv(fd, buffer, sizeof buffer, MSG_DONTWAIT);
            open = n > 0;
            all.bytes = realloc(all.bytes, all.length + (n > 0 ? (size_t)n : 0) + 1);
            assert_non_null(all.bytes);
            memcpy(all.bytes + all.length, buffer, n > 0 ? (size_t)n : 0);
            all.length += n > 0 ? (size_t)n : 0;
        }
    }
    close(fd);
    all.bytes[all.length] = '\0';
    cut(&all);
    return all;
}

static bool begins(const char *text, const char *prefix)
{
    return text != NULL && strncmp(text, prefix, strlen(prefix)) == 0;
}

static bool is_problem(const answer *a, const char *code)
{
    char member[80], text[4096];
    (void)snprintf(member, sizeof member, "\"code\":\"%s\"", code);
    (void)snprintf(text, sizeof text, "%.*s", (int)a->body_length, a->body);
    return begins(header_of(a, "Content-Type"), "application/problem+json\r\n") &&
           begins(header_of(a, "X-Content-Type-Options"), "nosniff\r\n") &&
           strstr(text, member) != NULL;
}

/* Returns what is wrong with the answers to `good` well-formed requests, the malformed request and
 * the last request; NULL if nothing is wrong. */
static const char *find_wrong(const framing_case *c, const answers *all, size_t good)
{
    if (!all->whole) {
        return "bytes that are no answer";
    }
    if (all->count != good + (c->closes ? 1 : 2)) {
        return "another number of answers";
    }
    for (size_t i = 0; i < good; i++) {
        if (all->items[i].status != 200) {
            return "a good request before it was refused";
        }
    }
    const answer *a = &all->items[good];
    if (a->status != c->status) {
        return "another status";
    }
    if (c->code != NULL && !is_problem(a, c->code)) {
        return "another problem";
    }
    if (c->closes && !begins(header_of(a, "Connection"), "close\r\n")) {
        return "no Connection: close";
    }
    return !c->closes && all->items[good + 1].status != 200 ? "the request after it was refused"
                                                            : NULL;
}

static size_t try_cases(size_t good, size_t piece)
{
    size_t wrong = 0;
    for (size_t i = 0; i < framing_case_count(); i++) {
        const framing_case *c = framing_case_at(i);
        size_t size, before = good * (sizeof GOOD - 1);
        char *bytes = framing_case_bytes(c, &size);
        char *all = malloc(before + size + sizeof LAST);
        assert_non_null(all);
        for (size_t k = 0; k < good; k++) {
            memcpy(all + k * (sizeof GOOD - 1), GOOD, sizeof GOOD - 1);
        }
        memcpy(all + before, bytes, size);
        memcpy(all + before + size, LAST, sizeof LAST - 1);
        /* Long cases are sent in larger pieces than single bytes, to save time. */
        size_t step = piece < 512 && size > 4096 ? 509 : piece;
        answers got = exchange(all, before + size + sizeof LAST - 1, step);
        const char *what = find_wrong(c, &got, good);
        if (what != NULL) {
            const answer *a = got.count > good ? &got.items[good] : NULL;
            print_error("%s, behind %zu, in pieces of %zu: %s (%zu answers, status %d)\n%.300s\n",
                        c->name, good, step, what, got.count, a == NULL ? 0 : a->status,
                        a == NULL ? got.bytes : a->head);
            wrong++;
        }
        free(got.bytes);
        free(all);
        free(bytes);
    }
    return wrong;
}

static void each_case_has_its_answer(void **state)
{
    (void)state;
    print_message("note: %zu framing cases\n", framing_case_count());
    assert_int_equal(try_cases(0, WHOLE), 0);
}

static void each_case_byte_by_byte_has_its_answer(void **state)
{
    (void)state;
    assert_int_equal(try_cases(0, 1), 0);
}

static void each_case_behind_a_good_request_has_its_answer(void **state)
{
    (void)state;
    assert_int_equal(try_cases(1, WHOLE), 0);
    assert_int_equal(try_cases(1, 7), 0);
}

static void each_case_behind_a_hundred_requests_has_its_answer(void **state)
{
    (void)state;
    assert_int_equal(try_cases(DEEP, WHOLE), 0);
}

/* The head of a request has the maximum length in every respect. The buffer of libmicrohttpd must
 * still have space for the answer. */
static void the_largest_head_is_answered(void **state)
{
    (void)state;
    static const char head[] = " HTTP/1.1\r\nHost: localhost\r\nOrigin: http://a.example\r\n";
    enum { ROOM = 64 * 1024 };
    char *bytes = malloc(ROOM);
    assert_non_null(bytes);
    for (size_t fields = 0; fields <= 98; fields += 14) {
        /* The target has its maximum length. Headers are added until their number or their length
         * exceeds its limit. */
        for (size_t size = 6000; size <= 20000; size += 250) {
            size_t at = (size_t)snprintf(bytes, ROOM, "GET /");
            memset(bytes + at, 'a', 8191);
            at += 8191;
            memcpy(bytes + at, head, sizeof head - 1);
            at += sizeof head - 1;
            for (size_t i = 0; i < fields; i++) {
                at += (size_t)snprintf(bytes + at, ROOM - at, "X%02zu: a\r\n", i);
            }
            at += (size_t)snprintf(bytes + at, ROOM - at, "Y: ");
            memset(bytes + at, 'b', size - 9 * fields);
            at += size - 9 * fields;
            at += (size_t)snprintf(bytes + at, ROOM - at, "\r\n\r\n" LAST);
            answers got = exchange(bytes, at, WHOLE);
            int status = got.count == 0 ? 0 : got.items[0].status;
            if (!got.whole || (status != 404 && status != 431)) {
                fail_msg("%zu headers, %zu bytes: status %d", fields, size, status);
            }
            free(got.bytes);
        }
    }
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_case_has_its_answer),
        cmocka_unit_test(each_case_byte_by_byte_has_its_answer),
        cmocka_unit_test(each_case_behind_a_good_request_has_its_answer),
        cmocka_unit_test(each_case_behind_a_hundred_requests_has_its_answer),
        cmocka_unit_test(the_largest_head_is_answered),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
