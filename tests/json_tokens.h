/* json_tokens.h - the tokens that the JSON lexer finds in a text, given whole or in pieces, as a
 * line of text that can be compared. */
#ifndef TESTS_JSON_TOKENS_H
#define TESTS_JSON_TOKENS_H

#include "format/text/json_lexer.h"

enum { JSON_TOKENS_TOLD = 1 << 14 };

/* The tokens of a text: "{" and "[" for opening brackets, "." for a closing one, "name:", "s" for a
 * string, numbers with their length, words; at most as many as `told` has room for. The end is
 * NUL-terminated and says how the text ended. */
typedef struct json_tokens {
    char told[JSON_TOKENS_TOLD];
    size_t length;
    he_token last; /* HE_TOKEN_CUT: the text came in pieces, and ends inside a value */
    he_fault fault;
    uint64_t place; /* of the fault; 0 without one */
} json_tokens;

void json_tokens_of_text(json_tokens *t, const char *text, size_t length);
/* Cuts the text before each byte whose bit is set in `cuts`; the 64 bits are used again and
 * again. */
void json_tokens_of_pieces(json_tokens *t, const char *text, size_t length, uint64_t cuts);
/* Adds one more piece; it is copied to memory of its own size, so that AddressSanitizer sees a read
 * beyond it. */
void json_tokens_of_piece(json_tokens *t, he_lexer *x, const char *piece, size_t length);

/* Returns whether the text had the same tokens in pieces. If the pieces end inside a value,
 * the whole text must have a fault; otherwise both must have the same fault at the same
 * place, or none. */
bool json_tokens_agree(const json_tokens *whole, const json_tokens *pieces);

#endif
