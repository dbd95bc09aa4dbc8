#include "format/ply/ply_header.h"

#include "format/text/number.h"

#include <string.h>

/* The most rows that an element may announce: more than any file has bytes, and small enough that a
 * product with a row's length fits into 64 bits. */
#define MOST_ROWS ((uint64_t)1 << 48)

static const struct {
    const char *name, *other;
    size_t bytes;
    he_type column;
} types[HE_PLY_TYPE_COUNT] = {
    {"char", "int8", 1, HE_INT32},     {"uchar", "uint8", 1, HE_UINT32},
    {"short", "int16", 2, HE_INT32},   {"ushort", "uint16", 2, HE_UINT32},
    {"int", "int32", 4, HE_INT32},     {"uint", "uint32", 4, HE_UINT32},
    {"float", "float32", 4, HE_FLOAT}, {"double", "float64", 8, HE_DOUBLE},
};

size_t he_ply_type_bytes(he_ply_type type)
{
    return types[type].bytes;
}

const char *he_ply_type_name(he_ply_type type)
{
    return types[type].name;
}

he_type he_ply_type_column(he_ply_type type)
{
    return types[type].column;
}

void he_ply_header_clear(he_ply_header *header)
{
    he_mem_free(header->elements);
    he_mem_free(header->properties);
    *header = (he_ply_header){0};
}

/* A word of the header. In the header '#' begins no comment, unlike in other text formats. */
typedef struct word {
    const char *begin, *end;
} word;

static word next_word(const he_line *line, const char **p)
{
    word w = {*p, line->end};
    while (w.begin < line->end && (*w.begin == ' ' || *w.begin == '\t')) {
        w.begin++;
    }
    w.end = w.begin;
    while (w.end < line->end && *w.end != ' ' && *w.end != '\t') {
        w.end++;
    }
    *p = w.end;
    return w;
}

static bool is(word w, const char *text)
{
    size_t length = (size_t)(w.end - w.begin);
    return strlen(text) == length && memcmp(text, w.begin, length) == 0;
}

static he_status refuse(he_error *err, he_status status, const he_line *line, word w,
                        const char *what)
{
    char text[40];
    he_quote(w.begin, w.end, text, sizeof text);
    return he_line_fail(err, status, line, w.begin, "'%s' %s", text, what);
}

static he_status require_end(const he_line *line, const char *p, he_error *err)
{
    word w = next_word(line, &p);
    return w.begin == w.end
               ? HE_OK
               : refuse(err, HE_SYNTAX, line, w,
                        "is an extra word, which this line of the header must not have");
}

static he_status read_format(he_ply_header *h, const he_line *line, const char *p, he_error *err)
{
    static const char *const encodings[] = {
        [HE_PLY_ASCII] = "ascii",
        [HE_PLY_LITTLE_ENDIAN] = "binary_little_endian",
        [HE_PLY_BIG_ENDIAN] = "binary_big_endian",
    };
    word w = next_word(line, &p), version = next_word(line, &p);
    if (h->encoding != HE_PLY_UNKNOWN) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin, "the format is given twice");
    }
    he_ply_encoding encoding = HE_PLY_BIG_ENDIAN;
    while (encoding != HE_PLY_UNKNOWN && !is(w, encodings[encoding])) {
        encoding--;
    }
    if (encoding == HE_PLY_UNKNOWN) {
        return refuse(err, HE_SYNTAX, line, w, "is not an encoding of a PLY file");
    }
    if (!is(version, "1.0")) {
        return refuse(err, HE_UNSUPPORTED, line, version,
                      "is not version 1.0, which is the only supported version");
    }
    h->encoding = encoding;
    return require_end(line, p, err);
}

static he_status read_element(he_ply_header *h, const he_line *line, const char *p, he_error *err)
{
    word name = next_word(line, &p), rows = next_word(line, &p);
    uint64_t count = 0;
    size_t used = 0;
    he_status status = he_u64_parse(rows.begin, rows.end, &count, &used);
    if (status == HE_SYNTAX || used != (size_t)(rows.end - rows.begin)) {
        return refuse(err, HE_SYNTAX, line, rows, "is not a count");
    }
    bool held = is(name, "vertex") || is(name, "face");
    if (status != HE_OK || count > (held ? HE_MAX_ROWS : MOST_ROWS)) {
        return refuse(err, HE_BAD_VALUE, line, rows,
                      "is a number of rows larger than a mesh can have");
    }
    if (h->count == HE_PLY_ELEMENTS) {
        return he_line_fail(err, HE_LIMIT, line, line->begin,
                            "the header declares more than %d elements", HE_PLY_ELEMENTS);
    }
    if (h->count == h->capacity) {
        size_t capacity = he_mem_grown(h->capacity, h->count + 1);
        he_ply_element *elements = he_mem_array(h->elements, capacity, sizeof *elements);
        if (elements == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu elements", capacity);
        }
        h->elements = elements;
        h->capacity = capacity;
    }
    he_ply_element *e = &h->elements[h->count];
    *e = (he_ply_element){.rows = count, .first = h->property_count, .line = line->number};
    he_quote(name.begin, name.end, e->name, sizeof e->name);
    for (size_t i = 0; i < h->count; i++) {
        if (strcmp(h->elements[i].name, e->name) == 0) {
            return refuse(err, HE_SYNTAX, line, name, "is the name of two elements");
        }
    }
    h->count++;
    return require_end(line, p, err);
}

static he_status read_type(const he_line *line, word w, he_ply_type *out, he_error *err)
{
    for (he_ply_type type = 0; type < HE_PLY_TYPE_COUNT; type++) {
        if (is(w, types[type].name) || is(w, types[type].other)) {
            *out = type;
            return HE_OK;
        }
    }
    return refuse(err, HE_SYNTAX, line, w, "is not a type of a PLY file");
}

static he_status read_types(he_ply_property *property, const he_line *line, const char **p,
                            he_error *err)
{
    word w = next_word(line, p);
    property->list = is(w, "list");
    if (!property->list) {
        return read_type(line, w, &property->type, err);
    }
    w = next_word(line, p);
    he_status status = read_type(line, w, &property->count, err);
    if (status == HE_OK && property->count >= HE_PLY_FLOAT) {
        return refuse(err, HE_SYNTAX, line, w,
                      "is not an integer type, but the count of a list needs one");
    }
    return status == HE_OK ? read_type(line, next_word(line, p), &property->type, err) : status;
}

static bool is_nameable(word w)
{
    size_t length = (size_t)(w.end - w.begin);
    for (const char *p = w.begin; p < w.end; p++) {
        if (*p <= 0x20 || *p >= 0x7F) {
            return false;
        }
    }
    return length > 0 && length < HE_COLUMN_NAME;
}

static he_status read_property(he_ply_header *h, const he_line *line, const char *p, he_error *err)
{
    if (h->count == 0) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin,
                            "a property comes before the first element");
    }
    he_ply_property property = {.line = line->number};
    he_status status = read_types(&property, line, &p, err);
    if (status != HE_OK) {
        return status;
    }
    word name = next_word(line, &p);
    he_quote(name.begin, name.end, property.name, sizeof property.name);
    property.nameable = is_nameable(name);
    he_ply_element *e = &h->elements[h->count - 1];
    if (name.begin == name.end) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin, "a property has no name");
    }
    if (property.nameable && he_ply_find(h, e, property.name) < e->properties) {
        return refuse(err, HE_SYNTAX, line, name, "is the name of two properties of the element");
    }
    if (h->property_count == HE_PLY_PROPERTIES) {
        return he_line_fail(err, HE_LIMIT, line, line->begin,
                            "the header declares more than %d properties", HE_PLY_PROPERTIES);
    }
    if (h->property_count == h->property_capacity) {
        size_t capacity = he_mem_grown(h->property_capacity, h->property_count + 1);
        he_ply_property *properties = he_mem_array(h->properties, capacity, sizeof *properties);
        if (properties == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu properties", capacity);
        }
        h->properties = properties;
        h->property_capacity = capacity;
    }
    h->properties[h->property_count++] = property;
    e->properties++;
    e->lists = e->lists || property.list;
    e->stride += property.list ? 0 : types[property.type].bytes;
    return require_end(line, p, err);
}

static he_status end_header(he_ply_header *h, const he_line *line, const char *p, he_error *err)
{
    he_status status = require_end(line, p, err); /* rows begin on the next line */
    if (status != HE_OK) {
        return status;
    }
    if (h->encoding == HE_PLY_UNKNOWN) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin, "the header gives no format");
    }
    for (size_t i = 0; i < h->count; i++) {
        const he_ply_element *e = &h->elements[i];
        if (e->rows > 0 && e->properties == 0) {
            return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, e->line,
                              "element '%s' has %llu rows and no properties", e->name,
                              (unsigned long long)e->rows);
        }
    }
    h->ended = true;
    return HE_OK;
}

static void read_comment(he_ply_header *h, const he_line *line, const char *p)
{
    word first = next_word(line, &p), second = next_word(line, &p);
    if (is(first, "hedge") && is(second, "corners")) {
        he_quote(p, line->end, h->corners, sizeof h->corners);
    }
}

he_status he_ply_header_read(he_ply_header *h, const he_line *line, he_error *err)
{
    const char *p = line->begin;
    word w = next_word(line, &p);
    if (w.begin == w.end || *w.begin == '#') { /* lines.h may drop a '#' line, so it is skipped */
        return HE_OK;
    }
    if (!h->begun) {
        h->begun = true;
        return is(w, "ply") ? require_end(line, p, err)
                            : refuse(err, HE_SYNTAX, line, w,
                                     "cannot begin a PLY file, which begins with 'ply'");
    }
    if (is(w, "format")) {
        return read_format(h, line, p, err);
    }
    if (is(w, "element")) {
        return read_element(h, line, p, err);
    }
    if (is(w, "property")) {
        return read_property(h, line, p, err);
    }
    if (is(w, "end_header")) {
        return end_header(h, line, p, err);
    }
    if (is(w, "comment")) {
        read_comment(h, line, p);
        return HE_OK;
    }
    if (is(w, "obj_info")) {
        return HE_OK;
    }
    return refuse(err, HE_SYNTAX, line, w, "cannot begin a line of a PLY header");
}

size_t he_ply_find(const he_ply_header *h, const he_ply_element *element, const char *name)
{
    size_t i = 0;
    while (i < element->properties && strcmp(h->properties[element->first + i].name, name) != 0) {
        i++;
    }
    return i;
}
