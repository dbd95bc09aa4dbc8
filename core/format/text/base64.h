/* base64.h - the base 64 encoding of RFC 4648, with or without the padding at its end. */
#ifndef HE_FORMAT_TEXT_BASE64_H
#define HE_FORMAT_TEXT_BASE64_H

#include <stdbool.h>
#include <stddef.h>

/* Returns the most bytes that a text of this length can give when decoded. */
size_t he_base64_room(size_t length);
/* Decodes a text to `to`, which must have the room that he_base64_room returns. Returns false if
 * the text is no base 64. */
bool he_base64_decode(const char *text, size_t length, unsigned char *to, size_t *decoded);

#endif
