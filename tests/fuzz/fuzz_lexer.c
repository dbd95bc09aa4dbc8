/* The lexer of JSON: a text is the same text wherever its pieces are cut, and what is wrong with it
 * is wrong at one of its bytes. */
#include "fuzz/fuzz.h"

#include "json_tokens.h"

#include <string.h>

/* Longer numbers and names are refused in texts that come in pieces alone. */
enum { MOST = HE_JSON_NAMES };

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static json_tokens whole, pieces;
    char text[MOST + 1];
    size = size < MOST ? size : MOST;
    memcpy(text, bytes, size);
    text[size++] = '\n'; /* a number ends where something else follows */

    json_tokens_of_text(&whole, text, size);
    FUZZ_REQUIRE(whole.last == HE_TOKEN_END || whole.last == HE_TOKEN_FAULT, "it has no end");
    FUZZ_REQUIRE(whole.place <= size, "a fault is beyond the text");
    const uint64_t cuts[] = {UINT64_MAX, fuzz_hash(bytes, size - 1)};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        json_tokens_of_pieces(&pieces, text, size, cuts[i]);
        FUZZ_REQUIRE(json_tokens_agree(&whole, &pieces), "cut by %016llx it is another text",
                     (unsigned long long)cuts[i]);
    }
}
