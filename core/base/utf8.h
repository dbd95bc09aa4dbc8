/* utf8.h - decides whether bytes are UTF-8 by RFC 3629: no overlong forms, no surrogates, nothing
 * beyond U+10FFFF. */
#ifndef HE_BASE_UTF8_H
#define HE_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the number of bytes of the character that begins at `bytes`, or 0 if no valid one begins
 * there. `length` is above 0. */
size_t he_utf8_character(const char *bytes, size_t length);
bool he_is_utf8(const char *bytes, size_t length);
/* Makes a numbered name: writes NAME for number 1, else NAME_2 and so on, to `out`. `size` is the
 * size of `out`, at least 16; a name that does not fit is cut between two characters. */
void he_name_number(const char *name, unsigned number, char *out, size_t size);

#endif
