/* json_tokens.h - writes the tokens that the JSON lexer finds in a text, given whole or in pieces,
 * as one line that tests can compare. */
#ifndef TESTS_JSON_TOKENS_H
#define TESTS_JSON_TOKENS_H

#include "format/text/json_lexer.h"

enum { JSON_TOKENS_TOLD = 1 << 14 };

/* The tokens of a text. `told` lists them: "{" and "[" for opening brackets, "." for a closing
 * bracket, "name:" for a member, "s" for a string, numbers as their length, and the words true,
 * false and null; then how the text ended. Tokens that do not fit into `told` are left out. */
typedef struct json_tokens {
    char told[JSON_TOKENS_TOLD];
    size_t length;
    he_token last; /* last token; HE_TOKEN_CUT if the text came in pieces that end inside a value */
    he_fault fault;
    uint64_t place; /* byte position of the lexer's fault in the text; 0 if there is none */
} json_tokens;

void json_tokens_of_text(json_tokens *t, const char *text, size_t length);
/* Reads the text in pieces: it is cut before each byte whose bit is set in `cuts`. Each further 64
 * bytes use the same 64 bits again. */
void json_tokens_of_pieces(json_tokens *t, const char *text, size_t length, uint64_t cuts);
/* Reads one more piece. The piece is first copied to a block of exactly its size, so that
 * AddressSanitizer notices a read beyond it. */
void json_tokens_of_piece(json_tokens *t, he_lexer *x, const char *piece, size_t length);

/* Returns whether a text gave the same tokens whole and in pieces. If the pieces end inside a
 * value, the whole text must have a fault; otherwise both readings must find the same fault at the
 * same position, or none. */
bool json_tokens_agree(const json_tokens *whole, const json_tokens *pieces);

#endif
