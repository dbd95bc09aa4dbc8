/* siphash.h - a keyed hash of 128 bits: SipHash-2-4-128.
 *
 * J.-P. Aumasson and D. J. Bernstein, "SipHash: a fast short-input PRF" (INDOCRYPT 2012), in the
 * authors' variant with 128 bits of output. An attacker who does not know the key can neither
 * foresee where a hash table puts a name nor construct two request bodies with equal hashes.
 *
 * Use:
 *
 *     he_siphash h;
 *     he_siphash_begin(&h, key);
 *     he_siphash_add(&h, bytes, length);     any number of times
 *     he_siphash_end(&h, out);
 *
 * The hash depends only on the bytes, not on how they are distributed over the calls of
 * he_siphash_add. */
#ifndef HE_BASE_SIPHASH_H
#define HE_BASE_SIPHASH_H

#include <stddef.h>
#include <stdint.h>

typedef struct he_siphash {
    uint64_t v[4];
    unsigned char tail[8]; /* the last bytes added, those that do not yet fill a word of 8 bytes */
    uint64_t length;
} he_siphash;

void he_siphash_begin(he_siphash *hash, const uint64_t key[2]);
void he_siphash_add(he_siphash *hash, const void *bytes, size_t length);
void he_siphash_end(he_siphash *hash, uint64_t out[2]);

/* Returns the first 64 bits of the hash of one block of bytes, for hash tables. */
uint64_t he_siphash_of(const uint64_t key[2], const void *bytes, size_t length);

#endif
