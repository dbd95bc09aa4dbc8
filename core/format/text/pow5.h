/* pow5.h - the leading 128 bits of the powers of five, which number_print.c and number_parse.c
 * need.
 *
 * 10^k and 5^k have the same leading bits, so one table serves both. It has every 27th power of
 * five with 192 bits; multiplying such a power by one of 5^0 to 5^26, which are exact, gives the
 * powers in between. tests/unit/test_number.c compares all powers with big integers, which shows
 * that the 128 bits are the floor of the true value for every k. */
#ifndef HE_FORMAT_TEXT_POW5_H
#define HE_FORMAT_TEXT_POW5_H

#include <stdint.h>

__extension__ typedef unsigned __int128 he_u128;

enum { HE_POW5_MIN = -342, HE_POW5_MAX = 324, HE_POW5_STEP = 27 };

/* A power of five: floor(5^k * 2^s), where s is such that the top bit of `high` is set. */
typedef struct he_pow5 {
    uint64_t high, low;
} he_pow5;

extern const uint64_t he_pow5_coarse[26][3]; /* 5^(27 * (i - 13)) */
extern const uint64_t he_pow5_fine[HE_POW5_STEP];

static inline he_pow5 he_pow5_get(int k)
{
    unsigned shifted = (unsigned)(k + 13 * HE_POW5_STEP);
    const uint64_t *coarse = he_pow5_coarse[shifted / HE_POW5_STEP];
    uint64_t fine = he_pow5_fine[shifted % HE_POW5_STEP];
    he_u128 high = (he_u128)coarse[0] * fine;
    he_u128 middle = (he_u128)coarse[1] * fine + (uint64_t)((he_u128)coarse[2] * fine >> 64);
    /* The product has at most 253 bits, in the three words top, next and last. */
    high += (uint64_t)(middle >> 64);
    uint64_t top = (uint64_t)(high >> 64), next = (uint64_t)high, last = (uint64_t)middle;
    if (top == 0) { /* the wanted power is in the table itself: it need not be multiplied */
        return (he_pow5){next, last};
    }
    int zeros = __builtin_clzll(top);
    if (zeros == 0) {
        return (he_pow5){top, next};
    }
    return (he_pow5){top << zeros | next >> (64 - zeros), next << zeros | last >> (64 - zeros)};
}

/* Returns floor(log2(10^k)), which is exact for |k| <= 1233. The constant is 2^19 * log2(10),
 * rounded down. */
static inline int he_floor_log2_of_ten(int k)
{
    return (k * 1741647) >> 19;
}

#endif
