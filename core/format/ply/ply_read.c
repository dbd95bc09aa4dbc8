#include "format/ply/ply.h"

#include "format/ply/ply_join.h"
#include "format/ply/ply_rows.h"
#include "format/text/number.h"

#include <math.h>
#include <string.h>

/* The most bytes of a line of the header; no real PLY file has longer ones. */
enum { HEADER_LINE = 1 << 16 };

typedef struct ply {
    he_import *into;
    he_lines lines; /* lines of the header, and of rows in ASCII */
    he_ply_header header;
    he_ply_rows rows;
    bool big;

    /* in binary */
    uint64_t offset; /* offset of the next byte */
    unsigned char *held;
    size_t held_count; /* number of bytes in `held`, which begin an incomplete row or value */
    uint64_t row_at;   /* offset in the file of the row being read; set only if the row has lists */
    bool in_row, in_list, trailing;
    size_t property;    /* the next property of the row */
    uint64_t list_left; /* how many values of the list are still to come */
} ply;

static void note(ply *o, const char *code, const char *text, uint64_t at)
{
    he_warnings_add(&o->into->warnings,
                    &(he_occurrence){.code = code, .text = text, .place = o->rows.unit, .at = at});
}

/* --- ascii --- */

static he_status too_short(const ply *o, const he_line *line, he_error *err)
{
    return he_line_fail(err, HE_SYNTAX, line, line->begin,
                        "the line of element '%s' ends before its last value",
                        o->rows.element->name);
}

/* Reads a token of the line that must be a whole number. */
static he_status read_whole(const he_line *line, const char **p, const char *what, int64_t *value,
                            he_error *err)
{
    size_t used = 0;
    bool plus = *p < line->end && **p == '+';
    he_status status = he_i64_parse(*p + plus, line->end, value, &used);
    if (status == HE_SYNTAX || !he_token_ends(*p + plus + used, line->end)) {
        return he_token_fail(err, HE_SYNTAX, line, *p, what);
    }
    if (status != HE_OK) {
        *value = **p == '-' ? INT64_MIN : INT64_MAX; /* out of range: the caller refuses this value
                                                        with a message of its own */
    }
    *p += plus + used;
    return HE_OK;
}

/* Reads a value of property k. A value that is not finite is refused in a position; in another
 * property he_ply_rows_value replaces it by 0. */
static he_status read_value(ply *o, const he_line *line, const char **p, size_t k, he_error *err)
{
    double value = 0;
    bool finite = true;
    bool position = he_ply_rows_role(&o->rows, k) == HE_PLY_POSITION;
    he_status status = position ? he_token_number(line, p, &value, err)
                                : he_token_any_number(line, p, &value, &finite, err);
    if (status != HE_OK) {
        return status;
    }
    return he_ply_rows_value(&o->rows, k, finite ? value : (double)NAN, err);
}

static he_status read_list(ply *o, const he_line *line, const char **p, size_t k, he_error *err)
{
    const he_ply_property *property = &o->header.properties[o->rows.element->first + k];
    bool ignored = he_ply_rows_role(&o->rows, k) == HE_PLY_IGNORED;
    int64_t count = 0, value = 0;
    he_status status = read_whole(
        line, p, "is not a whole number, but the count of a list must be one", &count, err);
    if (status == HE_OK) {
        status = he_ply_rows_list(&o->rows, k, count, err);
    }
    for (; status == HE_OK && count > 0; count--) {
        *p = he_skip_blanks(*p, line->end);
        if (he_at_end(*p, line->end)) {
            return too_short(o, line, err);
        }
        if (ignored) {
            *p = he_token_end(*p, line->end);
            continue;
        }
        if (property->type >= HE_PLY_FLOAT) {
            double number = 0;
            bool finite;
            status = he_token_any_number(line, p, &number, &finite, err);
            if (status == HE_OK) {
                status = he_ply_rows_fraction(&o->rows, k, finite ? number : (double)NAN, err);
            }
            continue;
        }
        status = read_whole(line, p, "is not a valid corner of a face", &value, err);
        if (status == HE_OK) {
            status = he_ply_rows_item(&o->rows, k, value, err);
        }
    }
    return status;
}

static he_status read_row(ply *o, const he_line *line, const char *p, he_error *err)
{
    const he_ply_property *properties = o->header.properties + o->rows.element->first;
    he_status status = he_ply_rows_begin(&o->rows, err);
    for (size_t k = 0; k < o->rows.element->properties && status == HE_OK; k++) {
        p = he_skip_blanks(p, line->end);
        if (he_at_end(p, line->end)) {
            return too_short(o, line, err);
        }
        status =
            properties[k].list ? read_list(o, line, &p, k, err) : read_value(o, line, &p, k, err);
    }
    if (status == HE_OK && !he_at_end(he_skip_blanks(p, line->end), line->end)) {
        note(o, "extra_numbers",
             "text at the end of a line is ignored, because the header declares no value for it",
             line->number);
    }
    return status == HE_OK ? he_ply_rows_end(&o->rows, err) : status;
}

static bool is_comment(const char *p, const char *end)
{
    return end - p >= 7 && memcmp(p, "comment", 7) == 0 && he_token_ends(p + 7, end);
}

static he_status begin_body(ply *o, he_error *err)
{
    size_t longest = sizeof(double);
    for (size_t i = 0; i < o->header.count; i++) {
        size_t stride = o->header.elements[i].stride;
        longest = stride > longest ? stride : longest;
    }
    o->held = he_mem_alloc(longest);
    if (o->held == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a row of %zu bytes", longest);
    }
    o->big = o->header.encoding == HE_PLY_BIG_ENDIAN;
    o->lines.limit = o->into->soup.limits.bytes;
    he_status status = he_ply_rows_open(&o->rows, o->into, &o->header, err);
    if (status == HE_OK) {
        he_ply_rows_next(&o->rows);
    }
    return status;
}

static he_status read_line(void *context, const he_line *line, he_error *err)
{
    ply *o = context;
    he_ply_rows *rows = &o->rows;
    if (!o->header.ended) {
        he_status status = he_ply_header_read(&o->header, line, err);
        return status == HE_OK && o->header.ended ? begin_body(o, err) : status;
    }
    const char *p = he_skip_blanks(line->begin, line->end);
    if (he_at_end(p, line->end) || is_comment(p, line->end)) {
        return HE_OK;
    }
    rows->at = line->number;
    if (rows->element == NULL) {
        note(o, "trailing_lines",
             "a line after the last row is ignored, because the header declares no more rows",
             line->number);
        return HE_OK;
    }
    he_status status = HE_OK;
    if (rows->wanted) {
        status = read_row(o, line, p, err);
    } else {
        rows->left--;
    }
    if (status == HE_OK && rows->left == 0) {
        he_ply_rows_next(rows);
    }
    return status;
}

/* --- binary --- */

static uint32_t bytes_16(const unsigned char *p, bool big)
{
    return big ? (uint32_t)p[0] << 8 | p[1] : (uint32_t)p[1] << 8 | p[0];
}

static uint32_t bytes_32(const unsigned char *p, bool big)
{
    return big ? bytes_16(p, true) << 16 | bytes_16(p + 2, true)
               : bytes_16(p + 2, false) << 16 | bytes_16(p, false);
}

static uint64_t bytes_64(const unsigned char *p, bool big)
{
    return big ? (uint64_t)bytes_32(p, true) << 32 | bytes_32(p + 4, true)
               : (uint64_t)bytes_32(p + 4, false) << 32 | bytes_32(p, false);
}

static int64_t whole_of(const unsigned char *p, he_ply_type type, bool big)
{
    switch (type) {
    case HE_PLY_INT8:
        return (int8_t)p[0];
    case HE_PLY_UINT8:
        return p[0];
    case HE_PLY_INT16:
        return (int16_t)bytes_16(p, big);
    case HE_PLY_UINT16:
        return bytes_16(p, big);
    case HE_PLY_INT32:
        return (int32_t)bytes_32(p, big);
    case HE_PLY_UINT32:
        return bytes_32(p, big);
    case HE_PLY_FLOAT:
    case HE_PLY_DOUBLE:
    case HE_PLY_TYPE_COUNT:
        break;
    }
    return 0;
}

static double value_of(const unsigned char *p, he_ply_type type, bool big)
{
    if (type == HE_PLY_FLOAT) {
        uint32_t bits = bytes_32(p, big);
        float value;
        memcpy(&value, &bits, sizeof value);
        return (double)value;
    }
    if (type == HE_PLY_DOUBLE) {
        uint64_t bits = bytes_64(p, big);
        double value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    return (double)whole_of(p, type, big);
}

/* Takes the next `size` bytes of the input, the first of which may have been kept from an earlier
 * piece. If they have not all come, keeps those that have come and returns false. */
static bool take(ply *o, const unsigned char **p, const unsigned char *end, size_t size,
                 const unsigned char **bytes)
{
    size_t there = (size_t)(end - *p), wanted = size - o->held_count;
    size_t n = there < wanted ? there : wanted;
    *bytes = *p;
    if (n < size) {
        memcpy(o->held + o->held_count, *p, n);
        o->held_count += n;
        *bytes = o->held;
    }
    *p += n;
    o->offset += n;
    if (n < wanted) {
        return false;
    }
    o->held_count = 0;
    o->rows.at = o->offset - size;
    return true;
}

/* Adds a row without lists. */
static he_status take_row(ply *o, const unsigned char *bytes, he_error *err)
{
    const he_ply_element *e = o->rows.element;
    const he_ply_property *properties = o->header.properties + e->first;
    he_status status = he_ply_rows_begin(&o->rows, err);
    for (size_t k = 0; k < e->properties && status == HE_OK; k++) {
        if (he_ply_rows_role(&o->rows, k) != HE_PLY_IGNORED) {
            status =
                he_ply_rows_value(&o->rows, k, value_of(bytes, properties[k].type, o->big), err);
        }
        bytes += he_ply_type_bytes(properties[k].type);
    }
    return status == HE_OK ? he_ply_rows_end(&o->rows, err) : status;
}

/* Skips rows of fixed length of an element of which nothing is stored. */
static void skip_rows(ply *o, const unsigned char **p, const unsigned char *end)
{
    const unsigned char *bytes;
    size_t stride = o->rows.element->stride;
    if (o->held_count == 0) {
        uint64_t n = (uint64_t)(end - *p) / stride;
        n = n < o->rows.left ? n : o->rows.left;
        *p += n * stride;
        o->offset += n * stride;
        o->rows.left -= n;
    }
    if (o->rows.left > 0 && take(o, p, end, stride, &bytes)) {
        o->rows.left--;
    }
}

static he_status take_rows(ply *o, const unsigned char **p, const unsigned char *end, he_error *err)
{
    size_t stride = o->rows.element->stride;
    he_status status = HE_OK;
    if (!o->rows.wanted) {
        skip_rows(o, p, end);
        return HE_OK;
    }
    const unsigned char *bytes;
    while (o->rows.left > 0 && status == HE_OK && take(o, p, end, stride, &bytes)) {
        status = take_row(o, bytes, err);
    }
    return status;
}

/* Adds as many values of a list as have come with this piece of the input. */
static he_status take_items(ply *o, const unsigned char **p, const unsigned char *end,
                            he_error *err)
{
    const he_ply_property *property = &o->header.properties[o->rows.element->first + o->property];
    size_t size = he_ply_type_bytes(property->type);
    if (he_ply_rows_role(&o->rows, o->property) == HE_PLY_IGNORED && o->held_count == 0) {
        uint64_t there = (uint64_t)(end - *p) / size;
        uint64_t n = there < o->list_left ? there : o->list_left;
        *p += n * size;
        o->offset += n * size;
        o->list_left -= n;
    }
    const unsigned char *bytes;
    bool fraction = property->type >= HE_PLY_FLOAT;
    while (o->list_left > 0 && take(o, p, end, size, &bytes)) {
        o->list_left--;
        if (he_ply_rows_role(&o->rows, o->property) == HE_PLY_IGNORED) {
            continue;
        }
        he_status status = fraction
                               ? he_ply_rows_fraction(&o->rows, o->property,
                                                      value_of(bytes, property->type, o->big), err)
                               : he_ply_rows_item(&o->rows, o->property,
                                                  whole_of(bytes, property->type, o->big), err);
        if (status != HE_OK) {
            return status;
        }
    }
    return HE_OK;
}

/* Adds one property of a row that has lists, or as much of it as has come. */
static he_status take_property(ply *o, const unsigned char **p, const unsigned char *end,
                               he_error *err)
{
    const he_ply_property *property = &o->header.properties[o->rows.element->first + o->property];
    he_status status = HE_OK;
    if (!o->in_list) {
        he_ply_type type = property->list ? property->count : property->type;
        const unsigned char *bytes;
        if (!take(o, p, end, he_ply_type_bytes(type), &bytes)) {
            return HE_OK;
        }
        if (!property->list) {
            o->property++;
            return he_ply_rows_value(&o->rows, o->property - 1, value_of(bytes, type, o->big), err);
        }
        int64_t count = whole_of(bytes, type, o->big);
        status = he_ply_rows_list(&o->rows, o->property, count, err);
        o->in_list = true;
        o->list_left = (uint64_t)count;
    }
    if (status == HE_OK) {
        status = take_items(o, p, end, err);
    }
    if (o->list_left == 0) {
        o->in_list = false;
        o->property++;
    }
    return status;
}

/* take_plain reads rows of up to this many corners. The byte that declares their number can
 * declare more corners. */
enum { PLAIN_CORNERS = 16 };

/* Returns true if each row of the element is only a list of corners, with a byte for the length
 * and 32 bits for each corner, as in nearly every file. */
static bool is_plain(const ply *o)
{
    const he_ply_element *e = o->rows.element;
    const he_ply_property *property = &o->header.properties[e->first];
    return e->properties == 1 && he_ply_rows_role(&o->rows, 0) == HE_PLY_CORNERS &&
           property->count == HE_PLY_UINT8 &&
           (property->type == HE_PLY_INT32 || property->type == HE_PLY_UINT32);
}

/* Adds rows that are only lists of corners, quickly, up to the first row that is unusual or
 * incomplete. */
static he_status take_plain(ply *o, const unsigned char **p, const unsigned char *end,
                            he_error *err)
{
    uint32_t corners[PLAIN_CORNERS];
    he_status status = HE_OK;
    while (o->rows.left > 0 && *p < end && status == HE_OK) {
        const unsigned char *row = *p;
        size_t count = row[0], size = 1 + count * sizeof *corners;
        uint64_t highest = 0;
        if (count > PLAIN_CORNERS || size > (size_t)(end - row)) {
            break;
        }
        for (size_t i = 0; i < count; i++) {
            corners[i] = bytes_32(row + 1 + i * sizeof *corners, o->big);
            highest = corners[i] > highest ? corners[i] : highest;
        }
        o->rows.at = o->offset;
        if (highest > INT32_MAX || highest >= o->rows.vertices ||
            !he_ply_rows_face(&o->rows, corners, count, &status, err)) {
            break;
        }
        *p += size;
        o->offset += size;
    }
    return status;
}

static he_status take_lists(ply *o, const unsigned char **p, const unsigned char *end,
                            he_error *err)
{
    he_status status = HE_OK;
    while (o->rows.left > 0 && status == HE_OK && (*p < end || o->property > 0)) {
        if (!o->in_row) {
            status = is_plain(o) ? take_plain(o, p, end, err) : HE_OK;
            if (o->rows.left == 0 || *p == end || status != HE_OK) {
                break;
            }
            o->rows.at = o->row_at = o->offset;
            o->in_row = true;
            status = he_ply_rows_begin(&o->rows, err);
        } else if (o->property < o->rows.element->properties) {
            if (*p == end) {
                break;
            }
            status = take_property(o, p, end, err);
        } else {
            o->rows.at = o->row_at;
            status = he_ply_rows_end(&o->rows, err);
            o->in_row = false;
            o->property = 0;
        }
    }
    return status;
}

static he_status take_bytes(ply *o, const unsigned char *p, const unsigned char *end, he_error *err)
{
    he_status status = HE_OK;
    while (p < end && o->rows.element != NULL && status == HE_OK) {
        status = o->rows.element->lists ? take_lists(o, &p, end, err) : take_rows(o, &p, end, err);
        if (status == HE_OK && o->rows.left == 0) {
            he_ply_rows_next(&o->rows);
        }
    }
    if (status == HE_OK && p < end) {
        if (!o->trailing) {
            note(o, "trailing_bytes",
                 "bytes after the last row are ignored, because the header declares no more rows",
                 o->offset);
            o->trailing = true;
        }
        o->offset += (uint64_t)(end - p);
    }
    return status;
}

/* --- the functions that the table of formats (format.c) contains --- */

static void ply_close(void *state)
{
    ply *o = state;
    he_lines_clear(&o->lines);
    he_ply_rows_clear(&o->rows);
    he_ply_header_clear(&o->header);
    he_mem_free(o->held);
    he_mem_free(o);
}

static he_status ply_open(he_import *into, void **state, he_error *err)
{
    ply *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the PLY file");
    }
    o->into = into;
    he_lines_init(&o->lines, read_line, o);
    o->lines.limit = HEADER_LINE;
    *state = o;
    return HE_OK;
}

/* Feeds a piece of the file. The header is read line by line, because binary data may begin after
 * it. */
static he_status ply_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    ply *o = state;
    const char *p = bytes, *end = p + n;
    while (p < end && !o->header.ended) {
        const char *stop = he_line_stop(p, end);
        he_status status = he_lines_feed(&o->lines, p, (size_t)(stop - p), err);
        if (status != HE_OK) {
            return status;
        }
        o->offset += (uint64_t)(stop - p);
        p = stop;
    }
    if (p == end) {
        return HE_OK;
    }
    return o->header.encoding == HE_PLY_ASCII
               ? he_lines_feed(&o->lines, p, (size_t)(end - p), err)
               : take_bytes(o, (const unsigned char *)p, (const unsigned char *)end, err);
}

static he_status ply_finish(void *state, he_error *err)
{
    ply *o = state;
    const he_ply_rows *rows = &o->rows;
    uint64_t last_line = he_lines_last(&o->lines);
    he_status status = he_lines_finish(&o->lines, err);
    if (status != HE_OK) {
        return status;
    }
    if (!o->header.ended) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, last_line, "%s",
                          o->header.begun ? "the file ends inside its header"
                                          : "not a PLY file: it is empty");
    }
    if (rows->element != NULL) {
        const he_ply_element *e = rows->element;
        return he_fail_at(
            err, HE_SYNTAX, rows->unit, rows->unit == HE_PLACE_LINE ? last_line : o->offset,
            "the file ends after %llu of the %llu rows of element '%s'",
            (unsigned long long)(e->rows - rows->left), (unsigned long long)e->rows, e->name);
    }
    return he_ply_join(o->into, &o->header, err);
}

const he_reading he_ply_reading = {ply_open, ply_feed, ply_finish, ply_close, false};

bool he_ply_sniff(const char *bytes, size_t n)
{
    const char *p = bytes, *end = bytes + n;
    if (n >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0) {
        p += 3;
    }
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n')) {
        p++;
    }
    return end - p >= 4 && memcmp(p, "ply", 3) == 0 &&
           (p[3] == '\n' || p[3] == '\r' || p[3] == ' ' || p[3] == '\t');
}
