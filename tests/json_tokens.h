/* json_tokens.h - what the lexer of JSON makes of a text, whole or in pieces, as a line to compare.
 */
#ifndef TESTS_JSON_TOKENS_H
#define TESTS_JSON_TOKENS_H

#include "format/text/json_lexer.h"

enum { JSON_TOKENS_TOLD = 1 << 14 };

/* The tokens: "{" and "[" for brackets that open, "." for one that closes, "name:", "s" for a
 * string, numbers with their length, words; as many as `told` holds, zero-terminated. Then how it
 * ended. */
typedef struct json_tokens {
    char told[JSON_TOKENS_TOLD];
    size_t length;
    he_token last; /* HE_TOKEN_CUT: the text came in pieces, and ends within the value */
    he_fault fault;
    uint64_t place; /* of the fault; 0 without one */
} json_tokens;

void json_tokens_of_text(json_tokens *t, const char *text, size_t length);
/* Cut before each byte whose bit is set in `cuts`, which serves again every 64 bytes. */
void json_tokens_of_pieces(json_tokens *t, const char *text, size_t length, uint64_t cuts);
/* Adds one more piece; it is copied to memory of its own size, so that AddressSanitizer sees a read
 * beyond it. */
void json_tokens_of_piece(json_tokens *t, he_lexer *x, const char *piece, size_t length);

/* Is the text the same in pieces? Where these end within the value, the whole text has a fault;
 * else both have the same fault at the same place, or none. */
bool json_tokens_agree(const json_tokens *whole, const json_tokens *pieces);

#endif
