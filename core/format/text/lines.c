#include "format/text/lines.h"

#include "format/text/number.h"
#include "format/text/warnings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void he_lines_init(he_lines *lines, he_line_take *take, void *context)
{
    *lines = (he_lines){.take = take, .context = context, .number = 1};
}

void he_lines_clear(he_lines *lines)
{
    he_mem_free(lines->rest);
    lines->rest = NULL;
    lines->length = lines->capacity = 0;
}

const char *he_continuation(const char *p, const char *end)
{
    p++;
    while (p < end && *p == '\r') {
        p++;
    }
    if (p == end) {
        return p; /* the file ends here */
    }
    return *p == '\n' ? p + 1 : NULL;
}

/* Returns true if the line that ends at the line feed `feed` is continued on the next one. A
 * comment is not continued. `first` is true if the line is not itself a continuation: only such a
 * line can be a comment. */
static bool goes_on(const char *begin, const char *feed, bool first)
{
    const char *p = feed;
    while (p > begin && p[-1] == '\r') {
        p--;
    }
    if (p == begin || p[-1] != '\\') {
        return false;
    }
    p = begin;
    while (first && (*p == ' ' || *p == '\t')) {
        p++;
    }
    return !first || *p != '#';
}

/* Returns true if the text begins with the byte order mark of UTF-16. */
static bool is_wide(const char *p, size_t n)
{
    return n >= 2 && ((p[0] == '\xFF' && p[1] == '\xFE') || (p[0] == '\xFE' && p[1] == '\xFF'));
}

static he_status refuse_wide(const he_lines *lines, he_error *err)
{
    return he_fail_at(err, HE_UNSUPPORTED, HE_PLACE_LINE, lines->number,
                      "the text is UTF-16, not UTF-8");
}

static he_status give(he_lines *lines, const char *begin, const char *end, he_error *err)
{
    while (end > begin && end[-1] == '\r') {
        end--;
    }
    he_line line = {begin, end, lines->number};
    if (lines->number == 1) {
        if (is_wide(begin, (size_t)(end - begin))) {
            return refuse_wide(lines, err);
        }
        if (end - begin >= 3 && memcmp(begin, "\xEF\xBB\xBF", 3) == 0) {
            line.begin += 3;
        }
    }
    return lines->take(lines->context, &line, err);
}

static he_status keep(he_lines *lines, const char *begin, const char *end, he_error *err)
{
    size_t n = (size_t)(end - begin);
    if (lines->limit != 0 && lines->length + n > lines->limit) {
        return he_fail_at(err, HE_LIMIT, HE_PLACE_LINE, lines->number,
                          "a line is longer than %llu bytes", (unsigned long long)lines->limit);
    }
    if (lines->length + n > lines->capacity) {
        size_t capacity = he_mem_grown(lines->capacity, lines->length + n);
        char *rest = he_mem_resize(lines->rest, capacity);
        if (rest == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for a line of %zu bytes", capacity);
        }
        lines->rest = rest;
        lines->capacity = capacity;
    }
    if (n > 0) {
        memcpy(lines->rest + lines->length, begin, n);
        lines->length += n;
    }
    return HE_OK;
}

/* Handles a line end at `feed`. The last part of the line is [begin, feed]. */
static he_status end_line(he_lines *lines, const char *begin, const char *feed, he_error *err)
{
    he_status status = HE_OK;
    if (lines->in_comment) {
        lines->in_comment = false;
    } else if (lines->length == 0 && !(lines->joins && goes_on(begin, feed, true))) {
        status = give(lines, begin, feed, err);
    } else {
        status = keep(lines, begin, feed + 1, err);
        if (status != HE_OK) {
            return status;
        }
        const char *last = lines->rest + lines->length - 1;
        if (lines->joins && goes_on(lines->rest, last, lines->joined == 0)) {
            lines->joined++;
            return HE_OK;
        }
        status = give(lines, lines->rest, last, err);
        lines->length = 0;
    }
    lines->number += 1 + lines->joined;
    lines->joined = 0;
    return status;
}

static he_status feed_text(he_lines *lines, const char *p, const char *end, he_error *err)
{
    while (p < end) {
        const char *feed = memchr(p, '\n', (size_t)(end - p));
        if (feed == NULL) {
            /* Line 1 is kept even if it is a comment, because it may tell the encoding. */
            lines->in_comment =
                lines->in_comment || (lines->length == 0 && lines->number > 1 && *p == '#');
            return lines->in_comment ? HE_OK : keep(lines, p, end, err);
        }
        he_status status = end_line(lines, p, feed, err);
        if (status != HE_OK) {
            return status;
        }
        p = feed + 1;
    }
    return HE_OK;
}

/* Feeds a text whose lines end in carriage returns alone, as on old Macs: they are turned into line
 * feeds. */
static he_status feed_returns(he_lines *lines, const char *p, const char *end, he_error *err)
{
    char part[1024];
    he_status status = HE_OK;
    while (p < end && status == HE_OK) {
        size_t n = 0;
        for (; n < sizeof part && p < end; n++, p++) {
            part[n] = *p == '\r' ? '\n' : *p;
        }
        status = feed_text(lines, part, part + n, err);
    }
    return status;
}

/* Feeds the bytes that were held back while it was not known how the lines of the text end. */
static he_status feed_held(he_lines *lines, he_error *err)
{
    char *held = lines->rest;
    size_t n = lines->length;
    if (n == 0) {
        return HE_OK;
    }
    lines->rest = NULL;
    lines->length = lines->capacity = 0;
    he_status status = feed_returns(lines, held, held + n, err);
    he_mem_free(held);
    return status;
}

/* Finds out how lines end: a carriage return ends lines if no line feed follows the first one. */
static void see_ends(he_lines *lines, const char *p, const char *end)
{
    for (; p < end && lines->ends == HE_ENDS_UNKNOWN; p++) {
        if (*p == '\n') {
            lines->ends = HE_ENDS_FEED;
        } else if (*p == '\r') {
            lines->returned = true;
        } else if (lines->returned) {
            lines->ends = HE_ENDS_RETURN;
        }
    }
}

static he_status feed_any(he_lines *lines, const char *p, const char *end, he_error *err)
{
    he_status status = HE_OK;
    if (lines->ends == HE_ENDS_UNKNOWN) {
        see_ends(lines, p, end);
        if (lines->ends == HE_ENDS_RETURN) {
            status = feed_held(lines, err);
        }
    }
    if (status != HE_OK || lines->ends != HE_ENDS_RETURN) {
        return status == HE_OK ? feed_text(lines, p, end, err) : status;
    }
    return feed_returns(lines, p, end, err);
}

/* Refuses a NUL, which no text contains. UTF-16 has a NUL in its first two bytes, or a byte order
 * mark, and gets its own message. */
static he_status refuse_nul(const he_lines *lines, he_error *err)
{
    bool first = lines->number == 1 && lines->joined == 0;
    if (first && is_wide(lines->rest, lines->length)) {
        return refuse_wide(lines, err);
    }
    if (first && lines->length < 2) {
        return he_fail_at(
            err, HE_UNSUPPORTED, HE_PLACE_LINE, lines->number,
            "one of the first two bytes is zero, as in UTF-16 text; the text must be UTF-8");
    }
    return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, lines->number + lines->joined,
                      "the text contains a NUL byte");
}

he_status he_lines_feed(he_lines *lines, const void *bytes, size_t n, he_error *err)
{
    const char *p = bytes, *end = p + n;
    const char *nul = memchr(p, '\0', n);
    he_status status = feed_any(lines, p, nul == NULL ? end : nul, err);
    return status == HE_OK && nul != NULL ? refuse_nul(lines, err) : status;
}

uint64_t he_lines_last(const he_lines *lines)
{
    bool begun = lines->length > 0 || lines->in_comment || lines->number == 1;
    return begun ? lines->number : lines->number - 1;
}

he_status he_lines_finish(he_lines *lines, he_error *err)
{
    if (lines->length == 0) {
        return HE_OK;
    }
    he_status status = give(lines, lines->rest, lines->rest + lines->length, err);
    lines->length = 0;
    return status;
}

uint64_t he_line_number(const he_line *line, const char *p)
{
    uint64_t number = line->number;
    for (const char *q = line->begin; q < p; q++) {
        number += *q == '\n';
    }
    return number;
}

he_status he_line_fail(he_error *err, he_status status, const he_line *line, const char *p,
                       const char *format, ...)
{
    char text[HE_ERROR_TEXT];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return he_fail_at(err, status, HE_PLACE_LINE, he_line_number(line, p), "%s", text);
}

he_status he_line_locate(he_status status, const he_line *line, he_error *err)
{
    if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
        err->place = HE_PLACE_LINE;
        err->at = line->number;
    }
    return status;
}

he_status he_token_fail(he_error *err, he_status status, const he_line *line, const char *p,
                        const char *what)
{
    char token[40];
    he_quote(p, he_token_end(p, line->end), token, sizeof token);
    return he_line_fail(err, status, line, p, "'%s' %s", token, what);
}

he_status he_token_any_number(const he_line *line, const char **p, double *value, bool *finite,
                              he_error *err)
{
    size_t used = 0;
    he_status status = he_double_parse(*p, line->end, HE_FILE_NUMBER, value, &used);
    if (status == HE_SYNTAX || !he_token_ends(*p + used, line->end)) {
        return he_token_fail(err, HE_SYNTAX, line, *p, "is not a number");
    }
    *finite = status == HE_OK;
    *value = *finite ? *value : 0;
    *p += used;
    return HE_OK;
}

he_status he_token_number(const he_line *line, const char **p, double *value, he_error *err)
{
    const char *begin = *p;
    bool finite = true;
    he_status status = he_token_any_number(line, p, value, &finite, err);
    if (status == HE_OK && !finite) {
        return he_token_fail(err, HE_NOT_FINITE, line, begin, "is not finite");
    }
    return status;
}
