/* The JSON lexer: wherever a text is cut into pieces, it must have the same tokens and the same
 * fault at the same byte. */
#include "fuzz/fuzz.h"

#include "json_tokens.h"

#include <string.h>

/* Numbers and names longer than this are refused only in a text that comes in pieces, so longer
 * inputs are cut off here. */
enum { MOST = HE_JSON_NAMES };

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static json_tokens whole, pieces;
    char text[MOST + 1];
    size = size < MOST ? size : MOST;
    memcpy(text, bytes, size);
    /* Without the line feed, a number at the end of a piece could go on in the next piece. */
    text[size++] = '\n';

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
