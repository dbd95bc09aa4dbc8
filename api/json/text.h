/* text.h - bytes that grow at the end.
 *
 * Failure is sticky: once memory was out or `maximum` would have been passed, `failed` is set, all
 * that follows is ignored, and only the end has to look. {0} is an empty text without a maximum. */
#ifndef HE_API_JSON_TEXT_H
#define HE_API_JSON_TEXT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct api_text {
    char *bytes; /* not ended by NUL */
    size_t length, capacity;
    size_t maximum; /* 0: none */
    bool failed;
} api_text;

void api_text_clear(api_text *text); /* frees; {0} again */
void api_text_empty(api_text *text); /* keeps memory and maximum, forgets content and failure */

/* Room for `size` more bytes at text->bytes + text->length, or NULL (and failed). The caller
 * writes there and adds what it wrote to text->length. */
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
/* As text of an HTML page: & < > " ' are escaped. */
void api_text_add_html(api_text *text, const char *string);

#endif
