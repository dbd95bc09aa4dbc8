#include "base/utf8.h"

#include <stdio.h>
#include <string.h>

size_t he_utf8_character(const char *bytes, size_t length)
{
    const unsigned char *b = (const unsigned char *)bytes;
    if (b[0] < 0x80) {
        return 1;
    }
    size_t size = b[0] < 0xC2 ? 0 : b[0] < 0xE0 ? 2 : b[0] < 0xF0 ? 3 : b[0] < 0xF5 ? 4 : 0;
    if (size == 0 || size > length) {
        return 0;
    }
    for (size_t i = 1; i < size; i++) {
        if ((b[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    bool overlong = (b[0] == 0xE0 && b[1] < 0xA0) || (b[0] == 0xF0 && b[1] < 0x90);
    bool surrogate = b[0] == 0xED && b[1] >= 0xA0;
    bool beyond = b[0] == 0xF4 && b[1] >= 0x90;
    return overlong || surrogate || beyond ? 0 : size;
}

bool he_is_utf8(const char *bytes, size_t length)
{
    for (size_t i = 0; i < length;) {
        size_t size = he_utf8_character(bytes + i, length - i);
        if (size == 0) {
            return false;
        }
        i += size;
    }
    return true;
}

void he_name_number(const char *name, unsigned number, char *out, size_t size)
{
    char digits[16] = "";
    if (number > 1) {
        snprintf(digits, sizeof digits, "_%u", number);
    }
    size_t length = strlen(name), most = size - 1 - strlen(digits);
    length = length < most ? length : most;
    while (name[length] != '\0' && ((unsigned char)name[length] & 0xC0) == 0x80) {
        length--;
    }
    memcpy(out, name, length);
    memcpy(out + length, digits, strlen(digits) + 1);
}
