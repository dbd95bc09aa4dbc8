/* text.h - a buffer of bytes that grows by appending.
 *
 * Failure is sticky: when memory is out or `maximum` would be exceeded, `failed` is set and all
 * later writes are ignored, so that the caller checks only once, at the end. {0} is an empty text
 * without a maximum. */
#ifndef HE_API_JSON_TEXT_H
#define HE_API_JSON_TEXT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct api_text {
    char *bytes; /* not terminated by NUL */
    size_t length, capacity;
    size_t maximum; /* 0: no maximum */
    bool failed;
} api_text;

/* Borrowed bytes, which belong to another object; they are not terminated by NUL. */
typedef struct api_bytes {
    const char *at;
    size_t length;
} api_bytes;

/* Borrows the bytes of a text until it changes. */
static inline api_bytes api_text_bytes(const api_text *text)
{
    return (api_bytes){text->bytes, text->length};
}

void api_text_clear(api_text *text); /* frees the bytes and sets the text to {0} */
/* Makes the text empty and clears `failed`; the text keeps its memory and its maximum. */
void api_text_empty(api_text *text);

/* Returns space for `size` more bytes, at text->bytes + text->length. The caller writes there and
 * adds the number of bytes written to text->length. Returns NULL and sets `failed` when memory is
 * out or the maximum would be exceeded. */
char *api_text_room(api_text *text, size_t size);
void api_text_add(api_text *text, const char *bytes, size_t length);
void api_text_add_string(api_text *text, const char *string);
void api_text_add_format(api_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static inline void api_text_add_char(api_text *text, char c)
{
    if (text->length < text->capacity && !text->failed) {
        text->bytes[text->length++] = c;
    } else {
        api_text_add(text, &c, 1);
    }
}
/* Appends a string to an HTML page, with & < > " ' escaped. */
void api_text_add_html(api_text *text, const char *string);

#endif
