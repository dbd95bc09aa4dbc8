#include "format/text/json.h"

#include "format/text/json_string.h"
#include "format/text/number.h"
#include "format/text/warnings.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

char he_json_type(const he_json *json, uint32_t value)
{
    if (value == HE_NONE) {
        return '\0';
    }
    char c = json->text[json->values[value].at];
    return c == '-' || (c >= '0' && c <= '9') ? '0' : c;
}

void he_json_clear(he_json *json)
{
    he_mem_free(json->values);
    *json = (he_json){0};
}

static bool is_list(const he_json *json, uint32_t value)
{
    char type = he_json_type(json, value);
    return type == '{' || type == '[';
}

uint32_t he_json_first(const he_json *json, uint32_t list)
{
    return is_list(json, list) && json->values[list].next > list + 1 ? list + 1 : HE_NONE;
}

uint32_t he_json_after(const he_json *json, uint32_t list, uint32_t item)
{
    bool object = he_json_type(json, list) == '{';
    uint32_t next = json->values[object ? he_json_of(item) : item].next;
    return next < json->values[list].next ? next : HE_NONE;
}

size_t he_json_span(const he_json *json, uint32_t value)
{
    return value == HE_NONE ? 0 : json->values[value].next - value;
}

uint64_t he_json_place(const he_json *json, uint32_t value)
{
    return json->offset + (value == HE_NONE ? 0 : json->values[value].at);
}

uint32_t he_json_find(const he_json *json, uint32_t object, const char *name)
{
    if (he_json_type(json, object) != '{') {
        return HE_NONE;
    }
    for (uint32_t i = he_json_first(json, object); i != HE_NONE;
         i = he_json_after(json, object, i)) {
        if (he_json_is(json, i, name)) {
            return he_json_of(i);
        }
    }
    return HE_NONE;
}

/* --- strings --- */

/* Returns true if the string begins with `text`. `*whole` says whether the string has nothing
 * after `text`. */
static bool compare(const he_json *json, uint32_t value, const char *text, bool *whole)
{
    if (he_json_type(json, value) != '"') {
        return false;
    }
    const char *p = json->text + json->values[value].at + 1;
    if (!he_json_text_begins(&p, json->text + json->length, text)) {
        return false;
    }
    *whole = *p == '"';
    return true;
}

bool he_json_is(const he_json *json, uint32_t value, const char *text)
{
    bool whole = false;
    return compare(json, value, text, &whole) && whole;
}

bool he_json_begins(const he_json *json, uint32_t value, const char *text)
{
    bool whole;
    return compare(json, value, text, &whole);
}

size_t he_json_string(const he_json *json, uint32_t value, char *to, size_t size)
{
    size_t length = 0, n;
    if (he_json_type(json, value) == '"') {
        const char *p = json->text + json->values[value].at + 1;
        char bytes[4];
        while ((n = he_json_decode(&p, bytes)) > 0 && length + n < size) {
            memcpy(to + length, bytes, n);
            length += n;
        }
    }
    to[length] = '\0';
    return length;
}

const char *he_json_raw(const he_json *json, uint32_t value, size_t *length)
{
    const char *begin = json->text + json->values[value].at + 1, *p = begin;
    while (*p != '"') {
        p += *p == '\\' ? 2 : 1;
    }
    *length = (size_t)(p - begin);
    return begin;
}

/* --- numbers --- */

static double number_at(const he_json *json, uint32_t value)
{
    const char *p = json->text + json->values[value].at;
    double number = 0;
    size_t used;
    he_status status =
        he_double_parse(p, json->text + json->length, HE_JSON_NUMBER, &number, &used);
    return status == HE_OK ? number : 0; /* it was checked before */
}

he_status he_json_number(const he_json *json, uint32_t value, double *out, he_error *err)
{
    if (he_json_type(json, value) != '0') {
        return he_json_fail(json, value, err, HE_BAD_VALUE, "the value is not a number");
    }
    *out = number_at(json, value);
    return HE_OK;
}

he_status he_json_whole(const he_json *json, uint32_t value, uint64_t least, uint64_t most,
                        uint64_t *out, he_error *err)
{
    double number = he_json_type(json, value) == '0' ? number_at(json, value) : (double)NAN;
    if (!(number >= (double)least && number <= (double)most && number == floor(number))) {
        char text[40];
        const char *p = json->text + json->values[value].at, *end = p;
        while (end < json->text + json->length && end - p < 39 &&
               strchr(",]} \t\r\n", *end) == NULL) {
            end++;
        }
        he_quote(p, end, text, sizeof text);
        return he_json_fail(json, value, err, HE_BAD_VALUE,
                            "%s is not a whole number from %llu to %llu", text,
                            (unsigned long long)least, (unsigned long long)most);
    }
    *out = (uint64_t)number;
    return HE_OK;
}

/* --- errors --- */

void he_json_path(const he_json *json, uint32_t value, char *to, size_t size)
{
    size_t length = 0;
    to[0] = '\0';
    uint32_t list = 0;
    while (list != value) {
        bool object = he_json_type(json, list) == '{';
        uint32_t item = he_json_first(json, list), index = 0, found;
        while (item != HE_NONE) {
            found = object ? he_json_of(item) : item;
            if (value == item || (value >= found && value < json->values[found].next)) {
                break;
            }
            item = he_json_after(json, list, item);
            index++;
        }
        if (item == HE_NONE) {
            return; /* the value sought is not inside value `list` */
        }
        char name[40], part[60];
        if (object) {
            char text[40];
            size_t n = he_json_string(json, item, text, sizeof text);
            he_quote(text, text + n, name, sizeof name);
        }
        int n = object ? snprintf(part, sizeof part, "%s%s", length > 0 ? "/" : "", name)
                       : snprintf(part, sizeof part, "%s%u", length > 0 ? "/" : "", index);
        if (n < 0 || length + (size_t)n >= size) {
            return;
        }
        memcpy(to + length, part, (size_t)n + 1);
        length += (size_t)n;
        if (value == item) {
            return;
        }
        list = object ? he_json_of(item) : item;
    }
}

he_status he_json_fail(const he_json *json, uint32_t value, he_error *err, he_status status,
                       const char *format, ...)
{
    char path[HE_JSON_PATH] = "", text[HE_ERROR_TEXT];
    va_list arguments;
    if (err == NULL) {
        return status;
    }
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (value != HE_NONE) {
        he_json_path(json, value, path, sizeof path);
    }
    return he_fail_at(err, status, HE_PLACE_BYTE, he_json_place(json, value), "%s%s%s", path,
                      path[0] != '\0' ? ": " : "", text);
}
