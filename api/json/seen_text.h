/* seen_text.h - finds characters that a name must not have, because they control how text is shown:
 * a name with them can look like another one, or like more than a name. */
#ifndef HE_API_JSON_SEEN_TEXT_H
#define HE_API_JSON_SEEN_TEXT_H

/* Returns the first character of a text of UTF-8 that is a control character (U+0001 to U+001F,
 * U+007F to U+009F) or changes the direction of the text after it (U+202A to U+202E, U+2066 to
 * U+2069); 0 if the text has none. */
unsigned api_unseen_character(const char *text);

#endif
