/* utf8.h - is this UTF-8? RFC 3629: no overlong forms, no surrogates, nothing beyond U+10FFFF. */
#ifndef HE_BASE_UTF8_H
#define HE_BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of the character that begins at `bytes`, 0 where there is none. `length` > 0. */
size_t he_utf8_character(const char *bytes, size_t length);
bool he_is_utf8(const char *bytes, size_t length);
/* NAME for number 1, else NAME_2 and so on, in `size` bytes, its NUL included: the name is cut
 * where that is too long, between letters. `size` is 16 at least. */
void he_name_number(const char *name, unsigned number, char *out, size_t size);

#endif
