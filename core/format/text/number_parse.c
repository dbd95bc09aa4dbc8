#include "format/text/number.h"

#include "format/text/decimal_exact.h"
#include "format/text/pow5.h"

#include <stdbool.h>
#include <string.h>

#define INFINITY_BITS ((uint64_t)0x7FF << 52)

static bool is_digit(char c)
{
    return (unsigned char)(c - '0') < 10;
}

/* Returns true if all eight bytes of a word are digits. If they are, adding 6 to each byte
 * carries no bit from one byte into the next. */
static bool are_eight_digits(uint64_t word)
{
    return ((word & 0xF0F0F0F0F0F0F0F0) |
            ((word + 0x0606060606060606) & 0xF0F0F0F0F0F0F0F0) >> 4) == 0x3333333333333333;
}

/* Converts eight digits to a number: it joins digits to pairs, pairs to fours, and fours to the
 * number. It requires little-endian byte order, which column.h checks. */
static uint32_t eight_digits(uint64_t word)
{
    word -= 0x3030303030303030;
    word = word * 10 + (word >> 8);
    uint64_t first = (word & 0x000000FF000000FF) * 0x000F424000000064; /* 100 + (1000000 << 32) */
    uint64_t second = (word >> 16 & 0x000000FF000000FF) * 0x0000271000000001; /* 1 + 10000 << 32 */
    return (uint32_t)((first + second) >> 32);
}

/* Converts the digits at the start of a word, if they are fewer than eight. Returns the number
 * of digits; 0 if there are none or eight. Adding 0x76 to each byte sets the top bit of the
 * first byte that is no digit; carries of this addition only affect later bytes. */
static size_t few_digits(uint64_t word, uint64_t *value)
{
    uint64_t digits = word ^ 0x3030303030303030;
    uint64_t others = ((digits + 0x7676767676767676) | digits) & 0x8080808080808080;
    size_t count = others == 0 ? 0 : (size_t)__builtin_ctzll(others) / 8;
    if (count > 0) {
        *value = eight_digits((digits << (64 - 8 * count)) + 0x3030303030303030);
    }
    return count;
}

/* Appends decimal digits to *value, which may overflow: the caller counts the digits. */
static const char *read_digits(const char *p, const char *end, uint64_t *value)
{
    uint64_t v = *value;
    while (end - p >= 8) {
        uint64_t word;
        memcpy(&word, p, 8);
        if (!are_eight_digits(word)) {
            break;
        }
        v = v * 100000000 + eight_digits(word);
        p += 8;
    }
    while (p < end && is_digit(*p)) {
        v = v * 10 + (uint64_t)(*p - '0');
        p++;
    }
    *value = v;
    return p;
}

/* Returns the bits of the double nearest to w * 10^q, with w > 0, by the method of Eisel and
 * Lemire. *decided is set to false if 128 bits of 10^q do not suffice to tell which double is
 * nearest. */
static uint64_t nearest(uint64_t w, int64_t q, bool *decided)
{
    *decided = true;
    if (q < HE_POW5_MIN) {
        return 0;
    }
    if (q > 308) {
        return INFINITY_BITS;
    }
    he_pow5 power = he_pow5_get((int)q);
    if (q < 0 && q >= -27) { /* the method rounds inverses of exact powers up */
        power.low++;
        power.high += power.low == 0;
    }
    int zeros = __builtin_clzll(w);
    w <<= zeros;
    he_u128 product = (he_u128)w * power.high;
    uint64_t high = (uint64_t)(product >> 64), low = (uint64_t)product;
    if ((high & 0x1FF) == 0x1FF) { /* all bits below the rounding bit are set: use power.low */
        uint64_t more = (uint64_t)((he_u128)w * power.low >> 64);
        low += more;
        high += low < more;
        *decided = low != UINT64_MAX || (q >= -27 && q <= 55);
    }
    unsigned top = (unsigned)(high >> 63);
    uint64_t mantissa = high >> (top + 9); /* 53 bits, and one bit for rounding */
    int exponent = he_floor_log2_of_ten((int)q) + 63 + (int)top - zeros + 1023;
    if (exponent <= 0) {
        if (exponent <= -63) {
            return 0;
        }
        mantissa >>= 1 - exponent;
        mantissa += mantissa & 1;
        /* If rounding carries into bit 52, the exponent becomes 1, which is correct. */
        return mantissa >> 1;
    }
    /* The value is exactly in the middle between two doubles, which is only possible if 5^q fits
     * into 64 bits. It is rounded to even, so down if the last bits are 01. */
    if (low <= 1 && q >= -4 && q <= 23 && (mantissa & 3) == 1 && mantissa << (top + 9) == high) {
        mantissa &= ~(uint64_t)1;
    }
    mantissa += mantissa & 1;
    mantissa >>= 1;
    if (mantissa >> 53 != 0) {
        mantissa >>= 1;
        exponent++;
    }
    if (exponent >= 0x7FF) {
        return INFINITY_BITS;
    }
    return (uint64_t)exponent << 52 | (mantissa & (((uint64_t)1 << 52) - 1));
}

/* Returns the bits of the double nearest to a number of more than 19 digits, leading zeros
 * included: the number is the digits of [begin, end) times 10^exponent. */
static uint64_t nearest_to_many(const char *begin, const char *end, int64_t exponent)
{
    const char *p = begin;
    while (p < end && (*p == '0' || *p == '.')) {
        p++;
    }
    const char *first = p;
    uint64_t w = 0;
    int kept = 0;
    for (; p < end && kept < 19; p++) {
        if (*p != '.') {
            w = w * 10 + (uint64_t)(*p - '0');
            kept++;
        }
    }
    if (w == 0) {
        return 0;
    }
    int64_t dropped = 0;
    bool rest = false;
    for (; p < end; p++) {
        if (*p != '.') {
            dropped++;
            rest |= *p != '0';
        }
    }
    bool decided, next_decided;
    uint64_t bits = nearest(w, exponent + dropped, &decided);
    uint64_t next = nearest(w + rest, exponent + dropped, &next_decided);
    if (bits == next && decided && next_decided) {
        return bits;
    }
    return he_decimal_exact_round(first, end, exponent, bits);
}

/* Returns the length of a word by which C libraries print infinity or NaN; 0 if there is no such
 * word. */
static size_t word_length(const char *p, const char *end)
{
    static const char *const words[] = {"infinity", "inf", "nan"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i]), k = 0;
        while (k < length && p + k < end && (p[k] | 0x20) == words[i][k]) {
            k++;
        }
        if (k == length) {
            return length;
        }
    }
    return 0;
}

/* Reads the exponent that begins with the letter at `p`, and adds it to *exponent. Returns the
 * end of the exponent, or NULL if there are no digits. A huge exponent is capped; even then no
 * number of digits that fits into memory could bring the value back into the range of doubles. */
static const char *read_exponent(const char *p, const char *end, int64_t *exponent)
{
    const int64_t large = INT64_C(1) << 60;
    p++;
    bool negative = p < end && *p == '-';
    if (p < end && (*p == '-' || *p == '+')) {
        p++;
    }
    if (p == end || !is_digit(*p)) {
        return NULL;
    }
    int64_t value = 0;
    for (; p < end && is_digit(*p); p++) {
        value = value < large / 16 ? value * 10 + (*p - '0') : large;
    }
    *exponent += negative ? -value : value;
    return p;
}

he_status he_double_parse(const char *begin, const char *end, he_grammar grammar, double *value,
                          size_t *used)
{
    static const double tens[23] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                    1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const char *p = begin;
    bool negative = p < end && *p == '-';
    if (negative || (grammar == HE_FILE_NUMBER && p < end && *p == '+')) {
        p++;
    }
    const char *first = p;
    uint64_t w = 0;
    p = read_digits(p, end, &w);
    size_t whole = (size_t)(p - first), digits = whole;
    int64_t exponent = 0;
    if (grammar == HE_JSON_NUMBER && (whole == 0 || (whole > 1 && *first == '0'))) {
        return HE_SYNTAX;
    }
    if (p < end && *p == '.') {
        const char *fraction = ++p;
        p = read_digits(p, end, &w);
        digits += (size_t)(p - fraction);
        exponent = fraction - p;
        if (p == fraction && grammar == HE_JSON_NUMBER) {
            return HE_SYNTAX;
        }
        if (p == fraction && whole == 1 && w == 1 && p < end && *p == '#') {
            while (p < end && *p != ' ' && *p != '\t' && *p != '\r' && *p != '\n') {
                p++;
            }
            *used = (size_t)(p - begin);
            return HE_NOT_FINITE;
        }
    }
    if (digits == 0) {
        size_t length = grammar == HE_FILE_NUMBER && p == first ? word_length(p, end) : 0;
        if (length == 0) {
            return HE_SYNTAX;
        }
        *used = (size_t)(p - begin) + length;
        return HE_NOT_FINITE;
    }
    const char *mantissa_end = p;
    int64_t written = 0;
    if (p < end && (*p | 0x20) == 'e') {
        p = read_exponent(p, end, &written);
        if (p == NULL) {
            return HE_SYNTAX;
        }
    }
    exponent += written;

    double result;
    if (digits <= 19 && w >> 53 == 0 && exponent >= -22 && exponent <= 22) {
        /* Both operands are exact, so the result of the single operation is rounded once, which is
         * correct. */
        result = (double)w;
        result = exponent < 0 ? result / tens[-exponent] : result * tens[exponent];
    } else {
        uint64_t bits = 0;
        bool decided = true;
        if (digits > 19) {
            bits = nearest_to_many(first, mantissa_end, exponent);
        } else if (w != 0) {
            bits = nearest(w, exponent, &decided);
        }
        if (!decided) {
            bits = he_decimal_exact_round(first, mantissa_end, exponent, bits);
        }
        *used = (size_t)(p - begin);
        if (bits == INFINITY_BITS) {
            return HE_NOT_FINITE;
        }
        memcpy(&result, &bits, sizeof result);
    }
    *used = (size_t)(p - begin);
    *value = negative ? -result : result;
    return HE_OK;
}

he_status he_u64_parse(const char *begin, const char *end, uint64_t *value, size_t *used)
{
    if (end - begin >= 8) { /* most indices have fewer than eight digits */
        uint64_t word;
        memcpy(&word, begin, 8);
        size_t count = few_digits(word, value);
        if (count > 0) {
            *used = count;
            return HE_OK;
        }
    }
    const char *p = begin;
    uint64_t v = 0;
    bool fits = true;
    for (; p < end && is_digit(*p); p++) {
        uint64_t digit = (uint64_t)(*p - '0');
        fits = fits && !__builtin_mul_overflow(v, 10, &v) && !__builtin_add_overflow(v, digit, &v);
    }
    if (p == begin) {
        return HE_SYNTAX;
    }
    *used = (size_t)(p - begin);
    if (!fits) {
        return HE_BAD_VALUE;
    }
    *value = v;
    return HE_OK;
}

he_status he_i64_parse(const char *begin, const char *end, int64_t *value, size_t *used)
{
    bool negative = begin < end && *begin == '-';
    uint64_t size;
    size_t length;
    he_status status = he_u64_parse(begin + negative, end, &size, &length);
    if (status == HE_SYNTAX) {
        return status;
    }
    *used = length + negative;
    if (status != HE_OK || size > (uint64_t)INT64_MAX + negative) {
        return HE_BAD_VALUE;
    }
    *value = negative ? (int64_t)(0 - size) : (int64_t)size;
    return HE_OK;
}
