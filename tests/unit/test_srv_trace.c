/* Tests of the header traceparent of requests and answers, with cases from the W3C recommendation
 * and with random bytes. */
#include "tests/seed.h"
#include "tests/unit/fixture.h"

#include "server/log/trace.h"

#define TRACE  "4bf92f3577b34da6a3ce929d0e0e4736"
#define PARENT "00f067aa0ba902b7"

static srv_trace read_values(const char *const *values, size_t count)
{
    static srv_spans spans;
    static bool begun;
    srv_trace trace;
    if (!begun) {
        srv_spans_init(&spans);
        begun = true;
    }
    srv_trace_read(&spans, count == 0 ? NULL : values[0], count, &trace);
    return trace;
}

static bool is_lower_hexadecimal(const char *text, size_t length)
{
    return strlen(text) == length && strspn(text, "0123456789abcdef") == length &&
           strspn(text, "0") != length;
}

/* Requires that the traceparent of the answer is well formed, whatever the traceparent of the
 * request was. */
static void check_answer(const srv_trace *trace, char flag)
{
    char expected[SRV_TRACEPARENT + 1];
    assert_true(is_lower_hexadecimal(trace->trace_id, SRV_TRACE_ID));
    assert_true(is_lower_hexadecimal(trace->span_id, SRV_SPAN_ID));
    snprintf(expected, sizeof expected, "00-%s-%s-0%c", trace->trace_id, trace->span_id, flag);
    assert_string_equal(trace->answered, expected);
}

typedef struct trace_case {
    const char *value;
    char flag; /* expected flag in the answer's traceparent; 0 if `value` is malformed */
} trace_case;

static const trace_case cases[] = {
    {"00-" TRACE "-" PARENT "-00", '0'},
    {"00-" TRACE "-" PARENT "-01", '1'},
    {"00-" TRACE "-" PARENT "-ff", '1'},
    {"00-" TRACE "-" PARENT "-02", '0'},
    {"01-" TRACE "-" PARENT "-01", '1'},
    {"cc-" TRACE "-" PARENT "-01-what-the-future-will-be-like", '1'},
    {"fe-" TRACE "-" PARENT "-00-", '0'},
    {"", 0},
    {"00", 0},
    {"00-" TRACE "-" PARENT, 0},
    {"00-" TRACE "-" PARENT "-", 0},
    {"00-" TRACE "-" PARENT "-0", 0},
    {"00-" TRACE "-" PARENT "-01-", 0},
    {"00-" TRACE "-" PARENT "-01-more", 0},
    {"00-" TRACE "-" PARENT "-01,00-" TRACE "-" PARENT "-01", 0},
    {"01-" TRACE "-" PARENT "-01.more", 0},
    {"ff-" TRACE "-" PARENT "-01", 0},
    {"0F-" TRACE "-" PARENT "-01", 0},
    {"0-" TRACE "-" PARENT "-001", 0},
    {".0-" TRACE "-" PARENT "-01", 0},
    {"00-00000000000000000000000000000000-" PARENT "-01", 0},
    {"00-" TRACE "-0000000000000000-01", 0},
    {"00-4BF92F3577B34DA6A3CE929D0E0E4736-" PARENT "-01", 0},
    {"00-" TRACE "-00F067AA0BA902B7-01", 0},
    {"00-4bf92f3577b34da6a3ce929d0e0e473g-" PARENT "-01", 0},
    {"00-" TRACE "-00f067aa0ba902b.-01", 0},
    {"00-" TRACE "-" PARENT "-.1", 0},
    {"00-" TRACE "-" PARENT "-0x", 0},
    {"00_" TRACE "-" PARENT "-01", 0},
    {"00-" TRACE "_" PARENT "-01", 0},
    {"00-" TRACE "-" PARENT "_01", 0},
    {" 00-" TRACE "-" PARENT "-01", 0},
    {"00-" TRACE "-" PARENT "-01 ", 0},
    {"00-4bf92f3577b34da6a3ce929d0e0e473\xe9-" PARENT "-01", 0},
};

static void a_trace_that_is_well_formed_goes_on_and_another_begins_anew(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const trace_case *c = &cases[i];
        srv_trace trace = read_values(&c->value, 1);
        check_answer(&trace, c->flag == 0 ? '0' : c->flag);
        if ((strcmp(trace.trace_id, TRACE) == 0) != (c->flag != 0) ||
            strcmp(trace.parent_id, c->flag != 0 ? PARENT : "") != 0) {
            fail_msg("\"%s\" became trace %s, parent \"%s\"", c->value, trace.trace_id,
                     trace.parent_id);
        }
        assert_string_not_equal(trace.span_id, PARENT);
    }
}

static void without_a_traceparent_there_is_no_trace(void **state)
{
    (void)state;
    srv_trace trace = read_values(NULL, 0);
    assert_string_equal(trace.trace_id, "");
    assert_string_equal(trace.span_id, "");
    assert_string_equal(trace.answered, "");
}

static void a_traceparent_that_comes_twice_counts_as_malformed(void **state)
{
    (void)state;
    const char *const values[] = {cases[0].value, cases[0].value};
    srv_trace trace = read_values(values, 2);
    check_answer(&trace, '0');
    assert_string_not_equal(trace.trace_id, TRACE);
    assert_string_equal(trace.parent_id, "");
}

static int compare(const void *a, const void *b)
{
    return strcmp(a, b);
}

static void no_id_is_given_twice(void **state)
{
    (void)state;
    enum { TRACES = 1000, IDS = 3 * TRACES };
    static const char *const malformed = "";
    static char ids[IDS][SRV_SPAN_ID + 1];
    for (size_t i = 0; i < IDS; i += 3) {
        srv_trace trace = read_values(&malformed, 1);
        memcpy(ids[i], trace.span_id, SRV_SPAN_ID);
        /* The id of a new trace consists of two ids of this kind. */
        memcpy(ids[i + 1], trace.trace_id, SRV_SPAN_ID);
        memcpy(ids[i + 2], trace.trace_id + SRV_SPAN_ID, SRV_SPAN_ID);
    }
    qsort(ids, IDS, sizeof *ids, compare);
    for (size_t i = 1; i < IDS; i++) {
        assert_string_not_equal(ids[i - 1], ids[i]);
    }
}

/* Returns a pseudo-random number below `end`, by the generator of Knuth's computer MMIX. */
static unsigned below(uint64_t *random, unsigned end)
{
    *random = *random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (unsigned)((*random >> 33) % end);
}

/* Random bytes replace some bytes of a well-formed value. The parser must accept exactly what a
 * simple, literal implementation of the grammar accepts. */
static void random_values_are_read_as_the_grammar_says(void **state)
{
    (void)state;
    enum { ROUNDS = 20000 };
    uint64_t random = seed_of_run();
    static const char letters[] = "0123456789abcdefABCDEFg-_. ";
    int taken = 0;
    for (int round = 0; round < ROUNDS; round++) {
        char value[80];
        snprintf(value, sizeof value, "%s", cases[round % 7].value);
        for (unsigned n = below(&random, 3); n > 0; n--) {
            value[below(&random, (unsigned)strlen(value))] =
                letters[below(&random, (unsigned)sizeof letters - 1)];
        }
        unsigned version = 0, flags = 0;
        char trace_id[33] = "", parent[17] = "", after = '\0';
        const char *hexadecimal = "0123456789abcdef";
        bool good = strspn(value, hexadecimal) == 2 && value[2] == '-' &&
                    strspn(value + 3, hexadecimal) == 32 && value[35] == '-' &&
                    strspn(value + 36, hexadecimal) == 16 && value[52] == '-' &&
                    strspn(value + 53, hexadecimal) == 2 &&
                    sscanf(value, "%2x-%32[0-9a-f]-%16[0-9a-f]-%2x%c", &version, trace_id, parent,
                           &flags, &after) >= 4 &&
                    version < 255 && strspn(trace_id, "0") < 32 && strspn(parent, "0") < 16 &&
                    (after == '\0' || (after == '-' && version > 0));
        const char *sent = value;
        srv_trace trace = read_values(&sent, 1);
        check_answer(&trace, good && (flags & 1) != 0 ? '1' : '0');
        assert_string_equal(trace.parent_id, good ? parent : "");
        if (good) {
            assert_string_equal(trace.trace_id, trace_id);
        }
        taken += good;
    }
    assert_true(taken > ROUNDS / 10 && taken < ROUNDS);
    printf("note: %d of %d values were well formed\n", taken, ROUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_trace_that_is_well_formed_goes_on_and_another_begins_anew),
        cmocka_unit_test(without_a_traceparent_there_is_no_trace),
        cmocka_unit_test(a_traceparent_that_comes_twice_counts_as_malformed),
        cmocka_unit_test(no_id_is_given_twice),
        cmocka_unit_test(random_values_are_read_as_the_grammar_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
