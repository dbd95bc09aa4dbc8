/* Tests of reading and writing numbers as text: the results are compared with the C library (which
 * is exact in the "C" locale) and with big integers. The environment variable SEED sets the random
 * numbers, ROUNDS sets how many of them are tried. */
#include "format/text/number.h"

#include "format/text/decimal_exact.h"
#include "format/text/pow5.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static uint64_t seed, rounds;

static uint64_t next_random(void)
{
    seed += 0x9E3779B97F4A7C15;
    uint64_t z = (seed ^ seed >> 30) * 0xBF58476D1CE4E5B9;
    z = (z ^ z >> 27) * 0x94D049BB133111EB;
    return z ^ z >> 31;
}

static double from_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t to_bits(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static bool is_finite_bits(uint64_t bits)
{
    return (bits >> 52 & 0x7FF) != 0x7FF;
}

/* Returns a random double: either random bits, or a number of a kind that is frequent in mesh
 * files. */
static double random_double(void)
{
    for (;;) {
        uint64_t bits = next_random();
        double value;
        switch (next_random() % 6) {
        case 0:
            value = (double)(int64_t)(bits >> 40) / 1000.0;
            break;
        case 1:
            value = (double)(bits >> 11) * 0x1p-53;
            break;
        case 2: /* exponents near the middle of the range of exponents */
            value =
                from_bits((bits & 0x800FFFFFFFFFFFFF) | (1023 - 60 + next_random() % 120) << 52);
            break;
        case 3: /* powers of two and the doubles next to them */
            value = from_bits(((bits & 0x7FF) << 52) + next_random() % 3 - 1);
            break;
        default:
            value = from_bits(bits);
            break;
        }
        if (is_finite_bits(to_bits(value))) {
            return value;
        }
    }
}

static he_status parse(const char *text, he_grammar grammar, double *value, size_t *used)
{
    return he_double_parse(text, text + strlen(text), grammar, value, used);
}

static void expect_bits(const char *text, double wanted)
{
    double got = 0;
    size_t used = 0;
    he_status status = parse(text, HE_FILE_NUMBER, &got, &used);
    if (status != HE_OK || to_bits(got) != to_bits(wanted) || used != strlen(text)) {
        fail_msg("%.60s: status %d, got %a, wanted %a, used %zu", text, (int)status, got, wanted,
                 used);
    }
}

/* A big integer in base 2^32, least significant word first, for checking the table of powers of
 * five. */
typedef struct whole {
    uint32_t words[100];
} whole;

static void times_five(whole *n)
{
    uint64_t carry = 0;
    for (size_t i = 0; i < 100; i++) {
        carry += (uint64_t)n->words[i] * 5;
        n->words[i] = (uint32_t)carry;
        carry >>= 32;
    }
}

static void divide_by_five(whole *n)
{
    uint64_t rest = 0;
    for (size_t i = 100; i-- > 0;) {
        rest = rest << 32 | n->words[i];
        n->words[i] = (uint32_t)(rest / 5);
        rest %= 5;
    }
}

static he_pow5 leading_bits(const whole *n)
{
    size_t top = 3200;
    while (top > 0 && (n->words[(top - 1) / 32] >> (top - 1) % 32 & 1) == 0) {
        top--;
    }
    he_pow5 p = {0, 0};
    for (size_t i = 0; i < 128; i++) {
        uint64_t bit = top > i ? n->words[(top - 1 - i) / 32] >> (top - 1 - i) % 32 & 1 : 0;
        if (i < 64) {
            p.high |= bit << (63 - i);
        } else {
            p.low |= bit << (127 - i);
        }
    }
    return p;
}

static void powers_are_the_floor_of_the_true_ones(void **state)
{
    (void)state;
    static whole n;
    memset(&n, 0, sizeof n);
    n.words[0] = 1;
    for (int k = 0; k <= HE_POW5_MAX; k++, times_five(&n)) {
        he_pow5 wanted = leading_bits(&n), got = he_pow5_get(k);
        assert_int_equal(got.high, wanted.high);
        assert_int_equal(got.low, wanted.low);
    }
    /* If k is negative, the table must have the leading bits of floor(2^3199 / 5^-k). Dividing by
     * five repeatedly, and rounding down each time, gives exactly this number, and it has enough
     * bits. */
    memset(&n, 0, sizeof n);
    n.words[99] = 0x80000000;
    for (int k = 0; k >= HE_POW5_MIN; k--, divide_by_five(&n)) {
        he_pow5 wanted = leading_bits(&n), got = he_pow5_get(k);
        assert_int_equal(got.high, wanted.high);
        assert_int_equal(got.low, wanted.low);
    }
}

/* Prints a double as text. The C library and hedge's reader must both read the text as this double,
 * and no text with fewer digits may be read as this double. */
static void check_print(double value, bool try_all)
{
    char text[HE_NUMBER_TEXT + 1], other[64];
    size_t length = he_double_print(value, text);
    assert_true(length < HE_NUMBER_TEXT);
    text[length] = '\0';
    if (to_bits(strtod(text, NULL)) != to_bits(value)) {
        fail_msg("%a printed as %s", value, text);
    }
    double back;
    size_t used;
    if (parse(text, HE_JSON_NUMBER, &back, &used) != HE_OK || used != length ||
        to_bits(back) != to_bits(value)) {
        fail_msg("%s does not read back", text);
    }
    size_t digits = 0, zeros = 0;
    bool leading = true;
    for (const char *p = text; *p != '\0' && *p != 'e'; p++) {
        if (*p >= '0' && *p <= '9' && !(leading && *p == '0')) {
            leading = false;
            digits++;
            zeros = *p == '0' ? zeros + 1 : 0;
        }
    }
    digits -= zeros;
    if (value == 0 || !try_all) {
        return;
    }
    for (int precision = 1; precision <= 17; precision++) {
        snprintf(other, sizeof other, "%.*e", precision - 1, value);
        if (to_bits(strtod(other, NULL)) == to_bits(value)) {
            if ((size_t)precision < digits) {
                fail_msg("%s is longer than %s", text, other);
            }
            /* printf with %.*e gives the closest text of this length */
            if ((size_t)precision == digits) {
                char ours[64];
                snprintf(ours, sizeof ours, "%.*e", precision - 1, strtod(text, NULL));
                assert_string_equal(ours, other);
            }
            break;
        }
    }
}

static void random_doubles_print_shortest(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < rounds; i++) {
        check_print(random_double(), i % 4 == 0);
    }
}

static void random_floats_print_shortest(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < rounds; i++) {
        uint32_t bits = (uint32_t)next_random();
        float value;
        memcpy(&value, &bits, sizeof value);
        if ((bits >> 23 & 0xFF) == 0xFF) {
            continue;
        }
        char text[HE_NUMBER_TEXT + 1], shorter[64];
        size_t length = he_float_print(value, text);
        assert_true(length < HE_NUMBER_TEXT);
        text[length] = '\0';
        float back = strtof(text, NULL);
        uint32_t back_bits;
        memcpy(&back_bits, &back, sizeof back);
        if (back_bits != bits) {
            fail_msg("%a printed as %s", (double)value, text);
        }
        size_t digits = 0;
        for (const char *p = text; *p != '\0' && *p != 'e'; p++) {
            digits += *p >= '1' && *p <= '9';
        }
        for (int precision = 1; precision < (int)digits; precision++) {
            snprintf(shorter, sizeof shorter, "%.*e", precision - 1, (double)value);
            if (strtof(shorter, NULL) == value) {
                fail_msg("%s is longer than %s", text, shorter);
            }
        }
    }
}

static void random_text_parses_like_the_c_library(void **state)
{
    (void)state;
    char text[128];
    for (uint64_t i = 0; i < rounds; i++) {
        double value = random_double();
        int precision = (int)(next_random() % 25);
        if (i % 2 == 0) {
            snprintf(text, sizeof text, "%.*e", precision, value);
        } else {
            /* random digits, which are mostly not the text as which a double would be printed */
            snprintf(text, sizeof text, "%llu%s%0*llu%se%d",
                     (unsigned long long)next_random() >> next_random() % 64, i % 3 ? "." : "",
                     precision, (unsigned long long)next_random(), i % 5 ? "" : "00000",
                     (int)(next_random() % 700) - 350);
        }
        double wanted = strtod(text, NULL), got = 0;
        size_t used = 0;
        he_status status = parse(text, HE_FILE_NUMBER, &got, &used);
        if (!is_finite_bits(to_bits(wanted))) {
            assert_int_equal(status, HE_NOT_FINITE);
        } else if (status != HE_OK || to_bits(got) != to_bits(wanted)) {
            fail_msg("%s: status %d, got %a, wanted %a", text, (int)status, got, wanted);
        }
        assert_int_equal(used, strlen(text));
    }
}

/* Reads the decimal text of the exact middle between two doubles, and of the numbers one more and
 * one less in its last digit: only the middle itself must be rounded to the even double. */
static void middles_go_to_even(void **state)
{
    (void)state;
    char text[1500];
    for (uint64_t i = 0; i < rounds / 100; i++) {
        uint64_t bits = next_random() & 0x7FFFFFFFFFFFFFFF;
        if (i % 4 == 0) {
            bits &= 0x000FFFFFFFFFFFFF; /* makes the number subnormal */
        }
        if (i % 4 == 1) {
            bits = (bits & 0x000FFFFFFFFFFFFF) | (uint64_t)(1023 + i % 80) << 52;
        }
        if (bits >> 52 >= 0x7FE) {
            continue;
        }
        /* A long double has enough bits to hold the middle, and printf prints it exactly. */
        long double middle = ((long double)from_bits(bits) + (long double)from_bits(bits + 1)) / 2;
        int length = snprintf(text, sizeof text - 2, "%.1100Lf", middle);
        assert_true(length > 0 && length < (int)sizeof text - 2);
        expect_bits(text, from_bits(bits + (bits & 1)));
        text[length] = '1';
        text[length + 1] = '\0';
        expect_bits(text, from_bits(bits + 1));
        text[length] = '\0';
        for (int k = length - 1; k >= 0;
             k--) { /* subtracts one from the last digit of the text, with borrowing */
            if (text[k] != '.') {
                if (text[k] != '0') {
                    text[k]--;
                    break;
                }
                text[k] = '9';
            }
        }
        expect_bits(text, from_bits(bits));
    }
}

/* he_double_parse rarely needs he_decimal_exact_round. This test calls he_decimal_exact_round
 * directly, with bad guesses of the result. */
static void exact_rounding_from_any_near_guess(void **state)
{
    (void)state;
    char text[64];
    for (uint64_t i = 0; i < rounds / 20; i++) {
        double value = from_bits(to_bits(random_double()) & 0x7FFFFFFFFFFFFFFF);
        if (value == 0) {
            continue;
        }
        snprintf(text, sizeof text, "%.*e", (int)(next_random() % 20), value);
        double wanted = strtod(text, NULL);
        char *e = strchr(text, 'e'), *point = strchr(text, '.');
        int64_t exponent = strtol(e + 1, NULL, 10) - (point == NULL ? 0 : e - point - 1);
        uint64_t guess = to_bits(wanted) + next_random() % 7;
        guess = guess > 3 ? guess - 3 : 0;
        assert_int_equal(he_decimal_exact_round(text, e, exponent, guess), to_bits(wanted));
    }
}

static void known_texts(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } rows[] = {
        {0.0, "0"},
        {-0.0, "-0"},
        {1.0, "1"},
        {-1.0, "-1"},
        {0.1, "0.1"},
        {0.3, "0.3"},
        {1.0 / 3, "0.3333333333333333"},
        {100.0, "100"},
        {123.456, "123.456"},
        {1e-6, "0.000001"},
        {1e-7, "1e-7"},
        {1.5e-7, "1.5e-7"},
        {1.5e300, "1.5e300"},
        {1e20, "100000000000000000000"},
        {123456789012345680000.0, "123456789012345680000"},
        {1e21, "1e21"},
        {9007199254740991.0, "9007199254740991"},
        {9007199254740992.0, "9007199254740992"},
        {9007199254740994.0, "9007199254740994"},
        {18014398509481984.0, "18014398509481984"},
        {1e23, "1e23"},
        {9.5367431640625e-7, "9.5367431640625e-7"},
        {5e-324, "5e-324"},
        {1e-323, "1e-323"},
        {2.2250738585072014e-308, "2.2250738585072014e-308"},
        {2.225073858507201e-308, "2.225073858507201e-308"},
        {1.7976931348623157e308, "1.7976931348623157e308"},
        {-1.7976931348623157e308, "-1.7976931348623157e308"},
        {4.35, "4.35"},
        {0.00001, "0.00001"},
        {1234567.125, "1234567.125"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[HE_NUMBER_TEXT + 1];
        text[he_double_print(rows[i].value, text)] = '\0';
        assert_string_equal(text, rows[i].text);
        check_print(rows[i].value, true);
    }
    char text[HE_NUMBER_TEXT + 1];
    text[he_float_print(0.1f, text)] = '\0';
    assert_string_equal(text, "0.1");
    text[he_float_print(1.17549435e-38f, text)] = '\0';
    assert_string_equal(text, "1.1754944e-38");
    text[he_float_print(-16777216.0f, text)] = '\0';
    assert_string_equal(text, "-16777216");
}

static void parse_edges(void **state)
{
    (void)state;
    static const char *const same[] = {
        "0",
        "-0",
        "1",
        "1e0",
        "0.1",
        "9007199254740993",
        "9007199254740993.00000000000000000001",
        "9007199254740992.99999999999999999",
        "1e308",
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "179769313486231580793e288",
        "2.2250738585072011e-308",
        "2.2250738585072012e-308",
        "4.9e-324",
        "2.4703282292062328e-324",
        "2.4703282292062327e-324",
        "1e-400",
        "0e999999999999999999999",
        "0.0e-99999999999999999",
        "123456789012345678901234567890",
        "1e23",
        "8.5e22",
        "6.02214076e23",
        "0.00000000000000000000000000000000000000000000000000001",
        "7.2057594037927933e16",
        "1448997445238699",
        "5e-324",
        "1e-323",
        "3e-324",
        "10000000000000000000000e-22",
        "00000000000000000000000000000012.5",
        "0.500000000000000166533453693773481063544750213623",
        "+1.5",
        "+.5",
        "5.",
        "-5.e1",
        "-.5e+2",
        "1E5",
        "1e+05",
        "1e-05",
        "3.1415926535897932384626",
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        expect_bits(same[i], strtod(same[i], NULL));
    }
    static const char *const infinite[] = {
        "1e309",
        "-1e309",
        "1.8e308",
        "1.7976931348623159e308",
        "1e99999999999999999999",
        "179769313486231580794e288",
        "nan",
        "NaN",
        "-nan",
        "inf",
        "+Inf",
        "-INFINITY",
        "1.#INF",
        "-1.#IND00",
        "1.#QNAN",
    };
    double value = 7;
    size_t used = 0;
    for (size_t i = 0; i < sizeof infinite / sizeof *infinite; i++) {
        assert_int_equal(parse(infinite[i], HE_FILE_NUMBER, &value, &used), HE_NOT_FINITE);
        assert_int_equal(used, strlen(infinite[i]));
    }
    static const char *const wrong[] = {"",    "-", "+",  ".",   "e5", "-.", "x",  "1e", "1e+",
                                        "+-1", ",", " 1", "--1", "na", "in", "0x", "+e1"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        he_status status = parse(wrong[i], HE_FILE_NUMBER, &value, &used);
        if (strcmp(wrong[i], "0x") ==
            0) { /* of "0x" the reader must read the 0 only, and leave the x */
            assert_int_equal(status, HE_OK);
            assert_int_equal(used, 1);
            value = 7;
        } else {
            assert_int_equal(status, HE_SYNTAX);
        }
    }
    static const char *const not_json[] = {"",    "+1", ".5",   "5.",       "01",
                                           "-01", "-",  "1.e5", "nan",      "inf",
                                           "1e",  "00", "-.5",  "Infinity", "1.#INF"};
    for (size_t i = 0; i < sizeof not_json / sizeof *not_json; i++) {
        assert_int_equal(parse(not_json[i], HE_JSON_NUMBER, &value, &used), HE_SYNTAX);
    }
    assert_true(value == 7);
    assert_int_equal(parse("1e400", HE_JSON_NUMBER, &value, &used), HE_NOT_FINITE);
    assert_int_equal(parse("-12.5e1]", HE_JSON_NUMBER, &value, &used), HE_OK);
    assert_int_equal(used, 7);
    assert_true(value == -125);
    /* the reader must not read the byte at `end` or any byte after it */
    assert_int_equal(
        he_double_parse("123456789", &"123456789"[0] + 0, HE_FILE_NUMBER, &value, &used),
        HE_SYNTAX);
    const char *digits = "12345678912345678";
    assert_int_equal(he_double_parse(digits, digits + 9, HE_JSON_NUMBER, &value, &used), HE_OK);
    assert_true(value == 123456789 && used == 9);
}

static void long_digit_strings(void **state)
{
    (void)state;
    enum { LENGTH = 1000000, ROOM = LENGTH + 64 };
    char *text = test_malloc(ROOM);
    for (size_t n = 1; n < 1200; n += 13) { /* 0.000...1234e+n and 777...e-n */
        memset(text, '0', n + 2);
        text[1] = '.';
        snprintf(text + n + 2, 64, "12345678901234567890123e%zu", n);
        expect_bits(text, strtod(text, NULL));
        memset(text, '7', n);
        snprintf(text + n, 64, ".25e-%zu", n);
        expect_bits(text, strtod(text, NULL));
    }
    memset(text, '3', 800);
    text[800] = '\0';
    text[1] = '.';
    expect_bits(text, strtod(text, NULL));
    /* The digit that decides the rounding is the 700th, 799th, 800th, and so on; in the last case
     * it is the last of a million digits. */
    static const size_t places[] = {700, 799, 800, 801, 802, 900, LENGTH - 1};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        memset(text, '0', places[i]);
        memcpy(text, "9007199254740993.", 17);
        text[places[i]] = '\0';
        expect_bits(text, 9007199254740992.0);
        memcpy(text + places[i], "1", 2);
        expect_bits(text, 9007199254740994.0);
    }
    memset(text, '1', LENGTH);
    text[LENGTH] = '\0';
    double value;
    size_t used;
    assert_int_equal(parse(text, HE_JSON_NUMBER, &value, &used), HE_NOT_FINITE);
    assert_int_equal(used, LENGTH);
    snprintf(text + LENGTH, 64, "e-%d", LENGTH);
    expect_bits(text, 0.1111111111111111111111);
    test_free(text);
}

static void integers(void **state)
{
    (void)state;
    char text[HE_NUMBER_TEXT + 1], wanted[32];
    for (uint64_t i = 0; i < rounds; i++) {
        uint64_t value = next_random() >> next_random() % 64;
        if (i < 64) {
            value = (UINT64_C(1) << i) - (i & 1);
        }
        text[he_u64_print(value, text)] = '\0';
        snprintf(wanted, sizeof wanted, "%llu", (unsigned long long)value);
        assert_string_equal(text, wanted);
        uint64_t back;
        size_t used;
        assert_int_equal(he_u64_parse(text, text + strlen(text), &back, &used), HE_OK);
        assert_true(back == value && used == strlen(text));

        text[he_u32_print((uint32_t)value, text)] = '\0';
        snprintf(wanted, sizeof wanted, "%u", (unsigned)(uint32_t)value);
        assert_string_equal(text, wanted);

        text[he_i64_print((int64_t)value, text)] = '\0';
        snprintf(wanted, sizeof wanted, "%lld", (long long)value);
        assert_string_equal(text, wanted);
        int64_t signed_back;
        assert_int_equal(he_i64_parse(text, text + strlen(text), &signed_back, &used), HE_OK);
        assert_true(signed_back == (int64_t)value && used == strlen(text));
    }
    for (uint64_t power = 1, i = 0; i < 20; i++, power *= 10) {
        for (uint64_t value = power - 1; value <= power + 1; value++) {
            text[he_u64_print(value, text)] = '\0';
            snprintf(wanted, sizeof wanted, "%llu", (unsigned long long)value);
            assert_string_equal(text, wanted);
        }
    }
    static const struct {
        const char *text;
        he_status as_unsigned, as_signed;
        size_t used;
    } rows[] = {
        {"18446744073709551615", HE_OK, HE_BAD_VALUE, 20},
        {"18446744073709551616", HE_BAD_VALUE, HE_BAD_VALUE, 20},
        {"184467440737095516150x", HE_BAD_VALUE, HE_BAD_VALUE, 21},
        {"9223372036854775807", HE_OK, HE_OK, 19},
        {"9223372036854775808", HE_OK, HE_BAD_VALUE, 19},
        {"-9223372036854775808", HE_SYNTAX, HE_OK, 20},
        {"-9223372036854775809", HE_SYNTAX, HE_BAD_VALUE, 20},
        {"000000000000000000000000000000012 ", HE_OK, HE_OK, 33},
        {"12.5", HE_OK, HE_OK, 2},
        {"", HE_SYNTAX, HE_SYNTAX, 0},
        {"-", HE_SYNTAX, HE_SYNTAX, 0},
        {"+1", HE_SYNTAX, HE_SYNTAX, 0},
        {"x", HE_SYNTAX, HE_SYNTAX, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const char *end = rows[i].text + strlen(rows[i].text);
        uint64_t value;
        int64_t signed_value;
        size_t used = 0;
        assert_int_equal(he_u64_parse(rows[i].text, end, &value, &used), rows[i].as_unsigned);
        if (rows[i].as_unsigned != HE_SYNTAX) {
            assert_int_equal(used, rows[i].used);
        }
        assert_int_equal(he_i64_parse(rows[i].text, end, &signed_value, &used), rows[i].as_signed);
        if (rows[i].as_signed != HE_SYNTAX) {
            assert_int_equal(used, rows[i].used);
        }
    }
}

int main(void)
{
    const char *text = getenv("SEED");
    seed = text != NULL ? strtoull(text, NULL, 10) : 20240229;
    text = getenv("ROUNDS");
    rounds = text != NULL ? strtoull(text, NULL, 10) : 200000;
    print_message("SEED=%llu ROUNDS=%llu\n", (unsigned long long)seed, (unsigned long long)rounds);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(powers_are_the_floor_of_the_true_ones),
        cmocka_unit_test(known_texts),
        cmocka_unit_test(parse_edges),
        cmocka_unit_test(long_digit_strings),
        cmocka_unit_test(integers),
        cmocka_unit_test(random_doubles_print_shortest),
        cmocka_unit_test(random_floats_print_shortest),
        cmocka_unit_test(random_text_parses_like_the_c_library),
        cmocka_unit_test(middles_go_to_even),
        cmocka_unit_test(exact_rounding_from_any_near_guess),
    };
    return cmocka_run_group_tests_name("number", tests, NULL, NULL);
}
