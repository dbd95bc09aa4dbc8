#include "format/text/json_string.h"

#include "base/utf8.h"

#include <string.h>

/* Returns the value of `count` hexadecimal digits; -1 if one of the bytes is no digit. */
static int hex(const char *at, size_t count)
{
    int value = 0;
    for (size_t i = 0; i < count; i++) {
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

/* Reads the second half of a surrogate pair, "\uDC00" to "\uDFFF", and returns its length. */
static size_t pass_low_half(const char *at, const char *end, bool *cut)
{
    size_t there = end - at < 6 ? (size_t)(end - at) : 6;
    bool escape = memcmp(at, "\\u", there < 2 ? there : 2) == 0;
    int unit = escape && there > 2 ? hex(at + 2, there - 2) : 0;
    *cut = escape && there < 6 && unit >= 0;
    return there == 6 && escape && unit >= 0xDC00 && unit <= 0xDFFF ? 6 : 0;
}

/* Reads an escape, which begins with the backslash at `at`, and returns its length. */
static size_t pass_escape(const char *at, const char *end, const char **wrong, bool *cut)
{
    size_t there = (size_t)(end - at);
    if (there == 1) {
        *cut = true;
        *wrong = "the string does not end";
        return 0;
    }
    if (at[1] != 'u') {
        *wrong = "JSON has no such escape sequence";
        return at[1] != '\0' && strchr("\"\\/bfnrt", at[1]) != NULL ? 2 : 0;
    }
    int unit = hex(at + 2, there < 6 ? there - 2 : 4);
    if (there < 6 || unit < 0) {
        *cut = unit >= 0;
        *wrong = "\\u needs four hexadecimal digits";
        return 0;
    }
    if (unit == 0) {
        *wrong = "a string must not contain a null character";
        return 0;
    }
    if (unit < 0xD800 || unit > 0xDFFF) {
        return 6;
    }
    *wrong = "half of a surrogate pair is missing";
    return unit < 0xDC00 && pass_low_half(at + 6, end, cut) > 0 ? 12 : 0;
}

/* Returns true if these bytes, which are no whole character, could be the beginning of one. Whether
 * the second byte fits the first is only tested when all bytes are there. */
static bool begins_character(const unsigned char *bytes, size_t length)
{
    size_t size = bytes[0] < 0xC2   ? 0
                  : bytes[0] < 0xE0 ? 2
                  : bytes[0] < 0xF0 ? 3
                  : bytes[0] < 0xF5 ? 4
                                    : 0;
    size_t i = 1;
    while (i < length && (bytes[i] & 0xC0) == 0x80) {
        i++;
    }
    return length < size && i == length;
}

size_t he_json_character(const char *at, const char *end, const char **wrong, bool *cut)
{
    unsigned char c = (unsigned char)*at;
    *cut = false;
    if (c == '\\') {
        return pass_escape(at, end, wrong, cut);
    }
    if (c < 0x20) {
        *wrong = "a control character in a string must be escaped";
        return 0;
    }
    size_t size = he_utf8_character(at, (size_t)(end - at));
    if (size == 0) {
        *wrong = "the string is not UTF-8";
        *cut = begins_character((const unsigned char *)at, (size_t)(end - at));
    }
    return size;
}

static size_t put_character(unsigned code, char *to)
{
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    size_t size = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    static const unsigned lead[] = {0, 0, 0xC0, 0xE0, 0xF0};
    for (size_t i = size - 1; i > 0; i--, code >>= 6) {
        to[i] = (char)(0x80 | (code & 0x3F));
    }
    to[0] = (char)(lead[size] | code);
    return size;
}

size_t he_json_decode(const char **at, char to[4])
{
    static const char escapes[] = "\"\\/bfnrt", meanings[] = "\"\\/\b\f\n\r\t";
    const char *p = *at;
    if (*p == '"') {
        return 0;
    }
    if (*p != '\\') {
        unsigned char c = (unsigned char)*p;
        size_t size = c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
        memcpy(to, p, size);
        *at = p + size;
        return size;
    }
    if (p[1] != 'u') {
        *to = meanings[strchr(escapes, p[1]) - escapes];
        *at = p + 2;
        return 1;
    }
    unsigned code = (unsigned)hex(p + 2, 4);
    *at = p + 6;
    if (code >= 0xD800 && code <= 0xDFFF) {
        code = 0x10000 + ((code - 0xD800) << 10) + ((unsigned)hex(p + 8, 4) - 0xDC00);
        *at = p + 12;
    }
    return put_character(code, to);
}

bool he_json_text_begins(const char **at, const char *end, const char *text)
{
    const char *p = *at;
    char bytes[4];
    while (*text != '\0') {
        size_t size = p < end ? he_json_decode(&p, bytes) : 0;
        for (size_t i = 0; i < size; i++) {
            if (*text == '\0' || bytes[i] != *text++) {
                return false;
            }
        }
        if (size == 0) {
            return false;
        }
    }
    *at = p;
    return true;
}

bool he_json_text_is(const char *at, size_t length, const char *text)
{
    const char *end = at + length;
    return he_json_text_begins(&at, end, text) && at == end;
}
