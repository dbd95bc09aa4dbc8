/* json_bytes.h - skips the blanks between the tokens of JSON, and decides which bytes a number may
 * contain. */
#ifndef HE_FORMAT_TEXT_JSON_BYTES_H
#define HE_FORMAT_TEXT_JSON_BYTES_H

#include <stdbool.h>

/* Returns the first byte from `at` on that is not a blank; `end` if all of them are blanks. */
static inline const char *he_json_skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) {
        at++;
    }
    return at;
}

static inline bool he_json_is_number_byte(char c)
{
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E';
}

#endif
