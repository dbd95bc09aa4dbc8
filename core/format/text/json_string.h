/* json_string.h - the characters of JSON strings as they stand in a text, with their escapes. */
#ifndef HE_FORMAT_TEXT_JSON_STRING_H
#define HE_FORMAT_TEXT_JSON_STRING_H

#include <stdbool.h>
#include <stddef.h>

/* Returns how many bytes the character at `at` < `end`, an escape or UTF-8, takes in the text:
 * at most HE_JSON_CHARACTER. Returns 0 if it is refused: an unknown escape, half a surrogate
 * pair, a null or control character, or bytes that are not UTF-8. In that case *wrong says why,
 * and *cut says whether more bytes after `end` could complete the character. */
enum { HE_JSON_CHARACTER = 12 };
size_t he_json_character(const char *at, const char *end, const char **wrong, bool *cut);

/* Decodes the character at *at in a string that was checked before, and moves *at behind it.
 * Returns the length of the character in UTF-8, at most 4; 0 at the closing quote, from which
 * *at is not moved. */
size_t he_json_decode(const char **at, char to[4]);

/* Returns true if a string that was checked before begins with `text`, and then moves *at behind
 * that beginning. The bytes of the string run from *at to `end` or to its closing quote. */
bool he_json_text_begins(const char **at, const char *end, const char *text);
/* Returns true if a string equals `text`. The `length` bytes at `at` are the string as it stands in
 * the JSON text, without its quotes; they must have been checked before. */
bool he_json_text_is(const char *at, size_t length, const char *text);

#endif
