/* word_hash.h - the hash of a 64-bit word, for hash tables of ids (query/idmap.h, delta.c,
 * edit/merge/merge_plan.c). */
#ifndef HE_BASE_WORD_HASH_H
#define HE_BASE_WORD_HASH_H

#include <stdint.h>

/* Hashes a word by Knuth's multiplicative method (TAOCP 6.4): the word is multiplied twice by 2^64
 * / phi, and a seed is added in between. A client that chooses the words does not know the seed, so
 * it cannot choose words that all fall into the same slots of a table. The address of the hash
 * table is a sufficient seed. Callers take the high bits of the hash, which are mixed best. */
static inline uint64_t he_word_hash(uint64_t seed, uint64_t word)
{
    const uint64_t phi = UINT64_C(0x9E3779B97F4A7C15);
    uint64_t h = word * phi;
    h = ((h ^ h >> 32) + seed) * phi;
    return (h ^ h >> 32) * phi;
}

#endif
