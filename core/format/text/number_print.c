#include "format/text/number.h"

#include "format/text/pow5.h"

#include <string.h>

static const char pairs[201] = "00010203040506070809101112131415161718192021222324"
                               "25262728293031323334353637383940414243444546474849"
                               "50515253545556575859606162636465666768697071727374"
                               "75767778798081828384858687888990919293949596979899";

static size_t digit_count(uint64_t value)
{
    static const uint64_t tens[20] = {
        0,
        10,
        100,
        1000,
        10000,
        100000,
        1000000,
        10000000,
        100000000,
        1000000000,
        10000000000,
        100000000000,
        1000000000000,
        10000000000000,
        100000000000000,
        1000000000000000,
        10000000000000000,
        100000000000000000,
        1000000000000000000,
        10000000000000000000u,
    };
    /* The fraction 1233 / 4096 is slightly more than log10(2). */
    unsigned guess = (64u - (unsigned)__builtin_clzll(value | 1)) * 1233u >> 12;
    return guess + (value >= tens[guess]);
}

static void write_eight(uint32_t value, char *text)
{
    uint32_t high = value / 10000, low = value % 10000;
    memcpy(text, pairs + high / 100 * 2, 2);
    memcpy(text + 2, pairs + high % 100 * 2, 2);
    memcpy(text + 4, pairs + low / 100 * 2, 2);
    memcpy(text + 6, pairs + low % 100 * 2, 2);
}

/* Writes the value with exactly `count` decimal digits, which must be enough. */
static void write_digits(uint64_t value, size_t count, char *text)
{
    while (count >= 8) {
        write_eight((uint32_t)(value % 100000000), text + count - 8);
        value /= 100000000;
        count -= 8;
    }
    uint32_t rest = (uint32_t)value;
    while (count >= 2) {
        memcpy(text + count - 2, pairs + rest % 100 * 2, 2);
        rest /= 100;
        count -= 2;
    }
    if (count == 1) {
        text[0] = (char)('0' + rest);
    }
}

size_t he_u64_print(uint64_t value, char *text)
{
    size_t count = digit_count(value);
    write_digits(value, count, text);
    return count;
}

size_t he_u32_print(uint32_t value, char *text)
{
    size_t count = digit_count(value);
    uint32_t rest = value;
    size_t left = count;
    while (left >= 2) {
        memcpy(text + left - 2, pairs + rest % 100 * 2, 2);
        rest /= 100;
        left -= 2;
    }
    if (left == 1) {
        text[0] = (char)('0' + rest);
    }
    return count;
}

size_t he_i64_print(int64_t value, char *text)
{
    if (value >= 0) {
        return he_u64_print((uint64_t)value, text);
    }
    text[0] = '-';
    return 1 + he_u64_print(0 - (uint64_t)value, text + 1);
}

/* digits * 10^exponent */
typedef struct decimal {
    uint64_t digits;
    int exponent;
} decimal;

/* Returns the top 64 bits of the product of a 64-bit and a 128-bit number. The last bit is set if
 * anything was cut off, so that comparing with even numbers stays exact (Schubfach, section
 * 9.6). */
static uint64_t scale(he_pow5 g, uint64_t value)
{
    he_u128 low = (he_u128)g.low * value;
    he_u128 high = (he_u128)g.high * value + (uint64_t)(low >> 64);
    return (uint64_t)(high >> 64) | ((uint64_t)high > 1);
}

/* Finds the shortest decimal inside the rounding interval of c * 2^q, c > 0, and among several the
 * closest one. `narrow` says that the next lower number is only half as far away as the next higher
 * one. Names are those of the paper on Schubfach (number.h): vb is four times the value in units of
 * 10^k, `lower` and `upper` are the ends of the interval on that scale. */
static decimal shortest(uint64_t c, int q, int narrow)
{
    int k = narrow ? (q * 1262611 - 524031) >> 22 : (q * 1262611) >> 22; /* log10, floor */
    int h = q + he_floor_log2_of_ten(-k) + 1;
    he_pow5 g = he_pow5_get(-k);
    if (-k < 0 || -k > 55) { /* the power is not exact, and the paper needs it rounded up */
        g.low++;
        g.high += g.low == 0;
    }
    uint64_t odd = c & 1;
    uint64_t vb = scale(g, 4 * c << h);
    uint64_t lower = scale(g, (4 * c - (narrow ? 1 : 2)) << h) + odd;
    uint64_t upper = scale(g, (4 * c + 2) << h) - odd;

    uint64_t s = vb >> 2;
    uint64_t tens = s / 10;
    int below = lower <= 40 * tens;
    int above = 40 * tens + 40 <= upper;
    if (below != above) {
        return (decimal){tens + (uint64_t)above, k + 1};
    }
    below = lower <= 4 * s;
    above = 4 * s + 4 <= upper;
    if (below != above) {
        return (decimal){s + (uint64_t)above, k};
    }
    uint64_t middle = 4 * s + 2;
    return (decimal){s + (vb > middle || (vb == middle && (s & 1) != 0)), k};
}

static decimal without_trailing_zeros(decimal d)
{
    if (d.digits % 100000000 == 0) {
        d.digits /= 100000000;
        d.exponent += 8;
    }
    while (d.digits % 10 == 0) {
        d.digits /= 10;
        d.exponent++;
    }
    return d;
}

static size_t write_decimal(decimal value, char *text)
{
    decimal d = without_trailing_zeros(value);
    size_t count = digit_count(d.digits);
    int point = (int)count + d.exponent; /* digits before the decimal point */
    if (point > 0 && point <= 21) {
        if (d.exponent >= 0) {
            write_digits(d.digits, count, text);
            memset(text + count, '0', (size_t)d.exponent);
            return (size_t)point;
        }
        write_digits(d.digits, count, text + 1);
        memmove(text, text + 1, (size_t)point);
        text[point] = '.';
        return count + 1;
    }
    if (point <= 0 && point > -6) {
        size_t start = 2 + (size_t)-point;
        memset(text, '0', start);
        text[1] = '.';
        write_digits(d.digits, count, text + start);
        return start + count;
    }
    write_digits(d.digits, count, text + 1);
    text[0] = text[1];
    size_t length = 1;
    if (count > 1) {
        text[1] = '.';
        length = count + 1;
    }
    text[length++] = 'e';
    return length + he_i64_print(point - 1, text + length);
}

size_t he_double_print(double value, char *text)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    size_t sign = bits >> 63;
    text[0] = '-';
    text += sign;
    uint64_t fraction = bits & (((uint64_t)1 << 52) - 1);
    int exponent = (int)(bits >> 52 & 0x7FF);
    if (exponent < 1023 + 53) {
        double size = sign ? -value : value;
        uint64_t whole = (uint64_t)size;
        if ((double)whole == size) {
            return sign + he_u64_print(whole, text);
        }
    }
    decimal d = exponent == 0 ? shortest(fraction, -1074, 0)
                              : shortest(fraction | (uint64_t)1 << 52, exponent - 1075,
                                         fraction == 0 && exponent > 1);
    return sign + write_decimal(d, text);
}

size_t he_float_print(float value, char *text)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    size_t sign = bits >> 31;
    text[0] = '-';
    text += sign;
    uint32_t fraction = bits & ((UINT32_C(1) << 23) - 1);
    int exponent = (int)(bits >> 23 & 0xFF);
    if (exponent < 127 + 24) {
        float size = sign ? -value : value;
        uint32_t whole = (uint32_t)size;
        if ((float)whole == size) {
            return sign + he_u32_print(whole, text);
        }
    }
    decimal d = exponent == 0 ? shortest(fraction, -149, 0)
                              : shortest(fraction | UINT32_C(1) << 23, exponent - 150,
                                         fraction == 0 && exponent > 1);
    return sign + write_decimal(d, text);
}
