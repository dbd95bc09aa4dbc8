/* hash.h - a keyed hash of 128 bits: SipHash-2-4-128.
 *
 * J.-P. Aumasson and D. J. Bernstein, "SipHash: a fast short-input PRF" (INDOCRYPT 2012), with the
 * doubled output of its authors. Who does not know the key can neither foresee where a name falls
 * in a table nor make two bodies that agree.
 *
 *     api_hash h;
 *     api_hash_begin(&h, key);
 *     api_hash_add(&h, bytes, length);  any number of times; only the bytes count, not the cuts
 *     api_hash_end(&h, out); */
#ifndef HE_API_HEADER_HASH_H
#define HE_API_HEADER_HASH_H

#include <stddef.h>
#include <stdint.h>

typedef struct api_hash {
    uint64_t v[4];
    unsigned char tail[8]; /* of the word that is not yet whole */
    uint64_t length;
} api_hash;

void api_hash_begin(api_hash *hash, const uint64_t key[2]);
void api_hash_add(api_hash *hash, const void *bytes, size_t length);
void api_hash_end(api_hash *hash, uint64_t out[2]);

/* All at once, the first half of it: for tables. */
uint64_t api_hash_of(const uint64_t key[2], const void *bytes, size_t length);

#endif
