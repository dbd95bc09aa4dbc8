#include "api/header/media.h"

#include <string.h>

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + 32) : c;
}

static bool equal(const char *a, size_t length, const char *b)
{
    for (size_t i = 0; i < length; i++) {
        if (b[i] == '\0' || lower(a[i]) != lower(b[i])) {
            return false;
        }
    }
    return b[length] == '\0';
}

bool api_equal_nocase(const char *a, const char *b)
{
    return equal(a, strlen(a), b);
}

/* A part of a header's value, borrowed, without blanks around it. */
typedef struct piece {
    const char *at;
    size_t length;
} piece;

static piece trim(const char *at, size_t length)
{
    while (length > 0 && (*at == ' ' || *at == '\t')) {
        at++;
        length--;
    }
    while (length > 0 && (at[length - 1] == ' ' || at[length - 1] == '\t')) {
        length--;
    }
    return (piece){at, length};
}

/* Reads the next piece of *rest, up to the next `separator` that is not inside a quoted string.
 * Returns false when no piece is left. */
static bool next_piece(piece *rest, char separator, piece *out)
{
    if (rest->at == NULL) {
        return false;
    }
    bool quoted = false;
    size_t i = 0;
    for (; i < rest->length; i++) {
        char c = rest->at[i];
        if (quoted && c == '\\' && i + 1 < rest->length) {
            i++;
        } else if (c == '"') {
            quoted = !quoted;
        } else if (c == separator && !quoted) {
            break;
        }
    }
    *out = trim(rest->at, i);
    if (i == rest->length) {
        rest->at = NULL;
    } else {
        rest->at += i + 1;
        rest->length -= i + 1;
    }
    return true;
}

/* Splits a parameter name=value, and removes the quotes of the value. */
static bool split_parameter(piece parameter, piece *name, piece *value)
{
    const char *equals = memchr(parameter.at, '=', parameter.length);
    if (equals == NULL) {
        return false;
    }
    size_t before = (size_t)(equals - parameter.at);
    *name = trim(parameter.at, before);
    *value = trim(equals + 1, parameter.length - before - 1);
    if (value->length >= 2 && value->at[0] == '"' && value->at[value->length - 1] == '"') {
        value->at++;
        value->length -= 2;
    }
    return true;
}

bool api_media_is(const char *content_type, const char *type)
{
    piece rest = {content_type, strlen(content_type)}, part, name, value;
    if (!next_piece(&rest, ';', &part) || !equal(part.at, part.length, type)) {
        return false;
    }
    while (next_piece(&rest, ';', &part)) {
        if (split_parameter(part, &name, &value) && equal(name.at, name.length, "charset") &&
            !equal(value.at, value.length, "utf-8")) {
            return false;
        }
    }
    return true;
}

/* Reads a qvalue ("0", "1", "0.5", at most three decimals) in thousandths; returns -1 if
 * malformed. */
static int read_q(piece value)
{
    if (value.length < 1 || value.length > 5 || (value.at[0] != '0' && value.at[0] != '1')) {
        return -1;
    }
    int q = (value.at[0] - '0') * 1000, unit = 100;
    if (value.length > 1 && value.at[1] != '.') {
        return -1;
    }
    for (size_t i = 2; i < value.length; i++, unit /= 10) {
        if (value.at[i] < '0' || value.at[i] > '9') {
            return -1;
        }
        q += (value.at[i] - '0') * unit;
    }
    return q <= 1000 ? q : -1;
}

/* Returns how specifically a media range matches a type: 0 not at all, 1 if the range matches all
 * types, 2 if it matches all subtypes of the type, 3 if it names the type. */
static int closeness(piece range, const char *type)
{
    if (equal(range.at, range.length, "*/*")) {
        return 1;
    }
    if (equal(range.at, range.length, type)) {
        return 3;
    }
    const char *slash = memchr(range.at, '/', range.length);
    if (slash == NULL || range.length != (size_t)(slash - range.at) + 2 || slash[1] != '*') {
        return 0;
    }
    for (size_t i = 0; i + 1 < range.length; i++) {
        if (lower(range.at[i]) != lower(type[i])) {
            /* Also true if the type ends first: its NUL differs from the range's character. */
            return 0;
        }
    }
    return 2;
}

static int quality(const char *accept, const char *type)
{
    piece list = {accept, strlen(accept)}, range;
    int best = 0, q_best = 0;
    while (next_piece(&list, ',', &range)) {
        piece name, value, part;
        int q = 1000;
        piece rest = range, media;
        if (!next_piece(&rest, ';', &media) || media.length == 0) {
            continue;
        }
        while (next_piece(&rest, ';', &part)) {
            if (split_parameter(part, &name, &value) && equal(name.at, name.length, "q")) {
                q = read_q(value);
            }
        }
        int close = closeness(media, type);
        if (q >= 0 && (close > best || (close == best && close > 0 && q > q_best))) {
            best = close;
            q_best = q;
        }
    }
    return q_best;
}

int api_media_choose(const char *accept, const char *const *offers)
{
    int best = -1, q_best = 0;
    for (int i = 0; offers[i] != NULL; i++) {
        int q = accept == NULL ? 1000 : quality(accept, offers[i]);
        if (q > q_best) {
            best = i;
            q_best = q;
        }
    }
    return best;
}

bool api_header_has(const char *header, const char *token)
{
    piece list = {header, header == NULL ? 0 : strlen(header)}, part;
    while (next_piece(&list, ',', &part)) {
        if (equal(part.at, part.length, token)) {
            return true;
        }
    }
    return false;
}

bool api_media_next(const char **at, api_weighed *out)
{
    piece list = {*at, *at == NULL ? 0 : strlen(*at)}, entry, part, name, value;
    while (next_piece(&list, ',', &entry)) {
        *at = list.at;
        piece rest = entry;
        if (!next_piece(&rest, ';', &part) || part.length == 0) {
            continue;
        }
        bool fits = part.length <= API_WEIGHED_NAME;
        memcpy(out->name, fits ? part.at : "?", fits ? part.length : 1);
        out->name[fits ? part.length : 1] = '\0';
        out->q = 1000;
        while (next_piece(&rest, ';', &part)) {
            bool weight = split_parameter(part, &name, &value) && equal(name.at, name.length, "q");
            out->q = weight ? read_q(value) : -1;
        }
        return true;
    }
    return false;
}
