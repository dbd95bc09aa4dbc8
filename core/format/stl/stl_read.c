#include "format/stl/stl.h"

#include "format/io/face_groups.h"
#include "format/io/weld.h"
#include "format/text/lines.h"

#include <math.h>
#include <string.h>

/* The number of bytes that are examined to distinguish text from binary, and the sizes and offsets
 * of binary parts. */
enum { HEAD = 512, COUNT_AT = 80, HEADER = 84, FACET = 50, FIRST_CORNER = 12, AHEAD = 6 };

typedef enum kind { UNKNOWN, TEXT, BINARY } kind;

typedef struct stl {
    he_import *into;
    kind kind;
    he_weld weld;
    uint32_t corners[3]; /* corners of the facet being read */
    unsigned char head[HEAD];
    size_t head_count;

    /* text */
    he_lines lines;
    he_face_groups object;
    bool in_facet, in_solid, begun;
    /* corner_count: how many corners of the facet were read; numbers: how many numbers of the next
     * corner are still to come */
    unsigned corner_count, numbers;
    double number[3];
    uint64_t facet_line;
    uint64_t unknown; /* the first line with an unknown word, 0 if there is none */

    /* binary */
    uint64_t offset; /* offset of the next byte */
    uint64_t count, left;
    unsigned char held[HEADER]; /* the first bytes of an incomplete header or facet */
    size_t held_count, trailing;
    bool has_header;
} stl;

static he_status at_place(he_status status, he_place place, uint64_t at, he_error *err)
{
    if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
        err->place = place;
        err->at = at;
    }
    return status;
}

static he_status add_corner(stl *o, unsigned i, he_vec3 position, uint64_t at, he_error *err)
{
    he_soup *soup = &o->into->soup;
    size_t before = soup->vertex_count;
    he_status status = he_weld_vertex(&o->weld, soup, position, &o->corners[i], err);
    if (status == HE_OK && soup->vertex_count > before) {
        status = he_source_map_add(&o->into->vertices, o->corners[i], at, err);
    }
    return status;
}

static he_status add_facet(stl *o, uint64_t at, he_error *err)
{
    size_t face = o->into->soup.face_count;
    he_status status = he_soup_add_face(&o->into->soup, o->corners, 3, err);
    return status == HE_OK ? he_source_map_add(&o->into->faces, (uint32_t)face, at, err) : status;
}

/* --- text --- */

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c + ('a' - 'A')) : c;
}

static bool is(const char *p, const char *end, const char *word)
{
    while (p < end && *word != '\0' && lower(*p) == *word) {
        p++;
        word++;
    }
    return p == end && *word == '\0';
}

static he_status begin_solid(stl *o, const he_line *line, const char *p, he_error *err)
{
    o->begun = o->in_solid = true;
    p = he_skip_blanks(p, line->end);
    if (p == line->end && o->object.changes.count == 0) {
        return HE_OK;
    }
    return he_face_groups_set_name(&o->object, o->into->soup.face_count, line, p,
                                   &o->into->warnings, err);
}

/* Returns the end of the normal of a facet: the end of the line, or the word "outer". */
static const char *skip_normal(const he_line *line, const char *p)
{
    p = he_skip_blanks(p, line->end);
    while (!he_at_end(p, line->end) && !is(p, he_token_end(p, line->end), "outer")) {
        p = he_skip_blanks(he_token_end(p, line->end), line->end);
    }
    return p;
}

static he_status end_facet(stl *o, const he_line *line, const char *p, he_error *err)
{
    if (!o->in_facet) {
        return he_token_fail(err, HE_SYNTAX, line, p, "is outside a facet");
    }
    if (o->corner_count != 3) {
        return he_line_fail(err, HE_SYNTAX, line, p, "a facet has %u corners, not 3",
                            o->corner_count);
    }
    o->in_facet = false;
    return add_facet(o, o->facet_line, err);
}

static he_status read_word(stl *o, const he_line *line, const char **p, he_error *err)
{
    const char *word = *p, *end = he_token_end(word, line->end);
    *p = end;
    if (is(word, end, "vertex")) {
        if (!o->in_facet || o->corner_count == 3) {
            return he_token_fail(err, HE_SYNTAX, line, word,
                                 o->in_facet
                                     ? "begins a fourth vertex in a facet, which must have 3"
                                     : "is outside a facet");
        }
        o->numbers = 3;
    } else if (is(word, end, "facet") || is(word, end, "solid") || is(word, end, "endsolid")) {
        if (o->in_facet) {
            return he_token_fail(err, HE_SYNTAX, line, word, "comes inside a facet");
        }
        o->in_facet = lower(*word) == 'f';
        o->corner_count = 0;
        o->facet_line = line->number;
        *p = o->in_facet ? skip_normal(line, end) : line->end;
        if (lower(*word) == 's') {
            return begin_solid(o, line, end, err);
        }
        o->in_solid = o->in_solid && o->in_facet;
    } else if (is(word, end, "endfacet")) {
        return end_facet(o, line, word, err);
    } else if (!is(word, end, "outer") && !is(word, end, "loop") && !is(word, end, "endloop")) {
        he_warnings_add(
            &o->into->warnings,
            &(he_occurrence){.code = "unknown_keyword",
                             .text = "unknown keyword % is ignored, with the rest of its line",
                             .subject = word,
                             .length = (size_t)(end - word),
                             .place = HE_PLACE_LINE,
                             .at = line->number});
        o->unknown = o->unknown == 0 ? line->number : o->unknown;
        *p = line->end;
    }
    return HE_OK;
}

static he_status read_number(stl *o, const he_line *line, const char **p, he_error *err)
{
    he_status status = he_token_number(line, p, &o->number[3 - o->numbers], err);
    if (status == HE_OK && --o->numbers == 0) {
        const double *n = o->number;
        status = add_corner(o, o->corner_count++, (he_vec3){n[0], n[1], n[2]}, line->number, err);
    }
    return status;
}

static he_status read_line(void *context, const he_line *line, he_error *err)
{
    stl *o = context;
    he_status status = HE_OK;
    const char *p = he_skip_blanks(line->begin, line->end);
    while (status == HE_OK && !he_at_end(p, line->end)) {
        status = o->numbers > 0 ? read_number(o, line, &p, err) : read_word(o, line, &p, err);
        p = he_skip_blanks(p, line->end);
    }
    return at_place(status, HE_PLACE_LINE, line->number, err);
}

static he_status finish_text(stl *o, he_error *err)
{
    uint64_t last_line = he_lines_last(&o->lines);
    he_status status = he_lines_finish(&o->lines, err);
    if (status != HE_OK) {
        return status;
    }
    if (o->in_facet) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, last_line, "the file ends inside a facet");
    }
    if (o->into->soup.face_count == 0 && o->unknown != 0) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, o->unknown,
                          "not an STL file: it has no facets");
    }
    if (o->in_solid) {
        he_warnings_add(
            &o->into->warnings,
            &(he_occurrence){.code = "no_endsolid",
                             .text =
                                 "the last solid of the file is read, although it has no endsolid",
                             .place = HE_PLACE_LINE,
                             .at = last_line});
    }
    return he_face_groups_finish(&o->object, &o->into->soup, "object", err);
}

/* --- binary --- */

static uint32_t word_at(const unsigned char *p)
{
    return (uint32_t)p[3] << 24 | (uint32_t)p[2] << 16 | (uint32_t)p[1] << 8 | p[0];
}

static double float_at(const unsigned char *p)
{
    uint32_t bits = word_at(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static he_status take_header(stl *o, const unsigned char *bytes, he_error *err)
{
    uint64_t limit = o->into->soup.limits.faces;
    o->has_header = true;
    o->count = o->left = word_at(bytes + COUNT_AT);
    if (o->count > HE_MAX_ROWS) {
        return he_fail_at(err, HE_BAD_VALUE, HE_PLACE_BYTE, COUNT_AT,
                          "not an STL file: the body does not begin with \"solid\", and as a "
                          "binary file it would have %llu facets",
                          (unsigned long long)o->count);
    }
    if (limit != 0 && o->count > limit) {
        return he_fail_at(err, HE_LIMIT, HE_PLACE_BYTE, COUNT_AT,
                          "the file declares %llu facets, more than the limit of %llu",
                          (unsigned long long)o->count, (unsigned long long)limit);
    }
    return HE_OK;
}

static he_vec3 position_at(const unsigned char *p)
{
    return (he_vec3){float_at(p), float_at(p + 4), float_at(p + 8)};
}

/* Prefetches the positions of a facet that comes some facets later, because looking up a position
 * in the hash table is a random access. */
static void expect_facet(const stl *o, const unsigned char *bytes)
{
    for (unsigned i = 0; i < 3; i++) {
        he_weld_expect(&o->weld, position_at(bytes + FIRST_CORNER + 12 * i));
    }
}

static he_status take_facet(stl *o, const unsigned char *bytes, uint64_t at, he_error *err)
{
    he_status status = HE_OK;
    const unsigned char *p = bytes + FIRST_CORNER;
    for (unsigned i = 0; i < 3 && status == HE_OK; i++, p += 12) {
        status = add_corner(o, i, position_at(p), at, err);
    }
    if (status == HE_OK) {
        status = add_facet(o, at, err);
    }
    if (p[0] != 0 || p[1] != 0) {
        he_warnings_add(&o->into->warnings,
                        &(he_occurrence){.code = "attribute_bytes",
                                         .text = "the attribute bytes of a facet are ignored, "
                                                 "because they have no standard meaning",
                                         .place = HE_PLACE_BYTE,
                                         .at = at});
    }
    o->left--;
    return at_place(status, HE_PLACE_BYTE, at, err);
}

/* Handles bytes after the last facet. A few are padding, but as many as a facet has mean that the
 * header declares a wrong number of facets. */
static he_status take_trailing(stl *o, size_t n, he_error *err)
{
    if (o->trailing == 0) {
        he_warnings_add(&o->into->warnings,
                        &(he_occurrence){.code = "trailing_bytes",
                                         .text = "bytes after the last facet are ignored, because "
                                                 "the header declares no more facets",
                                         .place = HE_PLACE_BYTE,
                                         .at = o->offset});
    }
    o->trailing += n < FACET ? n : FACET;
    if (o->trailing >= FACET || o->count == 0) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, HEADER + FACET * o->count,
                          "the file has more than the %llu facets that it declares",
                          (unsigned long long)o->count);
    }
    return HE_OK;
}

static he_status take_bytes(stl *o, const unsigned char *p, const unsigned char *end, he_error *err)
{
    he_status status = HE_OK;
    while (p < end && status == HE_OK) {
        size_t there = (size_t)(end - p), size = o->has_header ? FACET : HEADER;
        if (o->has_header && o->left == 0) {
            status = take_trailing(o, there, err);
            o->offset += there;
            break;
        }
        const unsigned char *bytes = p;
        if (o->held_count > 0 || there < size) {
            size_t n = size - o->held_count < there ? size - o->held_count : there;
            memcpy(o->held + o->held_count, p, n);
            o->held_count += n;
            o->offset += n;
            p += n;
            if (o->held_count < size) {
                break;
            }
            o->held_count = 0;
            bytes = o->held;
        } else {
            p += size;
            o->offset += size;
            if (o->has_header && (size_t)(end - p) >= (AHEAD + 1) * FACET) {
                expect_facet(o, p + AHEAD * FACET);
            }
        }
        status = o->has_header ? take_facet(o, bytes, o->offset - size, err)
                               : take_header(o, bytes, err);
    }
    return status;
}

static he_status finish_binary(const stl *o, he_error *err)
{
    if (!o->has_header) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, o->offset,
                          "not an STL file: the body does not begin with \"solid\", and has no "
                          "binary header of %d bytes",
                          HEADER);
    }
    if (o->left > 0) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_BYTE, o->offset,
                          "the file ends after %llu of the %llu facets that it declares",
                          (unsigned long long)(o->count - o->left), (unsigned long long)o->count);
    }
    return HE_OK;
}

/* --- the functions that the table of formats (format.c) contains --- */

/* Returns true if the text begins with "solid", after blanks. */
static bool begins_solid(const char *p, const char *end)
{
    if (end - p >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0) {
        p += 3;
    }
    while (p < end && (*p == ' ' || *p == '\t' || *p == '\r' || *p == '\n')) {
        p++;
    }
    return end - p >= 5 && is(p, p + 5, "solid");
}

static void stl_close(void *state)
{
    stl *o = state;
    he_weld_clear(&o->weld);
    he_lines_clear(&o->lines);
    he_face_groups_clear(&o->object);
    he_mem_free(o);
}

static he_status stl_open(he_import *into, void **state, he_error *err)
{
    stl *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the STL file");
    }
    o->into = into;
    he_lines_init(&o->lines, read_line, o);
    o->lines.limit = into->soup.limits.bytes;
    *state = o;
    return HE_OK;
}

static he_status feed_known(stl *o, const void *bytes, size_t n, he_error *err)
{
    const unsigned char *p = bytes;
    return o->kind == TEXT ? he_lines_feed(&o->lines, bytes, n, err) : take_bytes(o, p, p + n, err);
}

static he_status decide(stl *o, he_error *err)
{
    const char *head = (const char *)o->head;
    bool text =
        begins_solid(head, head + o->head_count) && memchr(head, '\0', o->head_count) == NULL;
    o->kind = text ? TEXT : BINARY;
    /* The usual distance from facet to facet is seven lines in text. */
    he_source_map_init(&o->into->vertices, text ? HE_PLACE_LINE : HE_PLACE_BYTE, 0);
    he_source_map_init(&o->into->faces, text ? HE_PLACE_LINE : HE_PLACE_BYTE, text ? 7 : FACET);
    return feed_known(o, o->head, o->head_count, err);
}

static he_status stl_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    stl *o = state;
    const unsigned char *p = bytes;
    if (o->kind == UNKNOWN) {
        size_t room = HEAD - o->head_count, part = n < room ? n : room;
        memcpy(o->head + o->head_count, p, part);
        o->head_count += part;
        if (o->head_count < HEAD) {
            return HE_OK;
        }
        he_status status = decide(o, err);
        if (status != HE_OK) {
            return status;
        }
        p += part;
        n -= part;
    }
    return n == 0 ? HE_OK : feed_known(o, p, n, err);
}

static he_status stl_finish(void *state, he_error *err)
{
    stl *o = state;
    he_soup *soup = &o->into->soup;
    he_status status = o->kind == UNKNOWN ? decide(o, err) : HE_OK;
    if (status == HE_OK) {
        status = o->kind == TEXT ? finish_text(o, err) : finish_binary(o, err);
    }
    if (status == HE_OK) {
        he_warnings_add_count(&o->into->warnings, "welded",
                              "a corner of a facet is merged with another at the same position, "
                              "because STL files do not tell which facets are connected",
                              soup->corner_count - soup->vertex_count);
    }
    return status;
}

const he_reading he_stl_reading = {stl_open, stl_feed, stl_finish, stl_close, false};

/* Returns true if these bytes may be an STL file: text that begins with "solid", or binary. Binary
 * has no magic number; it is recognised by a NUL, which no text has, and a first facet whose
 * corners are finite. */
bool he_stl_sniff(const char *bytes, size_t n)
{
    if (begins_solid(bytes, bytes + n)) {
        return true;
    }
    const unsigned char *p = (const unsigned char *)bytes;
    if (n < HEADER + FACET || memchr(p, 0, HEADER + FACET) == NULL || word_at(p + COUNT_AT) == 0) {
        return false;
    }
    for (size_t i = 0; i < 12; i++) {
        if (!isfinite(float_at(p + HEADER + 4 * i)) && i >= 3) {
            return false;
        }
    }
    return true;
}
