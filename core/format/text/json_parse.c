/* he_json_parse of json.h. */
#include "format/text/json.h"

#include "base/text_hash.h"
#include "format/text/json_lexer.h"
#include "format/text/warnings.h"

#include <string.h>

/* The number of bytes of text between two reports of progress. */
enum { STRIDE = 1 << 16 };

typedef struct scan {
    he_json *json;
    he_progress *progress;
    const char *told; /* the byte up to which progress was reported */
    he_lexer lexer;
    uint32_t open[HE_JSON_DEPTH]; /* numbers of the arrays and objects that are not closed yet */
    he_error *err;
} scan;

/* Fails with the fault that the lexer has found. */
static he_status refuse(const scan *s)
{
    const he_lexer *x = &s->lexer;
    he_fault fault = x->fault;
    if (fault == HE_FAULT_DEPTH) {
        return he_fail_at(s->err, HE_SYNTAX, HE_PLACE_BYTE, x->fault_place,
                          "JSON: nesting is deeper than %d levels", HE_JSON_DEPTH);
    }
    if (fault == HE_FAULT_NOT_FINITE) {
        return he_fail_at(s->err, HE_NOT_FINITE, HE_PLACE_BYTE, x->fault_place, "%s",
                          he_lexer_fault_text(x));
    }
    return he_fail_at(s->err, HE_SYNTAX, HE_PLACE_BYTE, x->fault_place, "JSON: %s",
                      fault == HE_FAULT_NUMBER ? "the text at this place is not a number"
                      : fault == HE_FAULT_ITEM || fault == HE_FAULT_MEMBER
                          ? "',' or the closing bracket is expected here"
                          : he_lexer_fault_text(x));
}

static he_status tell(scan *s)
{
    const char *at = s->lexer.at;
    s->told = at;
    return he_progress_step(s->progress, (uint64_t)(at - s->json->text), s->json->length, s->err);
}

static he_status poll(scan *s)
{
    return s->lexer.at - s->told < STRIDE ? HE_OK : tell(s);
}

/* Adds to the tree the value or name that begins at byte `place` of the input. The values inside
 * it are added later. */
static he_status add_value(scan *s, uint64_t place)
{
    he_json *json = s->json;
    he_status status = poll(s);
    if (status != HE_OK) {
        return status;
    }
    if (json->count == HE_JSON_VALUES) {
        return he_fail_at(s->err, HE_LIMIT, HE_PLACE_BYTE, place,
                          "JSON: there are more than %zu values", HE_JSON_VALUES);
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
    json->values[number] = (he_json_value){(uint32_t)(place - json->offset), number + 1};
    return HE_OK;
}

/* --- names that occur twice in an object --- */

static he_status repeated(const scan *s, uint32_t name)
{
    char text[60], quoted[60];
    size_t length = he_json_string(s->json, name, text, sizeof text);
    he_quote(text, text + length, quoted, sizeof quoted);
    return he_fail_at(s->err, HE_SYNTAX, HE_PLACE_BYTE, he_json_place(s->json, name),
                      "JSON: the member '%s' is given twice", quoted);
}

/* A name of NAME_ROOM bytes or more is refused. The names of an object with at most FEW members are
 * compared pairwise, those of a larger object by a hash table. */
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
        if (i % HE_PROGRESS_STRIDE == 0) {
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
                              "JSON: the name of a member has more than %d bytes",
                              (int)NAME_ROOM - 1);
        }
        count++;
    }
    return count <= FEW ? check_few(s, object) : check_many(s, object, count);
}

/* --- values --- */

/* Ends the array or object whose closing bracket was just read. */
static he_status close_value(scan *s)
{
    uint32_t value = s->open[s->lexer.depth];
    s->json->values[value].next = (uint32_t)s->json->count;
    return s->lexer.frames[s->lexer.depth].object ? check_members(s, value) : HE_OK;
}

static he_status take(scan *s, he_token token)
{
    if (token == HE_TOKEN_FAULT) {
        return refuse(s);
    }
    if (token == HE_TOKEN_KEY) {
        return add_value(s, s->lexer.start);
    }
    if (token == HE_TOKEN_OBJECT || token == HE_TOKEN_ARRAY) {
        s->open[s->lexer.depth - 1] = (uint32_t)s->json->count - 1;
    }
    return token == HE_TOKEN_CLOSE ? close_value(s) : poll(s);
}

static he_status scan_text(scan *s)
{
    he_token token = HE_TOKEN_PART;
    he_status status = HE_OK;
    while (token != HE_TOKEN_END && status == HE_OK) {
        if (he_lexer_value_ahead(&s->lexer)) {
            status = add_value(s, he_lexer_place(&s->lexer));
        }
        if (status == HE_OK) {
            token = he_lexer_next(&s->lexer);
            status = take(s, token);
        }
    }
    return status;
}

he_status he_json_parse(he_json *json, const char *text, size_t length, uint64_t offset,
                        he_progress *progress, he_error *err)
{
    *json = (he_json){.text = text, .length = length, .offset = offset};
    if (length > HE_JSON_TEXT) {
        return he_fail_at(err, HE_LIMIT, HE_PLACE_BYTE, offset,
                          "JSON: there are more than %zu bytes", HE_JSON_TEXT);
    }
    scan s = {.json = json, .progress = progress, .told = text, .err = err};
    he_lexer_init(&s.lexer, NULL);
    s.lexer.offset = offset;
    he_lexer_feed(&s.lexer, text, length);
    he_status status = scan_text(&s);
    if (status != HE_OK) {
        he_json_clear(json);
    }
    return status;
}
