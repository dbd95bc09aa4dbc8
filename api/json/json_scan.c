#include "api/json/json_scan.h"

#include "api/limits.h"
#include "format/text/json_string.h"
#include "format/text/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* An open array or object, and where in it the scan is: enough to write the pointer. */
typedef struct frame {
    bool object;
    size_t index;
    const char *key; /* as it stands in the text, without quotes */
    size_t key_length;
} frame;

typedef struct scan {
    const char *begin, *at, *end;
    frame frames[API_MAX_DEPTH];
    size_t depth, values;
    api_items *items; /* NULL: none are looked for */
    bool inside;      /* of their array */
    const api_in_limits *limits;
    api_problem *problem;
} scan;

static void point(scan *s)
{
    char *at = s->problem->pointer, *end = at + sizeof s->problem->pointer - 1;
    for (size_t d = 0; d < s->depth; d++) {
        const frame *f = &s->frames[d];
        char index[24];
        const char *name = f->key;
        size_t length = f->key_length;
        if (!f->object) {
            length = (size_t)snprintf(index, sizeof index, "%zu", f->index);
            name = index;
        } else if (name == NULL) {
            break;
        }
        if (2 * length + 1 > (size_t)(end - at)) {
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
    s->problem->has_pointer = true;
}

static bool refuse(scan *s, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static bool refuse(scan *s, int code, const char *format, ...)
{
    char text[128];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (s->limits->no_offsets) {
        api_problem_set(s->problem, code, "%s", text);
    } else {
        api_problem_set(s->problem, code, "byte %zu: %s", (size_t)(s->at - s->begin), text);
    }
    point(s);
    return false;
}

static void skip_blanks(scan *s)
{
    while (s->at < s->end &&
           (*s->at == ' ' || *s->at == '\n' || *s->at == '\r' || *s->at == '\t')) {
        s->at++;
    }
}

static bool scan_word(scan *s, const char *word)
{
    size_t length = strlen(word);
    if ((size_t)(s->end - s->at) < length || memcmp(s->at, word, length) != 0) {
        return refuse(s, API_MALFORMED_JSON, "a value is expected here");
    }
    s->at += length;
    return true;
}

static bool scan_number(scan *s)
{
    double value;
    size_t used;
    he_status status = he_double_parse(s->at, s->end, HE_JSON_NUMBER, &value, &used);
    if (status == HE_SYNTAX) {
        return refuse(s, API_MALFORMED_JSON, "this is not a JSON number");
    }
    if (status != HE_OK) {
        return refuse(s, HE_NOT_FINITE, "the number does not fit a double");
    }
    if (used > API_MAX_NUMBER) {
        return refuse(s, HE_BAD_VALUE, "the number has %zu characters, at most %d are read", used,
                      API_MAX_NUMBER);
    }
    s->at += used;
    return true;
}

static bool scan_string(scan *s)
{
    bool closed = false;
    s->at++; /* the quote */
    while (!closed) {
        const char *wrong = he_json_string_part(&s->at, s->end, &closed);
        if (wrong != NULL) {
            return refuse(s, API_MALFORMED_JSON, "%s", wrong);
        }
    }
    return true;
}

/* Is this a key, as it stands in the text, for a name of ASCII letters? */
static bool is_key(const frame *f, const char *name)
{
    const char *at = f->key, *end = f->key + f->key_length;
    for (; at < end && *name != '\0'; name++) {
        int c = (unsigned char)*at++;
        if (c == '\\') {
            if (*at != 'u') {
                return false;
            }
            c = he_json_hex(at + 1, end);
            at += 5;
        }
        if (c != *name) {
            return false;
        }
    }
    return at == end && *name == '\0';
}

/* Past the bracket that opens an array or object. */
static void open_value(scan *s)
{
    bool object = *s->at == '{';
    if (!object && s->items != NULL && s->items->at == NULL && s->depth == 1 &&
        s->frames[0].object && is_key(&s->frames[0], s->items->name)) {
        s->inside = true;
        s->items->at = s->at + 1;
    }
    s->frames[s->depth++] = (frame){.object = object};
    s->at++;
}

/* Past the bracket that closes the innermost one. */
static void close_value(scan *s, bool empty)
{
    s->depth--;
    if (s->inside && s->depth == 1) {
        s->inside = false;
        s->items->end = s->at;
        s->items->count = empty ? 0 : s->frames[1].index + 1;
    }
    s->at++;
}

static bool scan_key(scan *s)
{
    frame *f = &s->frames[s->depth - 1];
    skip_blanks(s);
    f->key = NULL;
    if (s->at == s->end || *s->at != '"') {
        return refuse(s, API_MALFORMED_JSON, "a member's name in quotes is expected here");
    }
    const char *key = s->at + 1;
    if (!scan_string(s)) {
        return false;
    }
    f->key = key;
    f->key_length = (size_t)(s->at - 1 - key);
    skip_blanks(s);
    if (s->at == s->end || *s->at != ':') {
        return refuse(s, API_MALFORMED_JSON, "':' is expected here");
    }
    s->at++;
    return true;
}

/* One value that is not empty of content, or the opening of one: `*opened` says which. */
static bool scan_value(scan *s, bool *opened)
{
    *opened = false;
    skip_blanks(s);
    if (s->at == s->end) {
        return refuse(s, API_MALFORMED_JSON, "the text ends where a value is expected");
    }
    if (++s->values > s->limits->values) {
        return refuse(s, HE_LIMIT, "there are more than %zu values", s->limits->values);
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
        if (s->depth == API_MAX_DEPTH) {
            return refuse(s, API_MALFORMED_JSON, "nesting is deeper than %d levels", API_MAX_DEPTH);
        }
        open_value(s);
        *opened = true;
        return true;
    default:
        if (*s->at == '-' || (*s->at >= '0' && *s->at <= '9')) {
            return scan_number(s);
        }
        return refuse(s, API_MALFORMED_JSON, "a value is expected here");
    }
}

/* After a value: close what ends here. `*more` is true where another value follows. */
static bool scan_after(scan *s, bool *more)
{
    *more = false;
    while (s->depth > 0) {
        frame *f = &s->frames[s->depth - 1];
        char bracket = f->object ? '}' : ']';
        skip_blanks(s);
        if (s->at < s->end && *s->at == ',') {
            s->at++;
            f->index++;
            *more = true;
            return true;
        }
        if (s->at == s->end || *s->at != bracket) {
            return refuse(s, API_MALFORMED_JSON, "',' or '%c' is expected here", bracket);
        }
        close_value(s, false);
    }
    return true;
}

bool api_json_scan(const char *bytes, size_t length, const api_in_limits *limits, api_items *items,
                   api_problem *problem)
{
    scan s = {.begin = bytes,
              .at = bytes,
              .end = bytes + length,
              .items = items,
              .limits = limits,
              .problem = problem};
    bool more = true;
    while (more) {
        bool opened = false;
        if (s.depth > 0 && s.frames[s.depth - 1].object && !scan_key(&s)) {
            return false;
        }
        if (!scan_value(&s, &opened)) {
            return false;
        }
        if (opened) {
            skip_blanks(&s);
            char bracket = s.frames[s.depth - 1].object ? '}' : ']';
            if (s.at == s.end || *s.at != bracket) {
                continue;
            }
            close_value(&s, true);
        }
        if (!scan_after(&s, &more)) {
            return false;
        }
    }
    skip_blanks(&s);
    return s.at == s.end || refuse(&s, API_MALFORMED_JSON, "something follows the value");
}
