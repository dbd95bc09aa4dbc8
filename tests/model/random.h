/* random.h - random numbers from a seed (the splitmix64 sequence of Steele, Lea and Flood, "Fast
 * splittable pseudorandom number generators", 2014). */
#ifndef TESTS_MODEL_RANDOM_H
#define TESTS_MODEL_RANDOM_H

#include <stdbool.h>
#include <stdint.h>

typedef struct md_random {
    uint64_t state;
} md_random;

static inline uint64_t md_bits(md_random *r)
{
    uint64_t z = r->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Returns a random number from 0 to n - 1; n must not be 0. */
static inline uint32_t md_below(md_random *r, uint32_t n)
{
    return (uint32_t)((md_bits(r) >> 32) * n >> 32);
}

static inline uint32_t md_from(md_random *r, uint32_t low, uint32_t high)
{
    return low + md_below(r, high - low + 1);
}

/* Returns true with a probability of `percent` in a hundred. */
static inline bool md_chance(md_random *r, uint32_t percent)
{
    return md_below(r, 100) < percent;
}

/* Returns a random number x with 0 <= x < 1. */
static inline double md_unit(md_random *r)
{
    return (double)(md_bits(r) >> 11) * 0x1p-53;
}

#endif
