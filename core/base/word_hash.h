/* word_hash.h - the hash of a word, for the tables of ids (query/idmap.h, delta.c,
 * edit/merge/merge_plan.c). */
#ifndef HE_BASE_WORD_HASH_H
#define HE_BASE_WORD_HASH_H

#include <stdint.h>

/* Knuth's multiplicative hashing, TAOCP 6.4: the high bits of a product with 2^64 / phi; of two,
 * with the seed in between. Whoever chooses the words does not know that, and so cannot choose some
 * that all want the same slots. The address of the table will do. The high bits are the good ones.
 */
static inline uint64_t he_word_hash(uint64_t seed, uint64_t word)
{
    const uint64_t phi = UINT64_C(0x9E3779B97F4A7C15);
    uint64_t h = word * phi;
    h = ((h ^ h >> 32) + seed) * phi;
    return (h ^ h >> 32) * phi;
}

#endif
