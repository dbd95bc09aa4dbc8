/* text_hash.h - the hash of a string, for hash tables of strings (labels.c,
 * format/text/json_parse.c). */
#ifndef HE_BASE_TEXT_HASH_H
#define HE_BASE_TEXT_HASH_H

#include <stddef.h>
#include <stdint.h>

/* Hashes a string, together with a seed, by FNV-1a with a final mixing step. Strings come from
 * files, so an attacker may choose them; as he does not know the seed, he cannot choose many
 * strings whose hashes collide and so make searches in the table slow. The address of the hash
 * table is a sufficient seed. */
static inline uint64_t he_text_hash(uint64_t seed, const char *text, size_t length)
{
    uint64_t h = seed * 0x9E3779B97F4A7C15;
    for (size_t i = 0; i < length; i++) {
        h = (h ^ (unsigned char)text[i]) * 0x100000001B3;
        h ^= h >> 29;
    }
    return h * 0xBF58476D1CE4E5B9 >> 20;
}

#endif
