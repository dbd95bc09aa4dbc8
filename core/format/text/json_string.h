/* json_string.h - the strings of JSON in the text they stand in, for whoever scans it. */
#ifndef HE_FORMAT_TEXT_JSON_STRING_H
#define HE_FORMAT_TEXT_JSON_STRING_H

#include <stdbool.h>

/* Pass over a string, from behind its opening quote on, in parts of at most some HE_JSON_PART
 * bytes; *closed is true when *at has come behind its closing quote. NULL, or what RFC 8259 or we
 * have against what stands at *at: an escape it does not have, half a surrogate pair, a null or
 * control character, other bytes than UTF-8. */
enum { HE_JSON_PART = 1 << 16 };
const char *he_json_string_part(const char **at, const char *end, bool *closed);
/* Four hexadecimal digits, or -1. */
int he_json_hex(const char *at, const char *end);

#endif
