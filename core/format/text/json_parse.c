/* he_json_parse of json.h. */
#include "format/text/json.h"

#include "base/text_hash.h"
#include "format/text/json_string.h"
#include "format/text/notes.h"
#include "format/text/number.h"

#include <string.h>

/* Bytes between two looks at the watch. */
enum { STRIDE = 1 << 16 };

typedef struct scan {
    he_json *json;
    he_watch *watch;
    const char *told; /* up to here */
    const char *at, *end;
    uint32_t open[HE_JSON_DEPTH]; /* arrays and objects */
    size_t depth;
    he_error *err;
} scan;

static he_status refuse(const scan *s, const char *text)
{
    uint64_t at = s->json->offset + (uint64_t)(s->at - s->json->text);
    return he_fail_at(s->err, HE_SYNTAX, HE_PLACE_BYTE, at, "JSON: %s", text);
}

static he_status tell(scan *s)
{
    s->told = s->at;
    return he_watch_step(s->watch, (uint64_t)(s->at - s->json->text), s->json->length, s->err);
}

static he_status poll(scan *s)
{
    return s->at - s->told < STRIDE ? HE_OK : tell(s);
}

static void skip_blanks(scan *s)
{
    while (s->at < s->end &&
           (*s->at == ' ' || *s->at == '\n' || *s->at == '\r' || *s->at == '\t')) {
        s->at++;
    }
}

/* Make a value that begins here and, so far, is alone. */
static he_status add_value(scan *s)
{
    he_json *json = s->json;
    he_status status = poll(s);
    if (status != HE_OK) {
        return status;
    }
    if (json->count == HE_JSON_VALUES) {
        return he_fail_at(s->err, HE_LIMIT, HE_PLACE_BYTE,
                          json->offset + (uint64_t)(s->at - json->text),
                          "JSON of more than %zu values", HE_JSON_VALUES);
    }
    if (json->count == json->capacity) {
        size_t capacity = he_mem_grown(json->capacity, json->count + 1);
        he_json_value *values = he_mem_array(json->values, capacity, sizeof *values);
        if (values == NULL) {
            return he_fail_plain(s->err, HE_NO_MEMORY, "no memory for %zu values", capacity);
        }
        json->values = values;
        json->capacity = capacity;
    }
    uint32_t number = (uint32_t)json->count++;
    json->values[number] = (he_json_value){(uint32_t)(s->at - json->text), number + 1};
    return HE_OK;
}

static he_status scan_word(scan *s, const char *word)
{
    size_t length = strlen(word);
    if ((size_t)(s->end - s->at) < length || memcmp(s->at, word, length) != 0) {
        return refuse(s, "a value is expected here");
    }
    s->at += length;
    return HE_OK;
}

static he_status scan_number(scan *s)
{
    double value;
    size_t used;
    he_status status = he_double_parse(s->at, s->end, HE_JSON_NUMBER, &value, &used);
    if (status == HE_SYNTAX) {
        return refuse(s, "this is not a number");
    }
    if (status != HE_OK) {
        return he_fail_at(s->err, status, HE_PLACE_BYTE,
                          s->json->offset + (uint64_t)(s->at - s->json->text),
                          "the number does not fit a double");
    }
    s->at += used;
    return HE_OK;
}

static he_status scan_string(scan *s)
{
    bool closed = false;
    s->at++;
    while (!closed) {
        const char *wrong = he_json_string_part(&s->at, s->end, &closed);
        he_status status = wrong != NULL ? refuse(s, wrong) : poll(s);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

/* --- members that are given twice --- */

static he_status repeated(const scan *s, uint32_t name)
{
    char text[60], quoted[60];
    size_t length = he_json_string(s->json, name, text, sizeof text);
    he_quote(text, text + length, quoted, sizeof quoted);
    return he_fail_at(s->err, HE_SYNTAX, HE_PLACE_BYTE, he_json_place(s->json, name),
                      "JSON: the member '%s' is given twice", quoted);
}

/* Names longer than this are compared by their first bytes and refused as too long. */
enum { NAME_ROOM = 1024, FEW = 12 };

static he_status check_few(const scan *s, uint32_t object)
{
    const he_json *json = s->json;
    uint32_t names[FEW];
    size_t count = 0;
    for (uint32_t i = he_json_first(json, object); i != HE_NONE;
         i = he_json_after(json, object, i)) {
        char text[NAME_ROOM];
        he_json_string(json, i, text, sizeof text);
        for (size_t k = 0; k < count; k++) {
            if (he_json_is(json, names[k], text)) {
                return repeated(s, i);
            }
        }
        names[count++] = i;
    }
    return HE_OK;
}

static he_status check_many(scan *s, uint32_t object, size_t count)
{
    const he_json *json = s->json;
    size_t size = 32;
    while (size < 2 * count) {
        size *= 2;
    }
    uint32_t *slots = he_mem_zero(size, sizeof *slots);
    he_status status = HE_OK;
    if (slots == NULL) {
        return he_fail_plain(s->err, HE_NO_MEMORY, "no memory for %zu members", count);
    }
    for (uint32_t i = he_json_first(json, object); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, object, i)) {
        char text[NAME_ROOM];
        if (i % HE_WATCH_STRIDE == 0) {
            status = tell(s);
        }
        size_t length = he_json_string(json, i, text, sizeof text);
        size_t slot = he_text_hash((uintptr_t)slots, text, length) & (size - 1);
        while (slots[slot] != 0 && !he_json_is(json, slots[slot], text)) {
            slot = (slot + 1) & (size - 1);
        }
        status = status == HE_OK && slots[slot] != 0 ? repeated(s, i) : status;
        slots[slot] = i;
    }
    he_mem_free(slots);
    return status;
}

static he_status check_members(scan *s, uint32_t object)
{
    const he_json *json = s->json;
    size_t count = 0;
    for (uint32_t i = he_json_first(json, object); i != HE_NONE;
         i = he_json_after(json, object, i)) {
        size_t length;
        he_json_raw(json, i, &length);
        if (length >= NAME_ROOM) {
            return he_fail_at(s->err, HE_LIMIT, HE_PLACE_BYTE, he_json_place(json, i),
                              "JSON: a member's name of more than %d bytes", (int)NAME_ROOM - 1);
        }
        count++;
    }
    return count <= FEW ? check_few(s, object) : check_many(s, object, count);
}

/* --- values --- */

static he_status close_value(scan *s)
{
    uint32_t value = s->open[--s->depth];
    s->json->values[value].next = (uint32_t)s->json->count;
    s->at++;
    return he_json_type(s->json, value) == '{' ? check_members(s, value) : HE_OK;
}

static he_status scan_key(scan *s)
{
    skip_blanks(s);
    if (s->at == s->end || *s->at != '"') {
        return refuse(s, "a member's name in quotes is expected here");
    }
    he_status status = add_value(s);
    if (status == HE_OK) {
        status = scan_string(s);
    }
    if (status != HE_OK) {
        return status;
    }
    skip_blanks(s);
    if (s->at == s->end || *s->at != ':') {
        return refuse(s, "':' is expected here");
    }
    s->at++;
    return HE_OK;
}

/* A value, or the bracket that opens one: `*opened` says which. */
static he_status scan_value(scan *s, bool *opened)
{
    *opened = false;
    skip_blanks(s);
    if (s->at == s->end) {
        return refuse(s, "the text ends where a value is expected");
    }
    he_status status = add_value(s);
    if (status != HE_OK) {
        return status;
    }
    switch (*s->at) {
    case '"':
        return scan_string(s);
    case 't':
        return scan_word(s, "true");
    case 'f':
        return scan_word(s, "false");
    case 'n':
        return scan_word(s, "null");
    case '{':
    case '[':
        if (s->depth == HE_JSON_DEPTH) {
            return refuse(s, "nesting is deeper than 128 levels");
        }
        s->open[s->depth++] = (uint32_t)s->json->count - 1;
        s->at++;
        *opened = true;
        return HE_OK;
    default:
        return *s->at == '-' || (*s->at >= '0' && *s->at <= '9')
                   ? scan_number(s)
                   : refuse(s, "a value is expected here");
    }
}

static char bracket_of(const scan *s)
{
    return he_json_type(s->json, s->open[s->depth - 1]) == '{' ? '}' : ']';
}

/* After a value: close what ends here. `*more` is true where another value follows. */
static he_status scan_after(scan *s, bool *more)
{
    *more = false;
    while (s->depth > 0) {
        skip_blanks(s);
        if (s->at < s->end && *s->at == ',') {
            s->at++;
            *more = true;
            return HE_OK;
        }
        if (s->at == s->end || *s->at != bracket_of(s)) {
            return refuse(s, "',' or the closing bracket is expected here");
        }
        he_status status = close_value(s);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

static he_status scan_text(scan *s)
{
    bool more = true;
    he_status status = HE_OK;
    while (more && status == HE_OK) {
        bool opened = false;
        if (s->depth > 0 && bracket_of(s) == '}') {
            status = scan_key(s);
        }
        if (status == HE_OK) {
            status = scan_value(s, &opened);
        }
        if (status == HE_OK && opened) {
            skip_blanks(s);
            if (s->at == s->end || *s->at != bracket_of(s)) {
                continue;
            }
            status = close_value(s);
        }
        if (status == HE_OK) {
            status = scan_after(s, &more);
        }
    }
    skip_blanks(s);
    return status == HE_OK && s->at != s->end ? refuse(s, "something follows the value") : status;
}

he_status he_json_parse(he_json *json, const char *text, size_t length, uint64_t offset,
                        he_watch *watch, he_error *err)
{
    *json = (he_json){.text = text, .length = length, .offset = offset};
    if (length > HE_JSON_TEXT) {
        return he_fail_at(err, HE_LIMIT, HE_PLACE_BYTE, offset, "JSON of more than %zu bytes",
                          HE_JSON_TEXT);
    }
    scan s = {
        .json = json, .watch = watch, .told = text, .at = text, .end = text + length, .err = err};
    he_status status = scan_text(&s);
    if (status != HE_OK) {
        he_json_clear(json);
    }
    return status;
}
