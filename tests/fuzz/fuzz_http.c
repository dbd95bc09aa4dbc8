/* The bytes of a connection, which http_syntax.h checks before libmicrohttpd reads them. In
 * whatever pieces they arrive, and however little room there is for the output, the same bytes must
 * be passed on, with the same fault in the same request. Nothing after a fault may change the
 * result. Lines and chunks that are passed on must end as RFC 9112 says. The same bytes are also
 * tried as the value of a traceparent. */
#include "fuzz/fuzz.h"
#include "server/http/syntax/http_syntax.h"
#include "server/log/trace.h"
#include "unit/fixture.h"

enum { PIECES = 4, ENDING = 32, STEPS = 6 };

typedef struct passed {
    srv_syntax syntax;
    char *bytes;
    size_t length, taken;
} passed;

static uint64_t next(uint64_t *seed)
{
    *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return *seed >> 33;
}

static void feed(passed *p, const char *bytes, size_t size, uint64_t *seed)
{
    p->syntax = (srv_syntax){0};
    p->length = 0;
    p->taken = 0;
    while (p->taken < size && !srv_syntax_is_faulty(&p->syntax)) {
        size_t left = size - p->taken;
        size_t piece = seed == NULL ? left : 1 + (size_t)next(seed) % STEPS;
        size_t room = seed == NULL ? ENDING : (size_t)next(seed) % ENDING;
        piece = piece < left ? piece : left;
        memcpy(p->bytes + p->length, bytes + p->taken, piece);
        p->taken += piece;
        p->length += srv_syntax_check(&p->syntax, p->bytes + p->length, piece, piece + room);
    }
    while (srv_syntax_is_faulty(&p->syntax)) {
        size_t more = srv_syntax_end(&p->syntax, p->bytes + p->length, 1 + p->length % 3);
        p->length += more;
        if (more == 0) {
            break;
        }
    }
}

static void require_equal(const passed *a, const passed *b, const char *what)
{
    FUZZ_REQUIRE(a->syntax.fault == b->syntax.fault, "%s: fault %u, then %u", what, a->syntax.fault,
                 b->syntax.fault);
    FUZZ_REQUIRE(a->syntax.requests == b->syntax.requests, "%s: another request", what);
    FUZZ_REQUIRE(a->syntax.state == b->syntax.state, "%s: another state", what);
    FUZZ_REQUIRE(a->length == b->length && memcmp(a->bytes, b->bytes, a->length) == 0,
                 "%s: other bytes are passed on", what);
}

/* Feeds one byte at a time: when the fault is found, every byte before it must have been
 * passed on. */
static size_t find_fault(passed *p, const char *bytes, size_t size)
{
    p->syntax = (srv_syntax){0};
    for (size_t i = 0; i < size; i++) {
        char byte = bytes[i], room[ENDING + 1];
        room[0] = byte;
        size_t length = srv_syntax_check(&p->syntax, room, 1, sizeof room);
        if (srv_syntax_is_faulty(&p->syntax)) {
            return i;
        }
        FUZZ_REQUIRE(length == 1, "%zu bytes for one", length);
        bool kept = room[0] == byte;
        bool blank = (byte == ' ' || byte == '\t') && (room[0] == '\0' || room[0] == ';');
        bool cookie = (byte == 'e' || byte == 'E') && room[0] == '-';
        FUZZ_REQUIRE(kept || blank || cookie, "byte %zu becomes %d", i, room[0]);
    }
    return size;
}

/* Takes the bytes as the request header traceparent and checks that the answer gets a well-formed
 * one. It must continue the same trace if the bytes are well-formed, and else begin another
 * trace. */
static void check_trace(const uint8_t *input, size_t size)
{
    static srv_spans spans = {.seed = 1, .next = 1};
    static const char digits[] = "0123456789abcdef";
    char *value = malloc(size + 1);
    srv_trace trace;
    assert_non_null(value);
    memcpy(value, input, size);
    value[size] = '\0';
    srv_trace_read(&spans, value, 1, &trace);
    const char *answer = trace.answered;
    FUZZ_REQUIRE(strlen(answer) == SRV_TRACEPARENT && strncmp(answer, "00-", 3) == 0 &&
                     strspn(answer + 3, digits) == SRV_TRACE_ID && answer[35] == '-' &&
                     strspn(answer + 36, digits) == SRV_SPAN_ID && answer[52] == '-' &&
                     answer[53] == '0' && (answer[54] == '0' || answer[54] == '1'),
                 "%s is no traceparent", answer);
    const bool goes_on = trace.parent_id[0] != '\0';
    FUZZ_REQUIRE(!goes_on || (strncmp(value + 3, trace.trace_id, SRV_TRACE_ID) == 0 &&
                              strncmp(value + 36, trace.parent_id, SRV_SPAN_ID) == 0),
                 "%s goes on as %s", value, answer);
    FUZZ_REQUIRE(goes_on || strlen(value) < SRV_TRACEPARENT ||
                     strncmp(value + 3, trace.trace_id, SRV_TRACE_ID) != 0,
                 "%s is malformed and goes on", value);
    free(value);
}

void fuzz_one(const uint8_t *input, size_t size)
{
    uint64_t seed = fuzz_hash(input, size);
    check_trace(input, size);
    char *bytes = malloc(size + 1);
    passed whole = {.bytes = malloc(size + 2 * ENDING)}, cut = {.bytes = malloc(size + 2 * ENDING)};
    assert_non_null(bytes);
    assert_non_null(whole.bytes);
    assert_non_null(cut.bytes);
    memcpy(bytes, input, size);
    feed(&whole, bytes, size, NULL);
    for (int i = 0; i < PIECES; i++) {
        feed(&cut, bytes, size, &seed);
        require_equal(&whole, &cut, "cut");
    }
    size_t fault = find_fault(&cut, bytes, size);
    FUZZ_REQUIRE((fault < size) == srv_syntax_is_faulty(&whole.syntax), "byte by byte");
    FUZZ_REQUIRE(fault < size ? whole.length - fault < ENDING : whole.length == size,
                 "%zu bytes are passed on, %zu came", whole.length, fault);
    for (size_t i = fault + 1; i < size; i++) {
        bytes[i] = (char)next(&seed);
    }
    feed(&cut, bytes, size, NULL);
    require_equal(&whole, &cut, "after the fault");
    free(bytes);
    free(whole.bytes);
    free(cut.bytes);
}
