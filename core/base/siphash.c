#include "base/siphash.h"

#include <string.h>

enum { WORD = 8, ROUNDS = 2, LAST_ROUNDS = 4 };

static uint64_t turn(uint64_t word, unsigned bits)
{
    return word << bits | word >> (64 - bits);
}

static void mix(uint64_t v[4], int rounds)
{
    for (int i = 0; i < rounds; i++) {
        v[0] += v[1];
        v[2] += v[3];
        v[1] = turn(v[1], 13) ^ v[0];
        v[3] = turn(v[3], 16) ^ v[2];
        v[0] = turn(v[0], 32);
        v[2] += v[1];
        v[0] += v[3];
        v[1] = turn(v[1], 17) ^ v[2];
        v[3] = turn(v[3], 21) ^ v[0];
        v[2] = turn(v[2], 32);
    }
}

static void add_word(he_siphash *hash, const unsigned char *bytes)
{
    uint64_t word = 0;
    for (unsigned i = 0; i < WORD; i++) {
        word |= (uint64_t)bytes[i] << 8 * i;
    }
    hash->v[3] ^= word;
    mix(hash->v, ROUNDS);
    hash->v[0] ^= word;
}

void he_siphash_begin(he_siphash *hash, const uint64_t key[2])
{
    *hash = (he_siphash){
        .v = {key[0] ^ UINT64_C(0x736f6d6570736575), key[1] ^ UINT64_C(0x646f72616e646f6d) ^ 0xee,
              key[0] ^ UINT64_C(0x6c7967656e657261), key[1] ^ UINT64_C(0x7465646279746573)}};
}

void he_siphash_add(he_siphash *hash, const void *bytes, size_t length)
{
    const unsigned char *at = bytes;
    while (length > 0) {
        size_t used = hash->length % WORD;
        if (used == 0 && length >= WORD) {
            add_word(hash, at);
            at += WORD;
            length -= WORD;
            hash->length += WORD;
            continue;
        }
        hash->tail[used] = *at++;
        length--;
        hash->length++;
        if (used + 1 == WORD) {
            add_word(hash, hash->tail);
        }
    }
}

static uint64_t folded(const uint64_t v[4])
{
    return v[0] ^ v[1] ^ v[2] ^ v[3];
}

void he_siphash_end(he_siphash *hash, uint64_t out[2])
{
    size_t used = hash->length % WORD;
    memset(hash->tail + used, 0, WORD - used);
    hash->tail[WORD - 1] = (unsigned char)hash->length;
    add_word(hash, hash->tail);
    hash->v[2] ^= 0xee;
    mix(hash->v, LAST_ROUNDS);
    out[0] = folded(hash->v);
    hash->v[1] ^= 0xdd;
    mix(hash->v, LAST_ROUNDS);
    out[1] = folded(hash->v);
}

uint64_t he_siphash_of(const uint64_t key[2], const void *bytes, size_t length)
{
    uint64_t out[2];
    he_siphash hash;
    he_siphash_begin(&hash, key);
    he_siphash_add(&hash, bytes, length);
    he_siphash_end(&hash, out);
    return out[0];
}
