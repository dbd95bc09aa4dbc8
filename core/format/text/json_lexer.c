#include "format/text/json_lexer.h"

#include "format/text/json_bytes.h"
#include "format/text/json_string.h"
#include "format/text/number.h"

#include <stdio.h>
#include <string.h>

void he_lexer_init(he_lexer *x, he_lexer_carry *carry)
{
    x->begin = x->at = x->end = NULL;
    x->offset = 0;
    x->carry = carry;
    x->state = HE_JSON_VALUE;
    x->depth_most = HE_JSON_DEPTH;
    x->number_most = HE_JSON_CARRY;
    x->name_most = SIZE_MAX;
    x->fault = HE_FAULT_NONE;
    x->depth = 0;
    if (carry != NULL) {
        carry->length = 0;
    }
}

void he_lexer_feed(he_lexer *x, const char *bytes, size_t length)
{
    x->offset += (uint64_t)(x->end - x->begin);
    x->begin = x->at = bytes;
    x->end = bytes + length;
}

/* --- faults --- */

static he_token fault_at(he_lexer *x, he_fault fault, uint64_t place)
{
    x->fault = fault;
    x->fault_place = place;
    return HE_TOKEN_FAULT;
}

static he_token fault_here(he_lexer *x, he_fault fault)
{
    return fault_at(x, fault, he_lexer_place(x));
}

const char *he_lexer_fault_text(const he_lexer *x)
{
    switch (x->fault) {
    case HE_FAULT_VALUE:
        return "a value is expected here";
    case HE_FAULT_ENDS:
        return "the text ends where a value is expected";
    case HE_FAULT_NAME:
        return "a member's name in quotes is expected here";
    case HE_FAULT_COLON:
        return "':' is expected here";
    case HE_FAULT_ITEM:
        return "',' or ']' is expected here";
    case HE_FAULT_MEMBER:
        return "',' or '}' is expected here";
    case HE_FAULT_FOLLOWS:
        return "more text follows the JSON value";
    case HE_FAULT_DEPTH:
        return "the JSON is nested too deeply";
    case HE_FAULT_STRING:
        return x->wrong;
    case HE_FAULT_NUMBER:
        return "the text at this place is not a JSON number";
    case HE_FAULT_NOT_FINITE:
        return "the number does not fit a double";
    case HE_FAULT_LONG_NUMBER:
        return "the number has too many characters";
    case HE_FAULT_LONG_NAME:
        return "the name of the member is too long";
    case HE_FAULT_NONE:
        break;
    }
    return "";
}

/* --- frames --- */

static he_lexer_frame *innermost(he_lexer *x)
{
    return &x->frames[x->depth - 1];
}

static he_token end_value(he_lexer *x, he_token token)
{
    x->state = x->depth == 0 ? HE_JSON_DONE : HE_JSON_AFTER;
    return token;
}

/* --- numbers --- */

/* Reads a number that the end of a piece may have cut: copies its bytes to the carry buffer, and
 * converts them once a byte follows that cannot belong to the number. */
static he_token carry_number(he_lexer *x)
{
    he_lexer_carry *carry = x->carry;
    while (x->at < x->end && he_json_is_number_byte(*x->at)) {
        if (carry->length == x->number_most) {
            return fault_here(x, HE_FAULT_LONG_NUMBER);
        }
        carry->bytes[carry->length++] = *x->at++;
    }
    if (x->at == x->end) {
        return HE_TOKEN_CUT;
    }
    x->length = carry->length;
    carry->length = 0;
    size_t used = 0;
    he_status status =
        he_double_parse(carry->bytes, carry->bytes + x->length, HE_JSON_NUMBER, &x->number, &used);
    if (status != HE_OK || used != x->length) {
        bool finite = status != HE_NOT_FINITE || used != x->length;
        return fault_at(x, finite ? HE_FAULT_NUMBER : HE_FAULT_NOT_FINITE, x->start);
    }
    return end_value(x, HE_TOKEN_NUMBER);
}

static he_token read_number(he_lexer *x)
{
    size_t used = 0;
    he_status status = he_double_parse(x->at, x->end, HE_JSON_NUMBER, &x->number, &used);
    const char *after = x->at + used;
    if (x->carry != NULL && (status != HE_OK || used > x->number_most || after == x->end ||
                             he_json_is_number_byte(*after))) {
        x->state = HE_JSON_IN_NUMBER;
        return carry_number(x);
    }
    if (status != HE_SYNTAX && after < x->end && he_json_is_number_byte(*after)) {
        status = HE_SYNTAX; /* "01" is an error, not the number 0 followed by the number 1 */
    }
    if (status != HE_OK) {
        return fault_here(x, status == HE_SYNTAX ? HE_FAULT_NUMBER : HE_FAULT_NOT_FINITE);
    }
    x->at = after;
    x->length = used;
    return end_value(x, HE_TOKEN_NUMBER);
}

/* --- words --- */

static he_token read_word(he_lexer *x)
{
    while (x->word[x->matched] != '\0' && x->at < x->end && *x->at == x->word[x->matched]) {
        x->at++;
        x->matched++;
    }
    if (x->word[x->matched] == '\0') {
        return end_value(x, *x->word == 't'   ? HE_TOKEN_TRUE
                            : *x->word == 'f' ? HE_TOKEN_FALSE
                                              : HE_TOKEN_NULL);
    }
    return x->at == x->end && x->carry != NULL ? HE_TOKEN_CUT
                                               : fault_at(x, HE_FAULT_VALUE, x->start);
}

/* --- strings --- */

/* Copies bytes of a name to the carry buffer, because the piece that contains them may be freed. */
static void carry_name(he_lexer *x, const char *bytes, size_t length)
{
    size_t used = innermost(x)->names + x->name_length;
    x->name_lost |= length > HE_JSON_NAMES - used;
    if (!x->name_lost) {
        memcpy(x->carry->names + used, bytes, length);
        x->name_length += length;
    }
}

/* Moves on to the byte `to` of the string being read. In a text that comes in pieces, the bytes
 * of a name are copied to the carry buffer. */
static void pass_string(he_lexer *x, const char *to)
{
    if (x->state == HE_JSON_IN_NAME && x->carry != NULL) {
        carry_name(x, x->at, (size_t)(to - x->at));
    }
    x->at = to;
}

static he_token read_colon(he_lexer *x)
{
    x->at = he_json_skip_blanks(x->at, x->end);
    if (x->at == x->end && x->carry != NULL) {
        return HE_TOKEN_CUT;
    }
    if (x->at == x->end || *x->at != ':') {
        return fault_here(x, HE_FAULT_COLON);
    }
    x->at++;
    x->state = HE_JSON_VALUE;
    return HE_TOKEN_KEY;
}

/* Ends the string that is being read at its closing quote. */
static he_token close_string(he_lexer *x)
{
    x->at++;
    if (x->state == HE_JSON_IN_STRING) {
        return end_value(x, HE_TOKEN_STRING);
    }
    he_lexer_frame *frame = innermost(x);
    if (x->carry == NULL) {
        frame->name = x->begin + (x->start - x->offset) + 1;
        frame->name_length = (size_t)(x->at - 1 - frame->name);
    } else if (!x->name_lost) {
        frame->name = x->carry->names + frame->names;
        frame->name_length = x->name_length;
    }
    x->state = HE_JSON_COLON;
    return read_colon(x);
}

/* Completes a character whose first bytes are in the carry buffer, because a piece ended inside it.
 * Returns false if the character is cut again, or is not valid. */
static bool mend_character(he_lexer *x, he_token *token)
{
    he_lexer_carry *carry = x->carry;
    size_t size = 0;
    bool cut = true;
    while (size == 0 && cut && x->at < x->end) {
        carry->bytes[carry->length++] = *x->at++;
        size = he_json_character(carry->bytes, carry->bytes + carry->length, &x->wrong, &cut);
    }
    if (size == 0) {
        *token =
            cut ? HE_TOKEN_CUT : fault_at(x, HE_FAULT_STRING, he_lexer_place(x) - carry->length);
        return false;
    }
    if (x->state == HE_JSON_IN_NAME) {
        carry_name(x, carry->bytes, carry->length);
    }
    carry->length = 0;
    return true;
}

static bool is_plain(char c)
{
    return (unsigned char)c >= 0x20 && (unsigned char)c < 0x80 && c != '"' && c != '\\';
}

/* Returns how far a string may be read at once: to the end of the piece of text, but at most
 * HE_JSON_STRING bytes, and in a name only up to the byte that makes the name too long. */
static const char *string_stop(const he_lexer *x)
{
    size_t most = HE_JSON_STRING, left = (size_t)(x->end - x->at);
    if (x->state == HE_JSON_IN_NAME) {
        uint64_t passed = he_lexer_place(x) - x->start - 1;
        if (passed > x->name_most) {
            most = 0;
        } else if (x->name_most - passed < most) {
            most = (size_t)(x->name_most - passed) + 1;
        }
    }
    return x->at + (left < most ? left : most);
}

static he_token read_string(he_lexer *x)
{
    he_token token;
    if (x->carry != NULL && x->carry->length > 0 && !mend_character(x, &token)) {
        return token;
    }
    const char *p = x->at, *stop = string_stop(x);
    while (p < stop) {
        if (is_plain(*p)) {
            p++;
            continue;
        }
        if (*p == '"') {
            pass_string(x, p);
            return close_string(x);
        }
        bool cut;
        size_t size = he_json_character(p, x->end, &x->wrong, &cut);
        if (size == 0) {
            pass_string(x, p);
            if (!cut || x->carry == NULL) {
                return fault_here(x, HE_FAULT_STRING);
            }
            x->carry->length = (size_t)(x->end - p);
            memcpy(x->carry->bytes, p, x->carry->length);
            x->at = x->end;
            return HE_TOKEN_CUT;
        }
        p += size;
    }
    pass_string(x, p);
    if (x->state == HE_JSON_IN_NAME && he_lexer_place(x) - x->start - 1 > x->name_most) {
        return fault_at(x, HE_FAULT_LONG_NAME, x->start + x->name_most + 2);
    }
    if (x->at < x->end) {
        return HE_TOKEN_PART;
    }
    if (x->carry != NULL) {
        return HE_TOKEN_CUT;
    }
    x->wrong = "the string does not end";
    return fault_here(x, HE_FAULT_STRING);
}

static he_token open_string(he_lexer *x, he_lexer_state state)
{
    x->start = he_lexer_place(x);
    x->at++;
    x->state = state;
    if (state == HE_JSON_IN_NAME) {
        innermost(x)->name = NULL;
        x->name_length = 0;
        x->name_lost = false;
    }
    return read_string(x);
}

/* --- brackets --- */

static he_token open_frame(he_lexer *x, bool object)
{
    if (x->depth >= x->depth_most) {
        return fault_here(x, HE_FAULT_DEPTH);
    }
    uint32_t names = 0;
    if (x->depth > 0) {
        const he_lexer_frame *outer = innermost(x);
        bool carried = x->carry != NULL && outer->object && outer->name != NULL;
        names = outer->names + (carried ? (uint32_t)outer->name_length : 0);
    }
    x->frames[x->depth++] = (he_lexer_frame){.object = object, .names = names};
    x->at++;
    x->state = object ? HE_JSON_NAME_OR_END : HE_JSON_VALUE_OR_END;
    return object ? HE_TOKEN_OBJECT : HE_TOKEN_ARRAY;
}

static he_token close_frame(he_lexer *x)
{
    x->depth--;
    x->at++;
    return end_value(x, HE_TOKEN_CLOSE);
}

/* --- the grammar --- */

bool he_lexer_value_ahead(he_lexer *x)
{
    if (x->state >= HE_JSON_IN_STRING) {
        return false;
    }
    x->at = he_json_skip_blanks(x->at, x->end);
    if (x->at == x->end) {
        return false;
    }
    if (x->state == HE_JSON_AFTER && *x->at == ',') {
        he_lexer_frame *frame = innermost(x);
        frame->index++;
        frame->name = NULL;
        x->state = frame->object ? HE_JSON_NAME : HE_JSON_VALUE;
        x->at = he_json_skip_blanks(x->at + 1, x->end);
        if (x->at == x->end) {
            return false;
        }
    }
    return x->state == HE_JSON_VALUE || (x->state == HE_JSON_VALUE_OR_END && *x->at != ']');
}

static he_token read_value(he_lexer *x)
{
    char c = *x->at;
    x->start = he_lexer_place(x);
    switch (c) {
    case '"':
        return open_string(x, HE_JSON_IN_STRING);
    case '{':
    case '[':
        return open_frame(x, c == '{');
    case 't':
    case 'f':
    case 'n':
        x->word = c == 't' ? "true" : c == 'f' ? "false" : "null";
        x->matched = 0;
        x->state = HE_JSON_IN_WORD;
        return read_word(x);
    default:
        return c == '-' || (c >= '0' && c <= '9') ? read_number(x) : fault_here(x, HE_FAULT_VALUE);
    }
}

/* Ends the whole text. It is a fault if a value is still missing or not complete. */
static he_token end_text(he_lexer *x)
{
    if (x->state == HE_JSON_DONE) {
        return HE_TOKEN_END;
    }
    if (x->state == HE_JSON_AFTER) {
        return fault_here(x, innermost(x)->object ? HE_FAULT_MEMBER : HE_FAULT_ITEM);
    }
    bool name = x->state == HE_JSON_NAME || x->state == HE_JSON_NAME_OR_END;
    return fault_here(x, name ? HE_FAULT_NAME : HE_FAULT_ENDS);
}

he_token he_lexer_next(he_lexer *x)
{
    if (he_lexer_value_ahead(x)) {
        return read_value(x);
    }
    if (x->state < HE_JSON_IN_STRING && x->at == x->end) {
        return x->carry != NULL ? HE_TOKEN_CUT : end_text(x);
    }
    switch (x->state) {
    case HE_JSON_IN_STRING:
    case HE_JSON_IN_NAME:
        return read_string(x);
    case HE_JSON_IN_NUMBER:
        return carry_number(x);
    case HE_JSON_IN_WORD:
        return read_word(x);
    case HE_JSON_COLON:
        return read_colon(x);
    case HE_JSON_NAME_OR_END:
        if (*x->at == '}') {
            return close_frame(x);
        }
        break;
    case HE_JSON_NAME:
        break;
    case HE_JSON_AFTER:
        if (*x->at != (innermost(x)->object ? '}' : ']')) {
            return fault_here(x, innermost(x)->object ? HE_FAULT_MEMBER : HE_FAULT_ITEM);
        }
        return close_frame(x);
    case HE_JSON_VALUE_OR_END:
        return close_frame(x);
    case HE_JSON_VALUE:
    case HE_JSON_DONE:
        return fault_here(x, HE_FAULT_FOLLOWS);
    }
    return *x->at == '"' ? open_string(x, HE_JSON_IN_NAME) : fault_here(x, HE_FAULT_NAME);
}

/* --- the place --- */

void he_lexer_pointer(const he_lexer *x, char *out, size_t size)
{
    char *at = out, *end = out + size - 1;
    for (size_t d = 0; d < x->depth; d++) {
        const he_lexer_frame *f = &x->frames[d];
        char index[24];
        const char *name = f->name;
        size_t length = f->name_length;
        if (!f->object) {
            length = (size_t)snprintf(index, sizeof index, "%zu", f->index);
            name = index;
        }
        if (name == NULL || 2 * length + 1 > (size_t)(end - at)) {
            break;
        }
        *at++ = '/';
        for (size_t i = 0; i < length; i++) {
            if (name[i] == '~' || name[i] == '/') {
                *at++ = '~';
                *at++ = name[i] == '~' ? '0' : '1';
            } else {
                *at++ = name[i];
            }
        }
    }
    *at = '\0';
}
