#include "format/obj/mtl.h"

#include "format/io/face_groups.h"
#include "format/text/lines.h"

#include <string.h>

typedef struct library {
    he_import *into;
    he_lines lines;
    he_labels *names; /* names of all materials in the table and in this library */
    /* The index in the table of each name's material; HE_NONE if the table was full. */
    he_ids slots;
    char *name; /* name of the material being read, "" if there is none */
    size_t length, room;
    he_look look;
    /* True if the opacity came from a line d, which takes precedence over a line Tr. */
    bool has_opacity;
    uint64_t understood; /* number of lines with a keyword of a library */
    uint64_t first;      /* the first line with an unknown keyword, 0 if there is none */
} library;

static void note(library *l, const char *code, const char *text, const char *subject, size_t length)
{
    he_warnings_add(
        &l->into->warnings,
        &(he_occurrence){.code = code, .text = text, .subject = subject, .length = length});
}

/* Finds the number of a name among l->names, or adds the name; *fresh says whether the name is
 * new. */
static he_status number_name(library *l, const char *name, size_t length, uint32_t *number,
                             bool *fresh, he_error *err)
{
    size_t known = he_labels_count(l->names);
    he_status status = he_ids_reserve(&l->slots, 1, err);
    if (status == HE_OK) {
        status = he_labels_add(l->names, name, length, number, err);
    }
    *fresh = status == HE_OK && *number == known;
    if (*fresh) {
        l->slots.ids[l->slots.count++] = HE_NONE;
    }
    return status;
}

static he_status add_row(library *l, uint32_t number, bool fresh, he_error *err)
{
    he_materials *table = &l->into->soup.materials;
    he_material *row = NULL;
    he_status status = he_material_new(l->name, l->length, &l->look, &row, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t slot = l->slots.ids[number];
    if (!fresh) {
        if (slot == HE_NONE || !he_material_equal(table->rows[slot], row)) {
            note(l, "material_twice",
                 "a second material called % is ignored, because it differs from the first of that "
                 "name",
                 l->name, l->length);
        }
        he_material_release(row);
        return HE_OK;
    }
    if (table->count == HE_MATERIALS) {
        note(l, "material_limit",
             "a material is left out, because a mesh has at most 4096 materials", NULL, 0);
        he_material_release(row);
        return HE_OK;
    }
    slot = (uint32_t)he_materials_free_slot(table);
    status = he_materials_add(table, row, err);
    if (status != HE_OK) {
        he_material_release(row);
    } else {
        l->slots.ids[number] = slot;
    }
    return status;
}

/* Ends the material whose lines were just read: checks it, and adds it to the table. */
static he_status end_material(library *l, he_error *err)
{
    uint32_t number = 0;
    bool fresh = false;
    if (l->length == 0) {
        return HE_OK;
    }
    if (l->length > HE_MATERIAL_NAME) {
        note(l, "material_name", "material % is left out, because its name is too long", l->name,
             l->length);
        return HE_OK;
    }
    if (he_look_clamp(&l->look)) {
        note(l, "material_range",
             "an invalid number of material % is replaced by the nearest allowed value", l->name,
             l->length);
    }
    he_status status = number_name(l, l->name, l->length, &number, &fresh, err);
    return status == HE_OK ? add_row(l, number, fresh, err) : status;
}

static he_status begin_material(library *l, const he_line *line, const char *p, he_error *err)
{
    he_name name = {.own = NULL};
    he_status status = end_material(l, err);
    l->length = 0;
    if (status == HE_OK) {
        status = he_line_name(line, p, NULL, &name, err);
    }
    if (status == HE_OK && name.length + 1 > l->room) {
        char *grown = he_mem_resize(l->name, name.length + 1);
        if (grown == NULL) {
            status = he_fail_plain(err, HE_NO_MEMORY, "no memory for the name of a material");
        } else {
            l->name = grown;
            l->room = name.length + 1;
        }
    }
    if (status == HE_OK) {
        if (name.text != name.own) {
            note(l, "not_utf8", "name % is read as Latin-1, because it is not UTF-8", name.text,
                 name.length);
        }
        memcpy(l->name, name.text, name.length);
        l->name[name.length] = '\0';
        l->length = name.length;
        l->look = he_plain_look;
        l->has_opacity = false;
        if (name.length == 0) {
            note(l, "material_name", "a material is left out, because it has no name", NULL, 0);
        }
    }
    he_mem_free(name.own);
    return status;
}

/* Reads a colour: three numbers, or one that stands for three. A colour given by a spectrum or as
 * CIE XYZ is ignored with a warning. */
static he_status read_color(library *l, const he_line *line, const char *keyword, const char *p,
                            double *out, he_error *err)
{
    double n[3] = {0, 0, 0};
    size_t count = 0;
    p = he_skip_blanks(p, line->end);
    const char *end = he_token_end(p, line->end);
    if (end - p > 2 && (memcmp(p, "spectral", 3) == 0 || memcmp(p, "xyz", 3) == 0)) {
        note(l, "ignored_color",
             "colour % of a material is ignored, because it is not given as red, green and blue",
             keyword, 2);
        return HE_OK;
    }
    for (; !he_at_end(p, line->end) && count < 3; p = he_skip_blanks(p, line->end)) {
        bool finite = true;
        he_status status = he_token_any_number(line, &p, &n[count], &finite, err);
        if (status != HE_OK) {
            return status;
        }
        count++;
    }
    if (count == 0 || count == 2) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin, "a colour has 3 numbers, not %zu",
                            count);
    }
    for (size_t i = 0; i < 3; i++) {
        out[i] = n[count == 1 ? 0 : i];
    }
    return HE_OK;
}

static he_status read_number(const he_line *line, const char *p, double *out, he_error *err)
{
    bool finite = true;
    p = he_skip_blanks(p, line->end);
    if (he_line_number(line, p) == line->number && line->end - p > 5 &&
        memcmp(p, "-halo", 5) == 0) {
        p = he_skip_blanks(p + 5, line->end);
    }
    if (he_at_end(p, line->end)) {
        return he_line_fail(err, HE_SYNTAX, line, line->begin, "a number is missing");
    }
    return he_token_any_number(line, &p, out, &finite, err);
}

static he_status read_opacity(library *l, const he_line *line, const char *p, bool turned,
                              he_error *err)
{
    double value = 1;
    he_status status = read_number(line, p, &value, err);
    if (status == HE_OK && (!turned || !l->has_opacity)) {
        l->look.base_color[3] = turned ? 1 - value : value;
        l->has_opacity = !turned;
    }
    return status;
}

static bool is(const char *p, size_t length, const char *keyword)
{
    return strlen(keyword) == length && memcmp(p, keyword, length) == 0;
}

static bool is_any(const char *p, size_t length, const char *const *list)
{
    for (; *list != NULL; list++) {
        if (is(p, length, *list)) {
            return true;
        }
    }
    return false;
}

static bool is_texture(const char *p, size_t length)
{
    static const char *const words[] = {"bump", "disp", "decal", "norm", "refl", NULL};
    return (length > 4 && (memcmp(p, "map_", 4) == 0 || memcmp(p, "Map_", 4) == 0)) ||
           is_any(p, length, words);
}

/* Warns about a texture. Options come before the name of its file, which may contain blanks, so it
 * is not known where the name begins: the warning quotes the whole line. */
static void note_texture(library *l, const he_line *line, const char *keyword)
{
    const char *end = line->end;
    while (end > keyword && (end[-1] == ' ' || end[-1] == '\t')) {
        end--;
    }
    const char *last = end;
    while (last > keyword && last[-1] != ' ' && last[-1] != '\t') {
        last--;
    }
    (void)he_beside_find(l->into->beside, last, (size_t)(end - last));
    note(l, "ignored_texture",
         "the texture of the line % is ignored, because a mesh stores no images", keyword,
         (size_t)(end - keyword));
}

/* Keywords of the format whose values a material of a mesh cannot store. */
static const char *const passed_over[] = {"Ka",  "Ks",    "Ns",     "Ni",        "Tf", "Ps", "Pc",
                                          "Pcr", "aniso", "anisor", "sharpness", "Km", "Tm", NULL};

static he_status read_keyword(library *l, const he_line *line, const char *p, size_t length,
                              he_error *err)
{
    const char *rest = p + length;
    l->understood++;
    if (is(p, length, "newmtl")) {
        return begin_material(l, line, rest, err);
    }
    if (is(p, length, "Kd")) {
        return read_color(l, line, p, rest, l->look.base_color, err);
    }
    if (is(p, length, "Ke")) {
        return read_color(l, line, p, rest, l->look.emission, err);
    }
    if (is(p, length, "d") || is(p, length, "Tr")) {
        return read_opacity(l, line, rest, *p == 'T', err);
    }
    if (is(p, length, "Pm")) {
        return read_number(line, rest, &l->look.metallic, err);
    }
    if (is(p, length, "Pr")) {
        return read_number(line, rest, &l->look.roughness, err);
    }
    if (is_texture(p, length)) {
        note_texture(l, line, p);
    } else if (is_any(p, length, passed_over)) {
        note(l, "ignored_keyword",
             "a line of the material library that begins with % is ignored, because the materials "
             "of a mesh have no such property",
             p, length);
    } else if (!is(p, length, "illum")) {
        l->understood--;
        l->first = l->first == 0 ? line->number : l->first;
        note(l, "unknown_keyword",
             "a line of the material library with the unknown keyword % is ignored", p, length);
    }
    return HE_OK;
}

static he_status read_line(void *context, const he_line *line, he_error *err)
{
    library *l = context;
    const char *p = he_skip_blanks(line->begin, line->end);
    if (he_at_end(p, line->end)) {
        return HE_OK;
    }
    size_t length = (size_t)(he_token_end(p, line->end) - p);
    return he_line_locate(read_keyword(l, line, p, length, err), line, err);
}

/* Lists the names of the materials that the table had before this library was read. */
static he_status list_names(library *l, he_error *err)
{
    const he_materials *table = &l->into->soup.materials;
    he_status status = HE_OK;
    for (size_t i = 0; i < table->count && status == HE_OK; i++) {
        uint32_t number;
        bool fresh;
        status = number_name(l, table->rows[i]->name, table->rows[i]->length, &number, &fresh, err);
        if (status == HE_OK) {
            l->slots.ids[number] = (uint32_t)i;
        }
    }
    return status;
}

he_status he_mtl_read(const char *bytes, size_t n, he_import *into, he_error *err)
{
    library l = {.into = into, .look = he_plain_look, .names = he_labels_new()};
    he_lines_init(&l.lines, read_line, &l);
    l.lines.joins = true;
    l.lines.limit = into->soup.limits.bytes;
    he_status status = l.names == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory for a material library")
                           : list_names(&l, err);
    if (status == HE_OK) {
        status = he_lines_feed(&l.lines, bytes, n, err);
    }
    if (status == HE_OK) {
        status = he_lines_finish(&l.lines, err);
    }
    if (status == HE_OK && l.understood == 0 && l.first != 0) {
        status = he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, l.first,
                            "this line cannot be part of a material library");
    }
    if (status == HE_OK) {
        status = end_material(&l, err);
    }
    he_lines_clear(&l.lines);
    he_labels_release(l.names);
    he_ids_clear(&l.slots);
    he_mem_free(l.name);
    return status;
}
