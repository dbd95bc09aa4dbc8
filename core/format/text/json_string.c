#include "format/text/json_string.h"

#include "base/utf8.h"

#include <stddef.h>
#include <string.h>

int he_json_hex(const char *at, const char *end)
{
    if (end - at < 4) {
        return -1;
    }
    int value = 0;
    for (int i = 0; i < 4; i++) {
        char c = at[i];
        int digit = c >= '0' && c <= '9'   ? c - '0'
                    : c >= 'a' && c <= 'f' ? c - 'a' + 10
                    : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                           : -1;
        if (digit < 0) {
            return -1;
        }
        value = value * 16 + digit;
    }
    return value;
}

/* From the backslash at *at on. */
static const char *pass_escape(const char **at, const char *end)
{
    const char *p = *at + 1;
    if (p == end) {
        return "the string does not end";
    }
    if (*p != 'u') {
        if (*p == '\0' || strchr("\"\\/bfnrt", *p) == NULL) {
            return "the escape is not one of JSON's";
        }
        *at = p + 1;
        return NULL;
    }
    int unit = he_json_hex(p + 1, end);
    if (unit < 0) {
        return "\\u needs four hexadecimal digits";
    }
    if (unit == 0) {
        return "a null character is not taken in strings";
    }
    p += 5;
    if (unit >= 0xD800 && unit <= 0xDFFF) {
        bool pair = unit < 0xDC00 && end - p >= 6 && p[0] == '\\' && p[1] == 'u';
        int low = pair ? he_json_hex(p + 2, end) : -1;
        if (low < 0xDC00 || low > 0xDFFF) {
            return "a surrogate stands alone";
        }
        p += 6;
    }
    *at = p;
    return NULL;
}

const char *he_json_string_part(const char **at, const char *end, bool *closed)
{
    const char *p = *at, *stop = end - p > HE_JSON_PART ? p + HE_JSON_PART : end;
    const char *wrong = NULL;
    *closed = false;
    while (p < stop && wrong == NULL) {
        unsigned char c = (unsigned char)*p;
        if (c == '"') {
            *at = p + 1;
            *closed = true;
            return NULL;
        }
        if (c == '\\') {
            wrong = pass_escape(&p, end);
        } else if (c < 0x20) {
            wrong = "a control character stands raw in a string";
        } else if (c < 0x80) {
            p++;
        } else {
            size_t size = he_utf8_character(p, (size_t)(end - p));
            wrong = size == 0 ? "the string is not UTF-8" : NULL;
            p += size;
        }
    }
    *at = p;
    return wrong == NULL && p == end ? "the string does not end" : wrong;
}
