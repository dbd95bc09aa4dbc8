#include "api/json/text.h"

#include "base/mem.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The first size of a text. The answer about one element fits into it, so the buffer rarely has to
 * grow. */
enum { FIRST_BYTES = 512 };

void api_text_clear(api_text *text)
{
    he_mem_free(text->bytes);
    *text = (api_text){0};
}

void api_text_empty(api_text *text)
{
    text->length = 0;
    text->failed = false;
}

char *api_text_room(api_text *text, size_t size)
{
    size_t need;
    if (text->failed || __builtin_add_overflow(text->length, size, &need) ||
        (text->maximum != 0 && need > text->maximum)) {
        text->failed = true;
        return NULL;
    }
    if (need > text->capacity) {
        size_t capacity = he_mem_grown(text->capacity, need);
        capacity = capacity < FIRST_BYTES ? FIRST_BYTES : capacity;
        if (text->maximum != 0 && capacity > text->maximum) {
            capacity = text->maximum;
        }
        char *bytes = he_mem_resize(text->bytes, capacity);
        if (bytes == NULL) {
            text->failed = true;
            return NULL;
        }
        text->bytes = bytes;
        text->capacity = capacity;
    }
    return text->bytes + text->length;
}

void api_text_add(api_text *text, const char *bytes, size_t length)
{
    if (length == 0) {
        return;
    }
    char *room = api_text_room(text, length);
    if (room != NULL) {
        memcpy(room, bytes, length);
        text->length += length;
    }
}

void api_text_add_string(api_text *text, const char *string)
{
    api_text_add(text, string, strlen(string));
}

void api_text_add_format(api_text *text, const char *format, ...)
{
    char few[256];
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(few, sizeof few, format, arguments);
    if (length < 0) {
        text->failed = true;
    } else if ((size_t)length < sizeof few) {
        api_text_add(text, few, (size_t)length);
    } else {
        char *room = api_text_room(text, (size_t)length + 1);
        if (room != NULL) {
            vsnprintf(room, (size_t)length + 1, format, again);
            text->length += (size_t)length;
        }
    }
    va_end(again);
    va_end(arguments);
}

void api_text_add_html(api_text *text, const char *string)
{
    for (const char *c = string; *c != '\0'; c++) {
        switch (*c) {
        case '&':
            api_text_add_string(text, "&amp;");
            break;
        case '<':
            api_text_add_string(text, "&lt;");
            break;
        case '>':
            api_text_add_string(text, "&gt;");
            break;
        case '"':
            api_text_add_string(text, "&quot;");
            break;
        case '\'':
            api_text_add_string(text, "&#39;");
            break;
        default:
            api_text_add_char(text, *c);
        }
    }
}
