/* Tests of the state machine that checks the bytes of a connection before libmicrohttpd reads them.
 * The state machine must find the fault in each case of framing_cases.h, however the bytes are
 * split and however little free space the buffer has. It must pass on no byte after a fault. */
#include "tests/unit/fixture.h"

#include "framing_cases.h"
#include "server/http/http_recv.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

enum { ROOM = 2 << 20 };

typedef struct passed {
    srv_syntax syntax;
    char *bytes;
    size_t length;
    size_t taken; /* number of bytes of the input that were checked */
} passed;

/* Passes `bytes` to the check, in a buffer that has `room` bytes of free space after them, as the
 * server does after recv(). Returns false if the check finds a fault. */
static bool hand_over(passed *p, const char *bytes, size_t length, size_t room)
{
    char *at = p->bytes + p->length;
    memcpy(at, bytes, length);
    p->taken += length;
    p->length += srv_syntax_check(&p->syntax, at, length, length + room);
    if (!srv_syntax_is_faulty(&p->syntax)) {
        return true;
    }
    size_t more;
    do {
        more = srv_syntax_end(&p->syntax, p->bytes + p->length, 1);
        p->length += more;
    } while (more > 0);
    return false;
}

/* How the bytes of a connection arrive: in pieces of `piece` bytes each, but with `first` bytes in
 * the first piece if `first` is not 0. The buffer has `room` bytes of free space after each
 * piece. */
typedef struct arrival {
    size_t first, piece, room;
} arrival;

/* Passes all bytes to the check, piece by piece. */
static void feed(passed *p, const char *bytes, size_t length, arrival by)
{
    p->syntax = (srv_syntax){0};
    p->length = 0;
    p->taken = 0;
    for (size_t at = 0; at < length;) {
        size_t size = at == 0 && by.first > 0 ? by.first : by.piece;
        size = size < length - at ? size : length - at;
        if (!hand_over(p, bytes + at, size, by.room)) {
            break;
        }
        at += size;
    }
}

static int code_of(const passed *p)
{
    api_problem problem = {0};
    bool is_it = srv_syntax_fault(&p->syntax, p->syntax.requests, &problem);
    assert_int_equal(is_it, srv_syntax_is_faulty(&p->syntax));
    return problem.code;
}

static void expect_equal(const framing_case *c, const passed *a, const passed *b, size_t cut)
{
    if (a->length != b->length || memcmp(a->bytes, b->bytes, a->length) != 0 ||
        a->syntax.fault != b->syntax.fault || a->syntax.requests != b->syntax.requests) {
        fail_msg("%s: cut at %zu it is another request", c->name, cut);
    }
}

static void each_case_has_its_fault(void **state)
{
    passed *p = *state;
    for (size_t i = 0; i < framing_case_count(); i++) {
        const framing_case *c = framing_case_at(i);
        size_t length;
        char *bytes = framing_case_bytes(c, &length);
        feed(&p[0], bytes, length, (arrival){0, length, ROOM / 2});
        int code = code_of(&p[0]);
        const char *slug = code == HE_OK ? "none" : api_code_slug(code);
        if (strcmp(slug, c->fault ? c->code : "none") != 0) {
            fail_msg("%s: %s", c->name, slug);
        }
        if (c->fault) {
            api_problem problem = {0};
            assert_true(srv_syntax_fault(&p[0].syntax, 1, &problem));
            assert_int_equal(api_problem_http(&problem), c->status);
            assert_false(srv_syntax_fault(&p[0].syntax, 2, &problem));
        } else {
            assert_int_equal(p[0].length, length);
        }
        free(bytes);
    }
}

static void a_case_is_the_same_wherever_it_is_cut(void **state)
{
    passed *p = *state;
    for (size_t i = 0; i < framing_case_count(); i++) {
        const framing_case *c = framing_case_at(i);
        size_t length;
        char *bytes = framing_case_bytes(c, &length);
        feed(&p[0], bytes, length, (arrival){0, length, ROOM / 2});
        feed(&p[1], bytes, length, (arrival){0, length, 0});
        expect_equal(c, &p[0], &p[1], 0);
        feed(&p[1], bytes, length, (arrival){0, 1, 0});
        expect_equal(c, &p[0], &p[1], 1);
        feed(&p[1], bytes, length, (arrival){0, 997, 1});
        expect_equal(c, &p[0], &p[1], 997);
        for (size_t cut = 1; cut < length && length < 1000; cut++) {
            feed(&p[1], bytes, length, (arrival){cut, length, cut % 5});
            expect_equal(c, &p[0], &p[1], cut);
        }
        free(bytes);
    }
}

/* The output of the check must equal its input up to the fault, except that the check may remove
 * blanks and cookies. */
static void no_byte_after_a_fault_is_passed_on(void **state)
{
    passed *p = *state;
    for (size_t i = 0; i < framing_case_count(); i++) {
        const framing_case *c = framing_case_at(i);
        size_t length, same = 0, taken;
        char *bytes = framing_case_bytes(c, &length);
        feed(&p[0], bytes, length, (arrival){0, 1, 0});
        taken =
            p[0].taken -
            (c->fault
                 ? 1
                 : 0); /* if there is a fault, the last byte that was checked is the faulty byte */
        while (same < taken && (bytes[same] == p[0].bytes[same] || p[0].bytes[same] == '\0' ||
                                ((bytes[same] | 0x20) == 'e' && p[0].bytes[same] == '-') ||
                                (bytes[same] != '\n' && p[0].bytes[same] == ';'))) {
            same++;
        }
        assert_int_equal(same, taken);
        assert_true(p[0].length - taken <= 24);
        /* The result must stay the same if the bytes after the faulty byte are replaced. */
        if (c->fault) {
            memset(bytes + taken + 1, 'x', length - taken - 1);
            feed(&p[1], bytes, length, (arrival){0, length, ROOM / 2});
            expect_equal(c, &p[0], &p[1], taken);
        }
        free(bytes);
    }
}

static void requests_are_counted(void **state)
{
    passed *p = *state;
    static const char good[] = "GET / HTTP/1.1\r\nHost: a\r\n\r\n"
                               "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nGET /"
                               "\r\nPUT / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n"
                               "3\r\nabc\r\n0\r\nX: y\r\n\r\nGET / HTTP/1.0\r\n\r\n";
    feed(&p[0], good, sizeof good - 1, (arrival){0, sizeof good - 1, 0});
    assert_false(srv_syntax_is_faulty(&p[0].syntax));
    assert_int_equal(p[0].syntax.requests, 4);
    assert_false(hand_over(&p[0], "\n", 1, 10));
    for (uint64_t i = 0; i < 8; i++) {
        assert_int_equal(srv_syntax_fault(&p[0].syntax, i, NULL), i == 5);
    }
}

/* --- recv() --- */

static int pair[2];
static srv_connection watched;

static int open_pair(void **state)
{
    (void)state;
    bool open =
        socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0 && fcntl(pair[0], F_SETFL, O_NONBLOCK) == 0;
    watched = (srv_connection){.socket = pair[0]};
    return !open || !srv_recv_watch(&watched);
}

static int close_pair(void **state)
{
    (void)state;
    srv_recv_forget(pair[0]);
    return close(pair[0]) != 0 || close(pair[1]) != 0;
}

static void say(const char *text)
{
    assert_int_equal(send(pair[1], text, strlen(text), 0), strlen(text));
}

static void expect_read(size_t room, const char *text)
{
    char buffer[256];
    ssize_t got = recv(pair[0], buffer, room, 0);
    assert_int_equal(got, strlen(text));
    assert_memory_equal(buffer, text, strlen(text));
}

static void expect_nothing(void)
{
    char byte;
    errno = 0;
    assert_int_equal(recv(pair[0], &byte, 1, 0), -1);
    assert_int_equal(errno, EAGAIN);
}

static void a_watched_socket_is_read_up_to_its_fault(void **state)
{
    (void)state;
    say("GET / HTTP/1.1\r\nHost: a\r\n\r\nGET /a\nb HTTP/1.1\r\n");
    expect_read(256, "GET / HTTP/1.1\r\nHost: a\r\n\r\nGET /a HTTP/1.1\r\n\r\n");
    expect_nothing();
    say("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
    expect_nothing();
    assert_true(srv_syntax_fault(&watched.syntax, 2, NULL));
}

static void the_end_of_a_fault_comes_in_pieces(void **state)
{
    (void)state;
    say("GET /a\nb HTTP/1.1\r\n");
    expect_read(8, "GET /a H");
    expect_read(6, "TTP/1.");
    expect_read(100, "1\r\n\r\n");
    expect_nothing();
}

static void a_call_with_flags_is_not_looked_at(void **state)
{
    (void)state;
    char buffer[16];
    say("\n\n");
    assert_int_equal(recv(pair[0], buffer, sizeof buffer, MSG_PEEK), 2);
    assert_int_equal(recv(pair[0], buffer, sizeof buffer, MSG_DONTWAIT), 2);
    assert_false(srv_syntax_is_faulty(&watched.syntax));
    assert_int_equal(watched.syntax.state, 0);
}

static void another_socket_is_not_looked_at(void **state)
{
    (void)state;
    char buffer[16];
    srv_recv_forget(pair[0]);
    say("\n\n");
    assert_int_equal(recv(pair[0], buffer, sizeof buffer, 0), 2);
    assert_memory_equal(buffer, "\n\n", 2);
    assert_false(srv_syntax_is_faulty(&watched.syntax));
    errno = 0;
    assert_int_equal(recv(-1, buffer, sizeof buffer, 0), -1);
    assert_int_equal(errno, EBADF);
    srv_connection beyond[] = {{.socket = SRV_MAX_DESCRIPTORS}, {.socket = -1}};
    assert_false(srv_recv_watch(&beyond[0]));
    assert_false(srv_recv_watch(&beyond[1]));
}

static void the_end_of_a_socket_is_passed_on(void **state)
{
    (void)state;
    char byte;
    expect_nothing();
    assert_int_equal(shutdown(pair[1], SHUT_WR), 0);
    assert_int_equal(recv(pair[0], &byte, 1, 0), 0);
}

/* The time in which the headers must arrive counts from their first byte: a client that sends the
 * headers byte by byte gets no more time than a client that sends them at once. */
static void a_head_begins_with_its_first_byte(void **state)
{
    (void)state;
    assert_int_equal(watched.stage, SRV_STAGE_IDLE);
    say("\r\n");
    expect_read(256, "\r\n");
    assert_int_equal(watched.stage, SRV_STAGE_IDLE);
    say("G");
    expect_read(256, "G");
    assert_int_equal(watched.stage, SRV_STAGE_HEAD);
    uint64_t since = watched.since;
    assert_true(since > 0);
    say("ET / HTTP/1.1\r\nHo");
    expect_read(256, "ET / HTTP/1.1\r\nHo");
    assert_int_equal(watched.stage, SRV_STAGE_HEAD);
    assert_true(watched.since == since);
}

static int setup(void **state)
{
    passed *p = calloc(2, sizeof *p);
    assert_non_null(p);
    p[0].bytes = malloc(ROOM);
    p[1].bytes = malloc(ROOM);
    *state = p;
    return p[0].bytes == NULL || p[1].bytes == NULL;
}

static int teardown(void **state)
{
    passed *p = *state;
    free(p[0].bytes);
    free(p[1].bytes);
    free(p);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_case_has_its_fault, setup, teardown),
        cmocka_unit_test_setup_teardown(a_case_is_the_same_wherever_it_is_cut, setup, teardown),
        cmocka_unit_test_setup_teardown(no_byte_after_a_fault_is_passed_on, setup, teardown),
        cmocka_unit_test_setup_teardown(requests_are_counted, setup, teardown),
        cmocka_unit_test_setup_teardown(a_head_begins_with_its_first_byte, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_watched_socket_is_read_up_to_its_fault, open_pair,
                                        close_pair),
        cmocka_unit_test_setup_teardown(the_end_of_a_fault_comes_in_pieces, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(a_call_with_flags_is_not_looked_at, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(another_socket_is_not_looked_at, open_pair, close_pair),
        cmocka_unit_test_setup_teardown(the_end_of_a_socket_is_passed_on, open_pair, close_pair),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
