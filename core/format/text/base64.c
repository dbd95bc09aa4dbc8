#include "format/text/base64.h"

#include <stdint.h>

size_t he_base64_room(size_t length)
{
    return length / 4 * 3 + 3;
}

static int value_of(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
                                  : -1;
}

bool he_base64_decode(const char *text, size_t length, unsigned char *to, size_t *decoded)
{
    if (length % 4 == 0) {
        for (int i = 0; i < 2 && length > 0 && text[length - 1] == '='; i++) {
            length--;
        }
    }
    uint32_t bits = 0;
    unsigned held = 0;
    size_t n = 0;
    for (size_t i = 0; i < length; i++) {
        int value = value_of(text[i]);
        if (value < 0) {
            return false;
        }
        bits = bits << 6 | (uint32_t)value;
        held += 6;
        if (held >= 8) {
            held -= 8;
            to[n++] = (unsigned char)(bits >> held);
        }
    }
    *decoded = n;
    /* A single character after the last group of four encodes no byte, and the bits that fill no
     * byte must be zero. */
    return length % 4 != 1 && (bits & ((1u << held) - 1)) == 0;
}
