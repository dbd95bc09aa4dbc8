#include "format/text/decimal_exact.h"

#include "format/text/pow5.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

/* A non-negative integer, least significant word first, without leading zero words. The largest
 * integers that are needed are a number of 801 digits times a power of two, and a number of 54 bits
 * times 5^1146: both have fewer than 4096 bits. */
enum { BIG_WORDS = 66 };

typedef struct big {
    size_t count;
    uint64_t words[BIG_WORDS];
} big;

/* The first 768 digits decide between any two doubles; of further digits it only matters whether
 * all are zero. So KEPT_DIGITS digits are read, and one more that stands for the rest. */
enum { KEPT_DIGITS = 800 };

static void multiply_add(big *n, uint64_t factor, uint64_t add)
{
    uint64_t carry = add;
    for (size_t i = 0; i < n->count; i++) {
        he_u128 product = (he_u128)n->words[i] * factor + carry;
        n->words[i] = (uint64_t)product;
        carry = (uint64_t)(product >> 64);
    }
    if (carry != 0) {
        assert(n->count < BIG_WORDS);
        n->words[n->count++] = carry;
    }
}

static void multiply_power_of_five(big *n, int64_t power)
{
    while (power >= HE_POW5_STEP) {
        multiply_add(n, he_pow5_fine[HE_POW5_STEP - 1], 0);
        power -= HE_POW5_STEP - 1;
    }
    multiply_add(n, he_pow5_fine[power], 0);
}

static void shift_left(big *n, int64_t bits)
{
    size_t whole = (size_t)bits / 64;
    unsigned part = (unsigned)bits % 64;
    assert(n->count + whole + 1 <= BIG_WORDS);
    multiply_add(n, (uint64_t)1 << part, 0);
    memmove(n->words + whole, n->words, n->count * sizeof n->words[0]);
    memset(n->words, 0, whole * sizeof n->words[0]);
    n->count += whole;
}

static int compare(const big *a, const big *b)
{
    if (a->count != b->count) {
        return a->count < b->count ? -1 : 1;
    }
    for (size_t i = a->count; i-- > 0;) {
        if (a->words[i] != b->words[i]) {
            return a->words[i] < b->words[i] ? -1 : 1;
        }
    }
    return 0;
}

/* Reads digits into a big integer; `*exponent` is corrected for the digits that were cut off. */
static void read_digits(big *n, const char *digits, const char *end, int64_t *exponent)
{
    size_t kept = 0, dropped = 0;
    int rest = 0;
    n->count = 0;
    for (const char *p = digits; p < end; p++) {
        if (*p == '.' || (kept == 0 && *p == '0')) {
            continue;
        }
        if (kept < KEPT_DIGITS) {
            multiply_add(n, 10, (uint64_t)(*p - '0'));
            kept++;
        } else {
            rest |= *p != '0';
            dropped++;
        }
    }
    *exponent += (int64_t)dropped;
    if (rest) {
        multiply_add(n, 10, 1);
        *exponent -= 1;
    }
}

/* Compares digits * 10^exponent with the number half-way between the doubles whose bits are `bits`
 * and `bits` + 1. */
static int compare_with_middle(const big *digits, int64_t exponent, uint64_t bits)
{
    uint64_t mantissa = bits & (((uint64_t)1 << 52) - 1);
    int64_t power = -1074;
    if (bits >> 52 != 0) {
        mantissa |= (uint64_t)1 << 52;
        power = (int64_t)(bits >> 52) - 1075;
    }
    power--;
    big left = *digits;
    big right = {1, {2 * mantissa + 1}};
    if (exponent >= 0) {
        multiply_power_of_five(&left, exponent);
    } else {
        multiply_power_of_five(&right, -exponent);
    }
    if (exponent >= power) {
        shift_left(&left, exponent - power);
    } else {
        shift_left(&right, power - exponent);
    }
    return compare(&left, &right);
}

uint64_t he_decimal_exact_round(const char *digits, const char *end, int64_t exponent,
                                uint64_t guess)
{
    const uint64_t infinity = (uint64_t)0x7FF << 52;
    big n;
    read_digits(&n, digits, end, &exponent);
    uint64_t bits = guess < infinity ? guess : infinity - 1;
    int order;
    while ((order = compare_with_middle(&n, exponent, bits)) > 0) {
        if (++bits == infinity) {
            return infinity;
        }
    }
    if (order == 0) {
        return bits + (bits & 1);
    }
    while (bits > 0 && (order = compare_with_middle(&n, exponent, bits - 1)) <= 0) {
        if (order == 0) {
            return bits - (bits & 1);
        }
        bits--;
    }
    return bits;
}
