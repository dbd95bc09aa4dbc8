#include "format/obj/obj.h"

#include "format/io/colors.h"
#include "format/io/corner_pool.h"
#include "format/io/face_groups.h"
#include "format/obj/mtl.h"
#include "format/text/lines.h"
#include "format/text/number.h"

#include <stdio.h>
#include <string.h>

typedef struct obj {
    he_import *into;
    he_lines lines;
    he_corner_pool uv, normal;
    he_colors colors;
    he_face_groups object, group, material, smoothing;
    he_labels *libraries; /* names of libraries on mtllib lines, NULL while there are none */
    he_ids library_lines; /* the first line that names each library */
    uint32_t highest;     /* highest vertex that a corner refers to */
    uint64_t last_line;   /* number of the last line read */
    uint64_t understood;  /* number of lines with a keyword of the format */
    uint64_t unknown;     /* the first line with an unknown keyword, 0 if there is none */
} obj;

/* Adds a warning about a line. */
static void note(obj *o, const he_line *line, he_occurrence seen)
{
    seen.place = HE_PLACE_LINE;
    seen.at = line->number;
    he_warnings_add(&o->into->warnings, &seen);
}

/* The numbers of a line, however many there are. */
typedef struct numbers {
    double *values;      /* the first ones */
    const size_t most;   /* how many numbers are stored */
    const size_t finite; /* how many of the numbers, from the first on, must be finite */
    size_t count;        /* how many the line has */
} numbers;

static he_status read_numbers(obj *o, const he_line *line, const char *p, numbers *out,
                              he_error *err)
{
    const size_t most = out->most, finite = out->finite;
    double *values = out->values;
    size_t n = 0;
    for (p = he_skip_blanks(p, line->end); !he_at_end(p, line->end);
         p = he_skip_blanks(p, line->end)) {
        double value;
        bool is_finite = true;
        he_status status = n < finite ? he_token_number(line, &p, &value, err)
                                      : he_token_any_number(line, &p, &value, &is_finite, err);
        if (status != HE_OK) {
            return status;
        }
        if (!is_finite) {
            note(o, line,
                 (he_occurrence){
                     .code = "not_finite",
                     .text = "a number of the file is read as 0, because it is not finite"});
        }
        if (n < most) {
            values[n] = value;
        }
        n++;
    }
    out->count = n;
    return HE_OK;
}

static void note_extra(obj *o, const he_line *line)
{
    note(o, line,
         (he_occurrence){.code = "extra_numbers",
                         .text = "numbers at the end of a line are ignored, because the format "
                                 "gives them no meaning"});
}

static he_status read_vertex(obj *o, const he_line *line, const char *p, he_error *err)
{
    double n[7];
    numbers read = {.values = n, .most = 7, .finite = 3};
    he_soup *soup = &o->into->soup;
    he_status status = read_numbers(o, line, p, &read, err);
    if (status != HE_OK) {
        return status;
    }
    size_t count = read.count;
    if (count < 3) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin,
                            "a vertex has 3, 4, 6 or 7 numbers, not %zu", count);
    }
    if (count == 5 || count > 7) {
        note_extra(o, line);
        count = 3; /* the meaning of the numbers after the position is not known */
    }
    size_t vertex = soup->vertex_count;
    status = he_soup_add_vertex(soup, (he_vec3){n[0], n[1], n[2]}, err);
    if (status == HE_OK) {
        status = he_source_map_add(&o->into->vertices, (uint32_t)vertex, line->number, err);
    }
    if (status == HE_OK && count >= 6) {
        status = he_colors_add(&o->colors, vertex, n + 3, count - 3, err);
    }
    if (count == 4 && n[3] != 1) {
        note(o, line,
             (he_occurrence){
                 .code = "vertex_weight",
                 .text =
                     "the weight of a vertex is ignored, because a mesh stores only x, y and z"});
    }
    return he_line_locate(status, line, err);
}

static he_status read_pool_value(obj *o, he_corner_pool *pool, const he_line *line, const char *p,
                                 size_t least, he_error *err)
{
    double n[3] = {0, 0, 0};
    numbers read = {.values = n, .most = 3};
    uint64_t limit = o->into->soup.limits.bytes;
    he_status status = read_numbers(o, line, p, &read, err);
    if (status != HE_OK) {
        return status;
    }
    if (read.count < least) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin,
                            "the line has %zu numbers and needs %zu", read.count, least);
    }
    if (read.count > 3) {
        note_extra(o, line);
    }
    return he_line_locate(he_corner_pool_add(pool, n, limit, err), line, err);
}

/* Reads an index of the file and converts it to one that counts from 0. `count` elements were read
 * so far; whether a positive index is too large is only known at the end of the file. Sets *p
 * behind the number, also if it returns HE_BAD_INDEX. */
static he_status read_index(const he_line *line, const char **p, const char *what, size_t count,
                            uint32_t *index, he_error *err)
{
    const char *begin = *p;
    bool negative = begin < line->end && *begin == '-';
    bool sign = negative || (begin < line->end && *begin == '+');
    uint64_t value = 0;
    size_t used = 0;
    he_status status = he_u64_parse(begin + sign, line->end, &value, &used);
    if (status == HE_SYNTAX) {
        return he_token_fail(err, HE_SYNTAX, line, begin, "is not a valid corner of a face");
    }
    *p = begin + sign + used;
    if (status == HE_OK && value != 0) {
        if (!negative && value <= HE_MAX_ROWS) {
            *index = (uint32_t)value - 1;
            return HE_OK;
        }
        if (negative && value <= count) {
            *index = (uint32_t)(count - value);
            return HE_OK;
        }
    }
    char text[40];
    he_quote(begin, *p, text, sizeof text);
    return he_line_fail(err, HE_BAD_INDEX, line, begin,
                        "there is no %s %s: the file had %zu before this line", what, text, count);
}

/* Warns about the index of a texture coordinate or normal that does not exist. The corner then has
 * no such value, but the shape is not affected, so the file is not refused. */
static void note_no_value(obj *o, const he_corner_pool *pool, uint64_t at)
{
    he_warnings_add(
        &o->into->warnings,
        &(he_occurrence){.code = pool == &o->uv ? "no_such_uv" : "no_such_normal",
                         .text = pool == &o->uv
                                     ? "the texture coordinates of a corner are set to 0, because "
                                       "the file has none with the index that the corner names"
                                     : "the normal of a corner is set to 0, because the file has "
                                       "none with the index that the corner names",
                         .place = HE_PLACE_LINE,
                         .at = at});
}

static he_status read_value(obj *o, const he_line *line, const char **p, he_corner_pool *pool,
                            size_t corner, he_error *err)
{
    const char *begin = *p;
    const char *what = pool == &o->uv ? "texture coordinate" : "normal";
    uint32_t index = 0;
    he_error failure = {0};
    he_status status = read_index(line, p, what, pool->count, &index, &failure);
    if (status == HE_OK) {
        return he_corner_pool_name(pool, corner, index, err);
    }
    double value = 0;
    size_t used = 0;
    bool is_zero = he_double_parse(begin, *p, HE_FILE_NUMBER, &value, &used) == HE_OK && value == 0;
    if (status == HE_BAD_INDEX && !is_zero) {
        note_no_value(o, pool, he_line_number(line, begin));
        return HE_OK;
    }
    *err = failure;
    return status;
}

/* Reads a corner: v, v/vt, v//vn or v/vt/vn. A slash with nothing after it is ignored. */
static he_status read_corner(obj *o, const he_line *line, const char **p, he_error *err)
{
    he_soup *soup = &o->into->soup;
    const char *begin = *p, *end = line->end;
    size_t corner = soup->corner_count;
    uint32_t index = 0;
    he_status status = read_index(line, p, "vertex", soup->vertex_count, &index, err);
    if (status != HE_OK) {
        return status;
    }
    o->highest = index > o->highest ? index : o->highest;
    status = he_soup_add_corner(soup, index, err);
    he_corner_pool *pools[2] = {&o->uv, &o->normal};
    for (size_t i = 0; i < 2 && status == HE_OK && *p < end && **p == '/'; i++) {
        ++*p;
        if (he_token_ends(*p, end) || **p == '/') {
            continue;
        }
        status = read_value(o, line, p, pools[i], corner, err);
    }
    if (status == HE_OK && !he_token_ends(*p, end)) {
        return he_token_fail(err, HE_SYNTAX, line, begin, "is not a valid corner of a face");
    }
    return he_line_locate(status, line, err);
}

static he_status read_face(obj *o, const he_line *line, const char *p, he_error *err)
{
    he_soup *soup = &o->into->soup;
    p = he_skip_blanks(p, line->end);
    if (he_at_end(p, line->end)) {
        return he_line_fail(err, HE_TOO_FEW_CORNERS, line, p, "the face has no corners");
    }
    he_status status = he_soup_begin_face(soup, err);
    if (status == HE_OK) {
        uint32_t face = (uint32_t)soup->face_count - 1;
        status = he_source_map_add(&o->into->faces, face, line->number, err);
    }
    while (status == HE_OK && !he_at_end(p, line->end)) {
        status = read_corner(o, line, &p, err);
        p = he_skip_blanks(p, line->end);
    }
    return he_line_locate(status, line, err);
}

static he_status read_smoothing(obj *o, const he_line *line, const char *p, he_error *err)
{
    p = he_skip_blanks(p, line->end);
    const char *end = he_token_end(p, line->end);
    size_t length = (size_t)(end - p), used = 0;
    uint64_t value = 0;
    if (length == 2 && memcmp(p, "on", 2) == 0) {
        value = 1;
    } else if (length != 0 && !(length == 3 && memcmp(p, "off", 3) == 0)) {
        he_status status = he_u64_parse(p, end, &value, &used);
        if (status != HE_OK || used != length || value > UINT32_MAX) {
            return he_token_fail(err, HE_SYNTAX, line, p,
                                 "is not a smoothing group, which is a whole number, on or off");
        }
    }
    return he_face_groups_set(&o->smoothing, o->into->soup.face_count, (uint32_t)value, err);
}

static bool is_word(const char *p, const char *end)
{
    if (p == end || !((*p | 0x20) >= 'a' && (*p | 0x20) <= 'z')) {
        return false;
    }
    while (p < end) {
        char c = *p++;
        bool letter = (c | 0x20) >= 'a' && (c | 0x20) <= 'z';
        if (!letter && !(c >= '0' && c <= '9') && c != '_' && c != '-' && c != '.') {
            return false;
        }
    }
    return true;
}

/* Keywords for shapes that are no polygons, and the tags of OpenSubdiv; they are ignored with a
 * warning. */
static const char *const passed_over[] = {
    "l",      "p",        "vp",    "deg",   "bmat",   "step",     "cstype",     "curv",
    "curv2",  "surf",     "parm",  "trim",  "hole",   "scrv",     "sp",         "end",
    "con",    "mg",       "bevel", "lod",   "bsp",    "bzp",      "cdc",        "cdp",
    "res",    "c_interp", "ctech", "stech", "usemap", "d_interp", "shadow_obj", "trace_obj",
    "maplib", "call",     "csh",   "t",
};

static he_status read_library(obj *o, const he_line *line, const char *p, he_error *err)
{
    he_name name = {.own = NULL};
    uint32_t number = 0;
    if (o->libraries == NULL) {
        o->libraries = he_labels_new();
        if (o->libraries == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for names");
        }
    }
    he_status status = he_line_name(line, p, &o->into->warnings, &name, err);
    if (status == HE_OK && name.length > 0) {
        status = he_labels_add(o->libraries, name.text, name.length, &number, err);
    }
    if (status == HE_OK && he_labels_count(o->libraries) > o->library_lines.count) {
        status = he_ids_add(&o->library_lines, (uint32_t)line->number, err);
    }
    he_mem_free(name.own);
    return status;
}

static he_status read_other(obj *o, const he_line *line, const char *p, const char *end,
                            he_error *err)
{
    he_warnings *warnings = &o->into->warnings;
    size_t faces = o->into->soup.face_count, length = (size_t)(end - p);
    o->understood++;
    switch (length) {
    case 1:
        if (*p == 'g') {
            return he_face_groups_set_name(&o->group, faces, line, end, warnings, err);
        }
        if (*p == 'o') {
            return he_face_groups_set_name(&o->object, faces, line, end, warnings, err);
        }
        if (*p == 's') {
            return read_smoothing(o, line, end, err);
        }
        break;
    case 2:
        if (memcmp(p, "fo", 2) == 0) {
            return read_face(o, line, end, err);
        }
        break;
    case 6:
        if (memcmp(p, "usemtl", 6) == 0) {
            return he_face_groups_set_name(&o->material, faces, line, end, warnings, err);
        }
        if (memcmp(p, "mtllib", 6) == 0) {
            return read_library(o, line, end, err);
        }
        break;
    }
    if (!is_word(p, end)) {
        return he_token_fail(err, HE_SYNTAX, line, p, "cannot begin a line of an OBJ file");
    }
    for (size_t i = 0; i < sizeof passed_over / sizeof *passed_over; i++) {
        if (*passed_over[i] == *p && strlen(passed_over[i]) == length &&
            memcmp(p, passed_over[i], length) == 0) {
            note(o, line,
                 (he_occurrence){.code = "ignored_keyword",
                                 .text = "a line that begins with % is ignored, because a mesh "
                                         "cannot hold what it describes",
                                 .subject = p,
                                 .length = length});
            return HE_OK;
        }
    }
    o->understood--;
    o->unknown = o->unknown == 0 ? line->number : o->unknown;
    note(o, line,
         (he_occurrence){.code = "unknown_keyword",
                         .text = "a line with the unknown keyword % is ignored",
                         .subject = p,
                         .length = length});
    return HE_OK;
}

static he_status read_line(void *context, const he_line *line, he_error *err)
{
    obj *o = context;
    const char *end = line->end;
    const char *p = he_skip_blanks(line->begin, end);
    o->last_line = line->number;
    if (he_at_end(p, end)) {
        return HE_OK;
    }
    if (*p == '$') { /* some programs begin comments with '$' */
        note(o, line,
             (he_occurrence){
                 .code = "ignored_keyword",
                 .text = "a line that begins with % is ignored, because it is read as a comment",
                 .subject = p,
                 .length = 1});
        return HE_OK;
    }
    if (*p == 'v' && he_token_ends(p + 1, end)) {
        return read_vertex(o, line, p + 1, err);
    }
    if (*p == 'f' && he_token_ends(p + 1, end)) {
        return read_face(o, line, p + 1, err);
    }
    if (*p == 'v' && p[1] == 't' && he_token_ends(p + 2, end)) {
        return read_pool_value(o, &o->uv, line, p + 2, 1, err);
    }
    if (*p == 'v' && p[1] == 'n' && he_token_ends(p + 2, end)) {
        return read_pool_value(o, &o->normal, line, p + 2, 3, err);
    }
    return read_other(o, line, p, he_token_end(p, end), err);
}

static void obj_close(void *state)
{
    obj *o = state;
    he_lines_clear(&o->lines);
    he_corner_pool_clear(&o->uv);
    he_corner_pool_clear(&o->normal);
    he_colors_clear(&o->colors);
    he_face_groups_clear(&o->object);
    he_face_groups_clear(&o->group);
    he_face_groups_clear(&o->material);
    he_face_groups_clear(&o->smoothing);
    he_labels_release(o->libraries);
    he_ids_clear(&o->library_lines);
    he_mem_free(o);
}

static he_status obj_open(he_import *into, void **state, he_error *err)
{
    obj *o = he_mem_zero(1, sizeof *o);
    if (o == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read the OBJ file");
    }
    o->into = into;
    he_lines_init(&o->lines, read_line, o);
    o->lines.joins = true;
    o->lines.limit = into->soup.limits.bytes;
    o->colors.fractions = true;
    he_source_map_init(&into->vertices, HE_PLACE_LINE, 1);
    he_source_map_init(&into->faces, HE_PLACE_LINE, 1);
    *state = o;
    return HE_OK;
}

static he_status obj_feed(void *state, const void *bytes, size_t n, he_error *err)
{
    obj *o = state;
    return he_lines_feed(&o->lines, bytes, n, err);
}

static uint64_t line_of(const obj *o, size_t corner)
{
    return he_source_map_find(&o->into->faces, he_soup_face_of(&o->into->soup, corner));
}

/* Removes the indices of corners that refer to a texture coordinate or normal that does not
 * exist. */
static void check_values(obj *o, he_corner_pool *pool)
{
    for (size_t c = he_corner_pool_next_bad(pool, 0); c != SIZE_MAX;
         c = he_corner_pool_next_bad(pool, c + 1)) {
        note_no_value(o, pool, line_of(o, c));
        he_corner_pool_forget(pool, c);
    }
}

/* Checks all indices, which is possible only after all elements have been read. */
static he_status check_indices(obj *o, he_error *err)
{
    const he_soup *soup = &o->into->soup;
    if (soup->corner_count > 0 && o->highest >= soup->vertex_count) {
        size_t c = 0;
        while (soup->corners[c] < soup->vertex_count) {
            c++;
        }
        return he_fail_at(err, HE_BAD_INDEX, HE_PLACE_LINE, line_of(o, c),
                          "a face uses vertex %u, but the file has only %zu vertices",
                          soup->corners[c] + 1, soup->vertex_count);
    }
    check_values(o, &o->uv);
    check_values(o, &o->normal);
    return HE_OK;
}

static he_status note_unused(obj *o, he_error *err)
{
    size_t uvs = 0, normals = 0;
    he_status status = he_corner_pool_unused(&o->uv, &uvs, err);
    if (status == HE_OK) {
        status = he_corner_pool_unused(&o->normal, &normals, err);
    }
    if (status == HE_OK) {
        he_warnings_add_count(&o->into->warnings, "unused_uv",
                              "a pair of texture coordinates is ignored, because no corner uses it",
                              uvs);
        he_warnings_add_count(&o->into->warnings, "unused_normal",
                              "a normal is ignored, because no corner uses it", normals);
    }
    return status;
}

static void note_partial(obj *o, size_t with, size_t all, const char *code, const char *text)
{
    if (with > 0) {
        he_warnings_add_count(&o->into->warnings, code, text, all - with);
    }
}

/* Reads a material library that came with the file. If there is none, it returns HE_OK and adds a
 * warning. */
static he_status open_library(obj *o, const char *name, size_t length, uint64_t line, he_error *err)
{
    const he_beside_file *file = he_beside_find(o->into->beside, name, length);
    if (file == NULL) {
        he_warnings_add(
            &o->into->warnings,
            &(he_occurrence){.code = "library_missing",
                             .text = "material library % is not read, because it was not sent with "
                                     "the file (send both as multipart/form-data)",
                             .subject = name,
                             .length = length,
                             .place = HE_PLACE_LINE,
                             .at = line});
        return HE_OK;
    }
    he_error failure = {0};
    he_status status = he_mtl_read(file->bytes, file->length, o->into, &failure);
    if (status != HE_OK && err != NULL) {
        char quoted[48], where[40] = "";
        he_quote(name, name + length, quoted, sizeof quoted);
        if (failure.place == HE_PLACE_LINE) {
            snprintf(where, sizeof where, ", line %llu", (unsigned long long)failure.at);
        }
        *err = failure;
        he_fail_at(err, status, HE_PLACE_LINE, line, "material library %s%s: %.100s", quoted, where,
                   failure.text);
    }
    return status;
}

/* Reads the libraries that the lines mtllib name. A line names either one library, whose name may
 * contain blanks, or several. */
static he_status open_libraries(obj *o, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < o->library_lines.count && status == HE_OK; i++) {
        const char *p = he_labels_get(o->libraries, i), *end = p + strlen(p);
        bool several = he_beside_find(o->into->beside, p, (size_t)(end - p)) == NULL;
        while (p < end && status == HE_OK) {
            size_t length = several ? strcspn(p, " \t") : (size_t)(end - p);
            status = open_library(o, p, length, o->library_lines.ids[i], err);
            p += length;
            p += strspn(p, " \t");
        }
    }
    return status;
}

/* Stores the names of the material libraries as an attribute of the mesh. */
static he_status keep_libraries(obj *o, he_error *err)
{
    size_t count = o->library_lines.count;
    he_column *column = NULL;
    if (count > HE_COLUMN_COMPONENTS) {
        he_warnings_add_count(&o->into->warnings, "libraries",
                              "the name of a material library is left out, because a mesh keeps at "
                              "most 16 such names",
                              count - HE_COLUMN_COMPONENTS);
        count = HE_COLUMN_COMPONENTS;
    }
    if (count == 0) {
        return HE_OK;
    }
    he_status status = he_soup_column(
        &o->into->soup,
        &(he_column_schema){HE_OBJ_LIBRARY, HE_MESH_KIND, HE_UINT32, (uint32_t)count, HE_COPY},
        &column, err);
    if (status == HE_OK) {
        status = he_column_extend(column, 1, err);
    }
    for (uint32_t i = 0; i < count && status == HE_OK; i++) {
        memcpy(he_column_row(column, 0) + i * sizeof i, &i, sizeof i);
    }
    if (status == HE_OK) {
        column->labels = he_labels_retain(o->libraries);
    }
    return status;
}

static he_status obj_finish(void *state, he_error *err)
{
    obj *o = state;
    he_soup *soup = &o->into->soup;
    he_status status = he_lines_finish(&o->lines, err);
    if (status == HE_OK) {
        status = check_indices(o, err);
    }
    if (status != HE_OK) {
        return status;
    }
    bool nothing = soup->vertex_count == 0 && o->understood == 0;
    if (nothing && (o->unknown != 0 || o->last_line == 0)) {
        uint64_t line = o->unknown != 0 ? o->unknown : 1;
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, line,
                          "not an OBJ file: no line of it is a vertex");
    }
    note_partial(o, o->uv.named, soup->corner_count, "corners_without_uv",
                 "a corner gets texture coordinates of 0, because the file gives it none");
    note_partial(o, o->normal.named, soup->corner_count, "corners_without_normal",
                 "a corner gets a normal of 0, because the file gives it none");
    note_partial(o, o->colors.given, soup->vertex_count, "vertices_without_color",
                 "a vertex gets a colour of 0, because the file gives it none");
    status = note_unused(o, err);
    if (status == HE_OK) {
        status = he_corner_pool_finish(&o->uv, soup, "uv", 2, err);
    }
    if (status == HE_OK) {
        status = he_corner_pool_finish(&o->normal, soup, "normal", 3, err);
    }
    if (status == HE_OK) {
        status = he_colors_finish(&o->colors, soup, &o->into->warnings, HE_VERTEX,
                                  soup->vertex_count, err);
    }
    if (status == HE_OK) {
        status = he_face_groups_finish(&o->object, soup, "object", err);
    }
    if (status == HE_OK) {
        status = he_face_groups_finish(&o->group, soup, "group", err);
    }
    if (status == HE_OK) {
        status = he_face_groups_finish(&o->material, soup, "material", err);
    }
    if (status == HE_OK) {
        status = he_face_groups_finish(&o->smoothing, soup, "smoothing", err);
    }
    if (status == HE_OK) {
        status = keep_libraries(o, err);
    }
    if (status == HE_OK) {
        status = open_libraries(o, err);
    }
    return status;
}

const he_reading he_obj_reading = {obj_open, obj_feed, obj_finish, obj_close, false};

/* Returns true if these bytes may be an OBJ file: the first line that is neither blank nor a
 * comment (lines with $ also count as comments) must begin with a keyword. */
bool he_obj_sniff(const char *bytes, size_t n)
{
    static const char *const keywords[] = {"v", "vt", "vn", "f",  "g",      "o",
                                           "s", "l",  "p",  "vp", "mtllib", "usemtl"};
    const char *p = bytes, *end = bytes + n;
    if (n >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0) {
        p += 3;
    }
    while (p < end) {
        const char *stop = p;
        while (stop < end && *stop != '\n' && *stop != '\r') {
            stop++;
        }
        while (p < stop && (*p == ' ' || *p == '\t' || *p == '\r')) {
            p++;
        }
        if (p < stop && *p != '#' && *p != '$') {
            size_t length = 0;
            while (p + length < stop && is_word(p + length, p + length + 1)) {
                length++;
            }
            for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++) {
                if (strlen(keywords[i]) == length && memcmp(p, keywords[i], length) == 0) {
                    return p + length < stop && (p[length] == ' ' || p[length] == '\t');
                }
            }
            return false;
        }
        p = stop < end ? stop + 1 : end;
    }
    return false;
}
