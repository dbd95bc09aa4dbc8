#include "api/json/seen_text.h"

#include <stdbool.h>

/* Returns the character that begins at `at` in a text of UTF-8, if it is one that a name must not
 * have; otherwise 0. */
static unsigned unseen_at(const unsigned char *at)
{
    if (at[0] < 0x20 || at[0] == 0x7f) {
        return at[0];
    }
    if (at[0] == 0xc2 && at[1] < 0xa0) {
        return at[1];
    }
    if (at[0] == 0xe2 && (at[1] == 0x80 || at[1] == 0x81)) {
        const unsigned code = 0x2000 | (at[1] & 0x3fU) << 6 | (at[2] & 0x3fU);
        /* U+2028 and U+2029 end lines; the others turn the direction of the text after them. */
        const bool controls =
            (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
        return controls ? code : 0;
    }
    return 0;
}

unsigned api_unseen_character(const char *text)
{
    unsigned code = 0;
    for (const char *at = text; *at != '\0' && code == 0; at++) {
        code = unseen_at((const unsigned char *)at);
    }
    return code;
}
