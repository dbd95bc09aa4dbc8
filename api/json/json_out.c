#include "api/json/json_out.h"

#include "api/json/packed.h"

#include "base/utf8.h"
#include "format/text/number.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void api_out_init(api_out *out, api_text *text)
{
    *out = (api_out){.text = text};
}

static inline bool in_object(const api_out *out)
{
    return (out->objects >> out->depth & 1) != 0;
}

/* Writes the comma that must come before the next value or key, if this level has a value
 * already. */
static void separate(api_out *out)
{
    uint64_t bit = (uint64_t)1 << out->depth;
    if (out->filled & bit) {
        api_text_add_char(out->text, ',');
    }
    out->filled |= bit;
}

static void begin_value(api_out *out)
{
    if (out->keyed) {
        out->keyed = false;
        return;
    }
    assert(!in_object(out));
    if (out->depth > 0) {
        separate(out);
    }
}

static void open(api_out *out, char bracket, bool object)
{
    begin_value(out);
    api_text_add_char(out->text, bracket);
    assert(out->depth < API_OUT_DEPTH);
    out->depth++;
    uint64_t bit = (uint64_t)1 << out->depth;
    out->filled &= ~bit;
    out->objects = object ? out->objects | bit : out->objects & ~bit;
}

static void close(api_out *out, char bracket, bool object)
{
    assert(out->depth > 0 && in_object(out) == object && !out->keyed);
    (void)object;
    out->depth--;
    api_text_add_char(out->text, bracket);
}

void api_out_object_begin(api_out *out)
{
    open(out, '{', true);
}
void api_out_object_end(api_out *out)
{
    close(out, '}', true);
}
void api_out_array_begin(api_out *out)
{
    open(out, '[', false);
}
void api_out_array_end(api_out *out)
{
    close(out, ']', false);
}

static void add_escape(api_text *text, unsigned char c)
{
    static const char digits[] = "0123456789abcdef";
    char escape[6] = {'\\', 'u', '0', '0', digits[c >> 4], digits[c & 15]};
    switch (c) {
    case '"':
    case '\\':
        escape[1] = (char)c;
        break;
    case '\b':
        escape[1] = 'b';
        break;
    case '\f':
        escape[1] = 'f';
        break;
    case '\n':
        escape[1] = 'n';
        break;
    case '\r':
        escape[1] = 'r';
        break;
    case '\t':
        escape[1] = 't';
        break;
    default:
        break;
    }
    api_text_add(text, escape, escape[1] == 'u' ? 6 : 2);
}

static void add_string(api_text *text, const char *bytes, size_t length)
{
    api_text_add_char(text, '"');
    size_t plain = 0; /* start of the bytes that need no escaping and are not copied yet */
    for (size_t i = 0; i < length;) {
        unsigned char c = (unsigned char)bytes[i];
        if (c >= 0x20 && c < 0x80 && c != '"' && c != '\\' && c != 0x7F) {
            i++;
            continue;
        }
        size_t size = c < 0x80 ? 0 : he_utf8_character(bytes + i, length - i);
        if (size > 0) {
            i += size;
            continue;
        }
        api_text_add(text, bytes + plain, i - plain);
        if (c < 0x80) {
            add_escape(text, c);
        } else {
            api_text_add_string(text, "\xEF\xBF\xBD");
        }
        plain = ++i;
    }
    api_text_add(text, bytes + plain, length - plain);
    api_text_add_char(text, '"');
}

void api_out_key(api_out *out, const char *key)
{
    assert(in_object(out) && !out->keyed);
    separate(out);
    add_string(out->text, key, strlen(key));
    api_text_add_char(out->text, ':');
    out->keyed = true;
}

void api_out_null(api_out *out)
{
    begin_value(out);
    api_text_add(out->text, "null", 4);
}

void api_out_bool(api_out *out, bool value)
{
    begin_value(out);
    api_text_add_string(out->text, value ? "true" : "false");
}

void api_out_u64(api_out *out, uint64_t value)
{
    begin_value(out);
    char *room = api_text_room(out->text, HE_NUMBER_TEXT);
    if (room != NULL) {
        out->text->length += he_u64_print(value, room);
    }
}

size_t api_out_later(api_out *out)
{
    begin_value(out);
    size_t at = out->text->length;
    char *room = api_text_room(out->text, HE_NUMBER_TEXT);
    if (room != NULL) {
        memset(room, ' ', HE_NUMBER_TEXT);
        out->text->length += HE_NUMBER_TEXT;
    }
    return at;
}

void api_out_fill(api_text *text, size_t at, uint64_t value)
{
    assert(!text->failed && at + HE_NUMBER_TEXT <= text->length);
    size_t end = at + HE_NUMBER_TEXT, used = he_u64_print(value, text->bytes + at);
    memmove(text->bytes + at + used, text->bytes + end, text->length - end);
    text->length -= HE_NUMBER_TEXT - used;
}

void api_out_i64(api_out *out, int64_t value)
{
    begin_value(out);
    char *room = api_text_room(out->text, HE_NUMBER_TEXT);
    if (room != NULL) {
        out->text->length += he_i64_print(value, room);
    }
}

void api_out_number(api_out *out, double value)
{
    if (!isfinite(value)) {
        api_out_null(out);
        return;
    }
    begin_value(out);
    char *room = api_text_room(out->text, HE_NUMBER_TEXT);
    if (room != NULL) {
        out->text->length += he_double_print(value, room);
    }
}

void api_out_string(api_out *out, const char *string)
{
    api_out_string_length(out, string, strlen(string));
}

void api_out_string_length(api_out *out, const char *bytes, size_t length)
{
    begin_value(out);
    add_string(out->text, bytes, length);
}

void api_out_id(api_out *out, uint32_t id)
{
    if (id == HE_NONE) {
        api_out_null(out);
        return;
    }
    begin_value(out);
    char *room = api_text_room(out->text, HE_NUMBER_TEXT);
    if (room != NULL) {
        out->text->length += he_u32_print(id, room);
    }
}

/* The number of ids for which space in the output is reserved at once, and the most bytes that one
 * id takes with its comma. */
enum { IDS_AT_ONCE = 256, ID_TEXT = 11 };

/* Returns false if writing must stop: memory is out or the work was cancelled. In both cases the
 * text is marked as failed, because the caller drops the text of a cancelled request anyway. */
static bool goes_on(api_out *out)
{
    he_error err = {0};
    /* Progress is reported only once for many parts of IDS_AT_ONCE ids, because a report costs as
     * much as writing a short list, and each operation may write a list. */
    bool looks = ++out->parts % (HE_PROGRESS_STRIDE / IDS_AT_ONCE) == 0;
    if (looks && he_progress_step(out->progress, 0, 1, &err) != HE_OK) {
        out->text->failed = true;
    }
    return !out->text->failed;
}

/* Writes a reference to an array that is added beside the JSON. */
static void write_array(api_out *out, uint32_t type, uint32_t width, const void *numbers,
                        size_t count)
{
    const size_t number = api_packed_add(out->arrays, type, width, numbers, count);
    api_out_object_begin(out);
    api_out_key_u64(out, "array", number);
    api_out_object_end(out);
}

void api_out_ids(api_out *out, const uint32_t *ids, size_t count)
{
    if (out->arrays != NULL) {
        write_array(out, API_PACKED_U32, 1, ids, count);
        return;
    }
    begin_value(out);
    api_text *text = out->text;
    api_text_add_char(text, '[');
    for (size_t i = 0; i < count;) {
        if (!goes_on(out)) {
            return;
        }
        size_t stop = count - i > IDS_AT_ONCE ? i + IDS_AT_ONCE : count;
        char *room = api_text_room(text, (stop - i) * ID_TEXT + HE_NUMBER_TEXT);
        if (room == NULL) {
            return;
        }
        char *at = room;
        for (; i < stop; i++) {
            if (i > 0) {
                *at++ = ',';
            }
            if (ids[i] == HE_NONE) {
                memcpy(at, "null", 4);
                at += 4;
            } else {
                at += he_u32_print(ids[i], at);
            }
        }
        text->length += (size_t)(at - room);
    }
    api_text_add_char(text, ']');
}

void api_out_pairs(api_out *out, const uint32_t *ids, size_t count)
{
    assert(count % 2 == 0);
    if (out->arrays != NULL) {
        write_array(out, API_PACKED_U32, 2, ids, count / 2);
        return;
    }
    api_out_array_begin(out);
    for (size_t i = 0; i < count && goes_on(out); i += 2) {
        api_out_ids(out, ids + i, 2);
    }
    api_out_array_end(out);
}

void api_out_id_lists(api_out *out, const uint32_t *ids, const uint32_t *ends, size_t lists)
{
    if (out->arrays != NULL) {
        api_out_object_begin(out);
        api_out_key_ids(out, "ids", ids, lists == 0 ? 0 : ends[lists - 1]);
        api_out_key_ids(out, "ends", ends, lists);
        api_out_object_end(out);
        return;
    }
    api_out_array_begin(out);
    for (size_t i = 0, from = 0; i < lists && goes_on(out); i++) {
        api_out_ids(out, ids + from, ends[i] - from);
        from = ends[i];
    }
    api_out_array_end(out);
}

void api_out_numbers(api_out *out, const double *numbers, size_t count)
{
    if (out->arrays != NULL) {
        write_array(out, API_PACKED_F64, 1, numbers, count);
        return;
    }
    api_out_array_begin(out);
    for (size_t i = 0; i < count; i++) {
        api_out_number(out, numbers[i]);
    }
    api_out_array_end(out);
}

void api_out_vec3(api_out *out, he_vec3 value)
{
    api_out_array_begin(out);
    api_out_number(out, value.x);
    api_out_number(out, value.y);
    api_out_number(out, value.z);
    api_out_array_end(out);
}

/* Computes the Gregorian date of a day counted from 1970-01-01. The computation counts eras of 400
 * years from 1 March of year 0, so that a leap day is the last day of its year. */
static void date_of(int64_t day, int64_t *year, int *month, int *date)
{
    day += 719468;
    int64_t era = (day >= 0 ? day : day - 146096) / 146097;
    int64_t in_era = day - era * 146097;
    int64_t in_year = (in_era - in_era / 1460 + in_era / 36524 - in_era / 146096) / 365;
    int64_t left = in_era - (365 * in_year + in_year / 4 - in_year / 100);
    int64_t from_march = (5 * left + 2) / 153;
    *date = (int)(left - (153 * from_march + 2) / 5 + 1);
    *month = (int)(from_march < 10 ? from_march + 3 : from_march - 9);
    *year = in_year + era * 400 + (*month <= 2);
}

void api_out_time(api_out *out, double seconds)
{
    /* Only years with four digits can be written in this form of ISO 8601. */
    if (!(seconds > -62167219200.0 && seconds < 253402300799.0)) {
        api_out_null(out);
        return;
    }
    int64_t milliseconds = (int64_t)floor(seconds * 1000.0);
    int64_t day = milliseconds / 86400000, left = milliseconds % 86400000;
    if (left < 0) {
        left += 86400000;
        day--;
    }
    int64_t year;
    int month, date;
    date_of(day, &year, &month, &date);
    begin_value(out);
    api_text_add_format(out->text, "\"%04d-%02d-%02dT%02d:%02d:%02d.%03dZ\"", (int)year, month,
                        date, (int)(left / 3600000), (int)(left / 60000 % 60),
                        (int)(left / 1000 % 60), (int)(left % 1000));
}

void api_out_raw(api_out *out, const char *json, size_t length)
{
    begin_value(out);
    api_text_add(out->text, json, length);
}

void api_out_key_bool(api_out *out, const char *key, bool value)
{
    api_out_key(out, key);
    api_out_bool(out, value);
}

void api_out_key_u64(api_out *out, const char *key, uint64_t value)
{
    api_out_key(out, key);
    api_out_u64(out, value);
}

void api_out_key_number(api_out *out, const char *key, double value)
{
    api_out_key(out, key);
    api_out_number(out, value);
}

void api_out_key_string(api_out *out, const char *key, const char *string)
{
    api_out_key(out, key);
    api_out_string(out, string);
}

void api_out_key_id(api_out *out, const char *key, uint32_t id)
{
    api_out_key(out, key);
    api_out_id(out, id);
}

void api_out_key_ids(api_out *out, const char *key, const uint32_t *ids, size_t count)
{
    api_out_key(out, key);
    api_out_ids(out, ids, count);
}

void api_out_key_vec3(api_out *out, const char *key, he_vec3 value)
{
    api_out_key(out, key);
    api_out_vec3(out, value);
}

void api_out_key_null(api_out *out, const char *key)
{
    api_out_key(out, key);
    api_out_null(out);
}
