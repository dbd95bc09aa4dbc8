/* json_string.h - the characters of JSON strings, as written in a text. */
#ifndef HE_FORMAT_TEXT_JSON_STRING_H
#define HE_FORMAT_TEXT_JSON_STRING_H

#include <stdbool.h>
#include <stddef.h>

/* Returns how many bytes the character at `at` < `end` takes in the text, an escape or UTF-8, at
 * most HE_JSON_CHARACTER. Returns 0 if it is refused: an unknown escape, half a surrogate pair, a
 * null or control character, or bytes that are not UTF-8. Then `*wrong` says why, and `*cut`
 * whether bytes after `end` could complete it to a character. */
enum { HE_JSON_CHARACTER = 12 };
size_t he_json_character(const char *at, const char *end, const char **wrong, bool *cut);

/* Decodes the character at *at of a string that was checked, and moves *at after it. Returns the
 * length of its UTF-8, at most 4; 0, without moving, at the closing quote. */
size_t he_json_decode(const char **at, char to[4]);

/* Does a string that was checked begin with `text`? Its bytes run from *at to `end` or to its
 * closing quote. If it does, *at moves after that beginning. */
bool he_json_text_begins(const char **at, const char *end, const char *text);
/* Are these bytes, which were checked and have no quotes, the string `text`? */
bool he_json_text_is(const char *at, size_t length, const char *text);

#endif
