#include "format/off/off.h"

#include "format/off/off_binary.h"
#include "format/text/lines.h"
#include "format/text/number.h"

#include <stdio.h>
#include <string.h>

/* The sections of an OFF file. The member `section` of the reader says to which of them the next
 * token belongs. */
typedef enum section {
    HEADER,
    VERTEX_COUNT,
    FACE_COUNT,
    EDGE_COUNT,
    VERTICES,
    FACES,
    DONE
} section;

/* The most numbers that are stored. A vertex has at most 3 + 3 + 4 + 2 numbers, for position,
 * normal, colour and texture coordinates. */
enum { VERTEX_NUMBERS = 16 };

typedef struct off {
    he_import *into;
    he_lines lines;
    section section;
    unsigned has;
    uint64_t vertices, faces;       /* how many the header declares */
    double numbers[VERTEX_NUMBERS]; /* numbers of the present vertex, or of the present face's
                                       colour */
    size_t number_count;            /* how many numbers were read; surplus ones are not stored */
    uint64_t number_line;           /* line on which the first of `numbers` was read */
    bool spread;                    /* true if some vertex continues on the next line */
    uint64_t lacking;  /* line of the first vertex that ends before its last number, or 0 */
    uint32_t integers; /* bit i is set if numbers[i] was written as an integer */
    /* True if the last face is incomplete: `missing` of its corners are still to come. */
    bool open;
    uint64_t missing;
    he_off_values values;
    bool is_binary;
    he_off_binary binary; /* state of reading the body if the header says BINARY */
    uint64_t header_bytes;
} off;

static void note(off *o, const char *code, const char *text, const he_line *line)
{
    he_warnings_add(
        &o->into->warnings,
        &(he_occurrence){.code = code, .text = text, .place = HE_PLACE_LINE, .at = line->number});
}

/* Returns the flags that a header word such as STCNOFF stands for; -1 if it is no header, -2 if
 * positions have another number of dimensions than 3. */
static int header_flags(const char *p, const char *end)
{
    if (end - p == 3 && memcmp(p, "off", 3) == 0) {
        return 0;
    }
    int flags = 0;
    bool other = false;
    while (end - p > 3) {
        int flag = 0;
        if (*p == 'S' && p[1] == 'T') {
            flag = HE_OFF_UV;
            p++;
        } else if (*p == 'C') {
            flag = HE_OFF_COLORS;
        } else if (*p == 'N') {
            flag = HE_OFF_NORMALS;
        } else if (*p == '4' || *p == 'n') {
            other = true;
        } else {
            return -1;
        }
        if ((flags & flag) != 0) {
            return -1;
        }
        flags |= flag;
        p++;
    }
    if (end - p != 3 || memcmp(p, "OFF", 3) != 0) {
        return -1;
    }
    return other ? -2 : flags;
}

static he_status end_binary_header(const he_line *line, const char **p, he_error *err)
{
    *p = he_skip_blanks(he_token_end(*p, line->end), line->end);
    return he_at_end(*p, line->end)
               ? HE_OK
               : he_token_fail(err, HE_SYNTAX, line, *p,
                               "is not allowed on the line of the word BINARY");
}

static he_status read_header(off *o, const he_line *line, const char **p, he_error *err)
{
    const char *end = he_token_end(*p, line->end);
    int flags = header_flags(*p, end);
    o->section = VERTEX_COUNT;
    if (flags == -1) {
        if (**p >= '0' && **p <= '9') {
            return HE_OK; /* there is no header, and this token is the number of vertices */
        }
        return he_token_fail(err, HE_SYNTAX, line, *p, "is not the header of an OFF file");
    }
    const char *rest = he_skip_blanks(end, line->end);
    if (flags == -2) {
        return he_token_fail(
            err, HE_UNSUPPORTED, line, *p,
            "is not supported: this header declares points that do not have three dimensions");
    }
    o->has = (unsigned)flags;
    o->is_binary = he_token_end(rest, line->end) - rest == 6 && memcmp(rest, "BINARY", 6) == 0;
    *p = rest;
    return o->is_binary ? end_binary_header(line, p, err) : HE_OK;
}

static he_status read_count(const he_line *line, const char **p, const char *what, uint64_t limit,
                            uint64_t *count, he_error *err)
{
    uint64_t value = 0;
    size_t used = 0;
    bool sign = **p == '+';
    he_status status = he_u64_parse(*p + sign, line->end, &value, &used);
    used += sign;
    if (status == HE_SYNTAX || !he_token_ends(*p + used, line->end)) {
        return he_token_fail(err, HE_SYNTAX, line, *p, "is not a count");
    }
    char text[40];
    he_quote(*p, *p + used, text, sizeof text);
    if (status != HE_OK || value > HE_MAX_ROWS) {
        return he_line_fail(err, HE_BAD_VALUE, line, *p,
                            "the file declares %s %s, more than a mesh can have", text, what);
    }
    if (limit != 0 && value > limit) {
        return he_line_fail(err, HE_LIMIT, line, *p,
                            "the file declares %s %s, more than the limit of %llu", text, what,
                            (unsigned long long)limit);
    }
    *count = value;
    *p += used;
    return HE_OK;
}

static void begin_faces(off *o)
{
    o->section = o->faces > 0 ? FACES : DONE;
}

static void begin_vertices(off *o)
{
    o->section = VERTICES;
    if (o->vertices == 0) {
        begin_faces(o);
    }
}

static bool is_last_token(const he_line *line, const char *p)
{
    return he_at_end(he_skip_blanks(he_token_end(p, line->end), line->end), line->end);
}

/* Reads the number of edges, which is often wrong and therefore ignored. It may be missing: if it
 * is not on the line of the other counts, it must be alone on its line, because a vertex has more
 * than one number. */
static he_status read_edge_count(off *o, const he_line *line, const char **p, bool same_line,
                                 he_error *err)
{
    begin_vertices(o);
    if (!same_line && !is_last_token(line, *p)) {
        return HE_OK;
    }
    bool finite;
    he_import *into = o->into;
    he_status status = he_token_any_number(line, p, &into->edges, &finite, err);
    into->edges_line = line->number;
    if (status == HE_OK && !he_at_end(he_skip_blanks(*p, line->end), line->end)) {
        return he_token_fail(err, HE_SYNTAX, line, he_skip_blanks(*p, line->end),
                             "is not allowed after the three counts");
    }
    return status;
}

/* Returns true if a number is written as an integer. In a colour, 1 is one of 255 steps and 1.0
 * is full intensity, so the text of the number decides. */
static bool is_integer(const char *begin, const char *end, double value)
{
    for (const char *p = begin; p < end; p++) {
        if (*p < '0' || *p > '9') {
            return false;
        }
    }
    return value <= UINT32_MAX;
}

/* Adds the colour whose components are `count` numbers of the line, from number `first` on. */
static he_status add_color(off *o, he_colors *colors, size_t element, size_t first, size_t count,
                           he_error *err)
{
    uint32_t mask = ((UINT32_C(1) << count) - 1) << first;
    colors->fractions = colors->fractions || (o->integers & mask) != mask;
    return he_colors_add(colors, element, o->numbers + first, count, err);
}

static void forget_numbers(off *o)
{
    o->number_count = 0;
    o->integers = 0;
}

/* How many numbers of a vertex belong to its normal, its colour and its texture coordinates, which
 * follow the position in this order. */
typedef struct parts {
    size_t normal, color, uv;
} parts;

/* Divides the `count` numbers of a vertex among the values that the header declares. Values at
 * the end may be missing. Returns false if `count` does not fit the header. */
static bool divide(const off *o, size_t count, parts *out)
{
    parts p = {(o->has & HE_OFF_NORMALS) != 0 ? 3 : 0, 0, (o->has & HE_OFF_UV) != 0 ? 2 : 0};
    size_t known = 3 + p.normal + p.uv;
    if ((o->has & HE_OFF_COLORS) != 0) {
        p.color = count > known ? count - known : 0;
    }
    bool color = p.color == 1 || p.color == 3 || p.color == 4;
    if (count >= known + p.color && ((o->has & HE_OFF_COLORS) == 0 || color)) {
        *out = p;
        return true;
    }
    *out = (parts){.normal = p.normal};
    if (count == 3 + p.normal) {
        return true;
    }
    *out = (parts){0};
    return count == 3;
}

static he_status end_vertex(off *o, const he_line *line, he_error *err)
{
    he_soup *soup = &o->into->soup;
    const double *n = o->numbers;
    size_t vertex = soup->vertex_count, count = o->number_count;
    parts p;
    bool spread = o->number_line != line->number, fits = divide(o, count, &p);
    size_t color_at = 3 + p.normal, end = color_at + p.color + p.uv;
    bool lacking = fits && (((o->has & HE_OFF_NORMALS) != 0 && p.normal == 0) ||
                            ((o->has & HE_OFF_COLORS) != 0 && p.color == 0) ||
                            ((o->has & HE_OFF_UV) != 0 && p.uv == 0));
    o->spread |= spread;
    o->lacking = o->lacking == 0 && lacking ? line->number : o->lacking;
    /* If a vertex continues on the next line, surplus numbers there belong to the next vertex. In a
     * file with such a vertex no vertex may omit its last values, because it could not be
     * distinguished from one that continues. */
    if (!fits || (spread && count > end) || (o->spread && o->lacking != 0)) {
        return he_line_fail(
            err, HE_SYNTAX, line, line->begin,
            "the line has %zu numbers, which does not match what the header declares for a vertex",
            count);
    }
    he_status status = he_soup_add_vertex(soup, (he_vec3){n[0], n[1], n[2]}, err);
    if (status == HE_OK && p.normal > 0) {
        status = he_off_add_normal(&o->values, n + 3, err);
    }
    if (status == HE_OK && p.color >= 3) {
        status = add_color(o, &o->values.vertex_colors, vertex, color_at, p.color, err);
    }
    if (status == HE_OK && p.uv > 0) {
        status = he_off_add_uv(&o->values, n + color_at + p.color, err);
    }
    if (p.color == 1) {
        note(o, "color_index",
             "a colour given by its index is ignored, because OFF files hold no colour map", line);
    }
    if (lacking) {
        note(o, "missing_numbers",
             "a vertex has no normal, colour or texture coordinates, although the header declares "
             "them, because its line is too short",
             line);
    }
    if (count > end) {
        note(o, "extra_numbers",
             "numbers at the end of the line of a vertex are ignored, because the header does not "
             "declare them",
             line);
    }
    forget_numbers(o);
    if (soup->vertex_count == o->vertices) {
        begin_faces(o);
    }
    return he_line_locate(status, line, err);
}

/* Reads numbers up to the end of the line, and appends them to o->numbers. The first `finite` of
 * all these numbers must be finite. */
static he_status read_numbers(off *o, const he_line *line, const char **p, size_t finite,
                              bool colors, he_error *err)
{
    const char *q = *p;
    while (!he_at_end(q, line->end)) {
        const char *begin = q;
        double value;
        bool is_finite = true;
        he_status status = o->number_count < finite
                               ? he_token_number(line, &q, &value, err)
                               : he_token_any_number(line, &q, &value, &is_finite, err);
        if (status != HE_OK) {
            return status;
        }
        if (!is_finite) {
            note(o, "not_finite", "a number of the file is read as 0, because it is not finite",
                 line);
        }
        if (o->number_count < VERTEX_NUMBERS) {
            o->numbers[o->number_count] = value;
            if (colors && is_integer(begin, q, value)) {
                o->integers |= UINT32_C(1) << o->number_count;
            }
        }
        o->number_count++;
        q = he_skip_blanks(q, line->end);
    }
    *p = q;
    return HE_OK;
}

static he_status read_vertex(off *o, const he_line *line, const char **p, he_error *err)
{
    size_t needed = 3;
    needed += (o->has & HE_OFF_NORMALS) != 0 ? 3 : 0;
    needed += (o->has & HE_OFF_COLORS) != 0 ? 1 : 0;
    needed += (o->has & HE_OFF_UV) != 0 ? 2 : 0;
    if (o->number_count == 0) {
        o->number_line = line->number;
        he_status status = he_source_map_add(
            &o->into->vertices, (uint32_t)o->into->soup.vertex_count, line->number, err);
        if (status != HE_OK) {
            return status;
        }
    }
    he_status status = read_numbers(o, line, p, 3, (o->has & HE_OFF_COLORS) != 0, err);
    size_t enough = o->number_line == line->number ? 3 : needed;
    if (status != HE_OK || o->number_count < enough) {
        return status; /* the vertex continues on the next line */
    }
    return end_vertex(o, line, err);
}

/* Reads the colour that follows the corners of a face, up to the end of the line. */
static he_status read_face_color(off *o, const he_line *line, const char **p, he_error *err)
{
    he_status status = read_numbers(o, line, p, 0, true, err);
    size_t count = o->number_count;
    if (status == HE_OK && (count == 3 || count == 4)) {
        status = add_color(o, &o->values.face_colors, o->into->soup.face_count - 1, 0, count, err);
    } else if (count == 1) {
        note(o, "color_index",
             "a colour given by its index is ignored, because OFF files hold no colour map", line);
    } else if (count > 0) {
        note(o, "extra_numbers",
             "numbers after the corners of a face are ignored, because a colour has 3 or 4 numbers",
             line);
    }
    forget_numbers(o);
    return status;
}

static he_status read_corner(off *o, const he_line *line, const char **p, he_error *err)
{
    uint64_t value = 0;
    size_t used = 0;
    bool negative = **p == '-', sign = negative || **p == '+';
    he_status status = he_u64_parse(*p + sign, line->end, &value, &used);
    if (status == HE_SYNTAX || !he_token_ends(*p + sign + used, line->end)) {
        return he_token_fail(err, HE_SYNTAX, line, *p, "is not a valid corner of a face");
    }
    if (status != HE_OK || value >= o->vertices || negative) {
        char text[40];
        he_quote(*p, *p + sign + used, text, sizeof text);
        return he_line_fail(err, HE_BAD_INDEX, line, *p,
                            "there is no vertex %s; the vertices are 0 to %lld", text,
                            (long long)o->vertices - 1);
    }
    *p += sign + used;
    o->missing--;
    return he_soup_add_corner(&o->into->soup, (uint32_t)value, err);
}

/* Reads the numbers of an ordinary line: integers with one blank between them. Returns 0 if the
 * line is not ordinary, or has more than `room` numbers. */
static size_t plain_numbers(const char *p, const char *end, uint32_t *numbers, size_t room)
{
    size_t count = 0;
    while (p < end) {
        uint64_t value = 0;
        size_t used = 0;
        if (count == room || he_u64_parse(p, end, &value, &used) != HE_OK || value > UINT32_MAX) {
            return 0;
        }
        p += used;
        if (p < end && *p++ != ' ') {
            return 0;
        }
        numbers[count++] = (uint32_t)value;
    }
    return count;
}

/* Reads a face quickly if it is an ordinary line. Returns false, and does nothing, for any other
 * face, which is then read number by number. */
static bool read_plain_face(off *o, const he_line *line, const char **p, he_status *status,
                            he_error *err)
{
    enum { ROOM = 16 };
    he_soup *soup = &o->into->soup;
    uint32_t numbers[ROOM];
    size_t count = plain_numbers(*p, line->end, numbers, ROOM);
    bool plain = count > 1 && numbers[0] == count - 1 &&
                 (soup->limits.corners == 0 || numbers[0] <= soup->limits.corners);
    for (size_t i = 1; i < count && plain; i++) {
        plain = numbers[i] < o->vertices;
    }
    he_status added = plain ? he_soup_add_face(soup, numbers + 1, count - 1, err) : HE_LIMIT;
    if (added == HE_LIMIT) {
        return false;
    }
    if (added == HE_OK) {
        added =
            he_source_map_add(&o->into->faces, (uint32_t)soup->face_count - 1, line->number, err);
    }
    if (soup->face_count == o->faces) {
        o->section = DONE;
    }
    *p = line->end;
    *status = he_line_locate(added, line, err);
    return true;
}

static he_status read_face(off *o, const he_line *line, const char **p, he_error *err)
{
    he_soup *soup = &o->into->soup;
    he_status status = HE_OK;
    if (!o->open && read_plain_face(o, line, p, &status, err)) {
        return status;
    }
    if (!o->open) {
        status = read_count(line, p, "corners in a face", soup->limits.corners, &o->missing, err);
        if (status == HE_OK) {
            status =
                he_source_map_add(&o->into->faces, (uint32_t)soup->face_count, line->number, err);
        }
        if (status == HE_OK) {
            status = he_soup_begin_face(soup, err);
        }
        o->open = true;
        *p = he_skip_blanks(*p, line->end);
    }
    while (status == HE_OK && o->missing > 0 && !he_at_end(*p, line->end)) {
        status = read_corner(o, line, p, err);
        *p = he_skip_blanks(*p, line->end);
    }
    if (status == HE_OK && o->missing == 0) {
        o->open = false;
        status = read_face_color(o, line, p, err);
        if (soup->face_count == o->faces) {
            o->section = DONE;
        }
    }
    return he_line_locate(status, line, err);
}

static he_status read_line(void *context, const he_line *line, he_error *err)
{
    off *o = context;
    he_soup *soup = &o->into->soup;
    const char *begin = he_skip_blanks(line->begin, line->end), *p = begin;
    he_status status = HE_OK;
    bool counts = false; /* the numbers of vertices and faces are on this line */
    while (status == HE_OK && !he_at_end(p, line->end)) {
        switch (o->section) {
        case HEADER:
            status = read_header(o, line, &p, err);
            break;
        case VERTEX_COUNT:
            status = read_count(line, &p, "vertices", soup->limits.vertices, &o->vertices, err);
            o->section = FACE_COUNT;
            break;
        case FACE_COUNT:
            status = read_count(line, &p, "faces", soup->limits.faces, &o->faces, err);
            o->section = EDGE_COUNT;
            counts = true;
            break;
        case EDGE_COUNT:
            status = read_edge_count(o, line, &p, counts, err);
            break;
        case VERTICES:
            status = read_vertex(o, line, &p, err);
            break;
        case FACES:
            status = read_face(o, line, &p, err);
            break;
        case DONE:
            return he_token_fail(err, HE_SYNTAX, line, p,
                                 "comes after the last face: the header declares no more faces");
        }
        p = he_skip_blanks(p, line->end);
    }
    return status;
}

static void off_close(void *state)
{
    off *o = state;
    he_lines_clear(&o->lines);
    he_off_values_clear(&o->values);
    he_mem_free(o);
}

static he_status off_open(he_import *into, void **state, he_error *err)
{
    off *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the OFF file");
    }
    o->into = o->values.into = into;
    he_lines_init(&o->lines, read_line, o);
    o->lines.limit = into->soup.limits.bytes;
    he_source_map_init(&into->vertices, HE_PLACE_LINE, 1);
    he_source_map_init(&into->faces, HE_PLACE_LINE, 1);
    *state = o;
    return HE_OK;
}

/* Adds a possible cause to an error: if vertices were read without some of their values, the
 * missing numbers may have been on the next line, and everything after them was misread. */
static he_status explain(const off *o, he_status status, he_error *err)
{
    if (o->lacking != 0 && err != NULL && (status == HE_SYNTAX || status == HE_BAD_INDEX)) {
        size_t length = strlen(err->text);
        snprintf(err->text + length, sizeof err->text - length,
                 "; from line %llu on, vertices lack values that the header announces, which must "
                 "be on the same line",
                 (unsigned long long)o->lacking);
    }
    return status;
}

static void begin_binary(off *o)
{
    he_off_binary_init(&o->binary, &o->values, o->has, o->header_bytes);
}

/* Feeds the header, line by line because binary data may follow it. */
static he_status feed_header(off *o, const char **p, const char *end, he_error *err)
{
    const char *stop = he_line_stop(*p, end);
    size_t n = (size_t)(stop - *p);
    he_status status = he_lines_feed(&o->lines, *p, n, err);
    o->header_bytes += n;
    *p = stop;
    if (status == HE_OK && o->is_binary) {
        begin_binary(o);
    }
    return status;
}

static he_status off_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    off *o = state;
    const char *p = bytes, *end = p + n;
    he_status status = HE_OK;
    while (p < end && status == HE_OK && o->section == HEADER) {
        status = feed_header(o, &p, end, err);
    }
    if (status != HE_OK || p == end) {
        return status;
    }
    size_t left = (size_t)(end - p);
    return o->is_binary ? he_off_binary_feed(&o->binary, (const unsigned char *)p, left, err)
                        : explain(o, he_lines_feed(&o->lines, p, left, err), err);
}

static he_status too_short(uint64_t last_line, const char *what, size_t came, uint64_t announced,
                           he_error *err)
{
    return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, last_line,
                      "the file ends after %zu of the %llu %s that it declares", came,
                      (unsigned long long)announced, what);
}

static he_status finish(off *o, he_error *err)
{
    he_soup *soup = &o->into->soup;
    uint64_t last_line = he_lines_last(&o->lines);
    he_status status = he_lines_finish(&o->lines, err);
    if (status != HE_OK) {
        return status;
    }
    if (o->is_binary) {
        if (o->binary.values == NULL) { /* the file ends inside the line of the header */
            begin_binary(o);
        }
        return he_off_binary_finish(&o->binary, err);
    }
    switch (o->section) {
    case HEADER:
    case VERTEX_COUNT:
    case FACE_COUNT:
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, last_line,
                          "the file ends before its counts of vertices, faces and edges");
    case EDGE_COUNT:
        begin_vertices(o);
        break;
    case VERTICES:
    case FACES:
    case DONE:
        break;
    }
    if (soup->vertex_count < o->vertices) {
        return too_short(last_line, "vertices", soup->vertex_count, o->vertices, err);
    }
    if (soup->face_count - o->open < o->faces) {
        return too_short(last_line, "faces", soup->face_count - o->open, o->faces, err);
    }
    return he_off_values_finish(&o->values, err);
}

static he_status off_finish(void *state, he_error *err)
{
    off *o = state;
    return explain(o, finish(o, err), err);
}

const he_reading he_off_reading = {off_open, off_feed, off_finish, off_close, false};

/* Returns true if these bytes begin with the header of an OFF file; an OFF file without a header
 * cannot be recognised. */
bool he_off_sniff(const char *bytes, size_t n)
{
    const char *p = bytes, *end = bytes + n;
    if (n >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0) {
        p += 3;
    }
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n' || *p == '#')) {
        if (*p == '#') {
            while (p < end && *p != '\n' && *p != '\r') {
                p++;
            }
        } else {
            p++;
        }
    }
    const char *token = p;
    while (p < end && p - token < 12 && *p > ' ' && *p != '#') {
        p++;
    }
    return header_flags(token, p) != -1;
}
