/* json_string.h - the characters of JSON's strings, as they stand in a text. */
#ifndef HE_FORMAT_TEXT_JSON_STRING_H
#define HE_FORMAT_TEXT_JSON_STRING_H

#include <stdbool.h>
#include <stddef.h>

/* Returns how many bytes the character at `at` < `end` has in the text, an escape or UTF-8, at most
 * HE_JSON_CHARACTER. Returns 0 where RFC 8259 or we refuse what stands there: an escape it does not
 * have, half a surrogate pair, a null or control character, other bytes than UTF-8. Then `*wrong`
 * says why, and `*cut` whether bytes after `end` could make it a character. */
enum { HE_JSON_CHARACTER = 12 };
size_t he_json_character(const char *at, const char *end, const char **wrong, bool *cut);

/* Decodes the character at *at of a string that was checked, and moves *at behind it. Returns the
 * length of its UTF-8, at most 4; 0, and nothing moves, at the closing quote. */
size_t he_json_decode(const char **at, char to[4]);

/* Does a string that was checked begin with `text`? Its bytes stand from *at to `end` or to its
 * closing quote; where it does, *at moves behind what begins it. */
bool he_json_text_begins(const char **at, const char *end, const char *text);
/* Are these bytes, which were checked and have no quotes, the string `text`? */
bool he_json_text_is(const char *at, size_t length, const char *text);

#endif
