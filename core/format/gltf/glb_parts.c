#include "format/gltf/glb_parts.h"

#include "format/io/colors.h"

#include <stdio.h>
#include <string.h>

/* A file with at most this many vertices has 16-bit indices. The largest 16-bit number is not
 * used as an index, because in glTF it restarts a strip of triangles. */
enum { SHORT_VERTICES = UINT16_MAX };
/* The most attributes that are written under one semantic (the meaning that glTF gives to an
 * attribute), such as TEXCOORD_0 to TEXCOORD_7. */
enum { MOST_NUMBERS = 8 };

uint64_t he_glb_part_bytes(const he_glb_part *part)
{
    return part->count * part->stride;
}

void he_glb_parts_clear(he_glb_parts *parts)
{
    he_mem_free(parts->numbers);
    he_splits_clear(&parts->splits);
    he_export_triangles_clear(&parts->cuts);
    he_glb_groups_clear(&parts->groups);
    he_mem_free(parts->parts);
    he_mem_free(parts->streams);
    he_mem_free(parts->json);
    *parts = (he_glb_parts){0};
}

static void add(he_glb_parts *g, he_glb_part part)
{
    part.offset = g->bytes;
    g->bytes += (he_glb_part_bytes(&part) + 3) / 4 * 4;
    g->parts[g->count++] = part;
}

static uint64_t corner_count(const he_mesh *m)
{
    return 2 * (uint64_t)m->c.edges.live - m->c.boundary_halfedges;
}

/* --- attributes with a semantic of glTF --- */

static bool all_below(const he_column *column, double end)
{
    /* After the last value stands the default value, which is checked, too. */
    for (size_t row = 0; row <= column->rows; row++) {
        for (uint32_t i = 0; i < column->components; i++) {
            if (he_export_number(column, row, i) >= end) {
                return false;
            }
        }
    }
    return true;
}

/* Returns true if the column has the name and the components of attribute `number` of a
 * semantic: TEXCOORD_0 is written from the column `uv`, TEXCOORD_1 from `uv1`. */
static bool is_numbered(const he_column *column, const he_gltf_semantic *s, unsigned number)
{
    char name[HE_COLUMN_NAME];
    snprintf(name, sizeof name, number == 0 ? "%s" : "%s%u", s->attribute, number);
    return strcmp(column->name, name) == 0 && column->components >= s->least &&
           column->components <= s->most;
}

/* Returns the glTF component type in which a column is written under a semantic; 0 if the column
 * cannot be written under this semantic. */
static unsigned type_of(const he_mesh *m, const he_column *column, const he_gltf_semantic *s)
{
    uint64_t lost;
    if (s->role == HE_GLTF_JOINTS) {
        return column->type == HE_UINT32 && all_below(column, 65536) ? HE_GLTF_UINT16 : 0;
    }
    if (column->type != HE_FLOAT && column->type != HE_DOUBLE) {
        return 0;
    }
    bool bytes = s->role == HE_GLTF_COLOR && he_colors_are_bytes(m, column, &lost);
    return bytes ? HE_GLTF_UINT8 : HE_GLTF_FLOAT;
}

/* Returns the component type in which a column is written as attribute `number` of a semantic, such
 * as TEXCOORD_1 with the number 1; 0 if the column cannot be written as this attribute. */
static unsigned type_as(const he_mesh *m, const he_column *column, const he_gltf_semantic *s,
                        unsigned number)
{
    return column->labels == NULL && is_numbered(column, s, number) ? type_of(m, column, s) : 0;
}

/* Returns the column that is written as attribute `number` of a semantic, such as TEXCOORD_1;
 * NULL if there is no such column. An attribute of corners takes precedence over one of
 * vertices. */
static const he_column *find_shown(const he_mesh *m, const he_gltf_semantic *s, unsigned number)
{
    static const he_kind domains[] = {HE_HALFEDGE, HE_VERTEX};
    for (size_t k = m->c.faces.live > 0 ? 0 : 1; k < 2; k++) {
        for (size_t i = 0; i < he_mesh_columns(m); i++) {
            const he_column *column = he_mesh_column(m, i);
            if (column != NULL && column->domain == domains[k] &&
                type_as(m, column, s, number) != 0) {
                return column;
            }
        }
    }
    return NULL;
}

/* Returns how many attributes of a semantic can be written. Their numbers may have no gap:
 * TEXCOORD_1 needs TEXCOORD_0. Joints need weights of the same number. */
static unsigned count_numbers(const he_mesh *m, const he_gltf_semantic *s)
{
    const he_gltf_semantic *partner = &he_gltf_semantics[s->partner];
    unsigned most = s->numbered ? MOST_NUMBERS : 1, count = 0;
    while (count < most && find_shown(m, s, count) != NULL &&
           (partner == s || find_shown(m, partner, count) != NULL)) {
        count++;
    }
    return count;
}

static bool is_printable(const char *name)
{
    for (const char *p = name; *p != '\0'; p++) {
        if ((unsigned char)*p < 0x20 || *p == 0x7F) {
            return false;
        }
    }
    return strcmp(name, "position") != 0;
}

static bool has_corner_namesake(const he_mesh *m, const he_column *column)
{
    return he_mesh_find_column(m, HE_HALFEDGE, column->name) != NULL;
}

/* Finds the glTF semantic of a column. The column uv1 cannot be TEXCOORD_1 in a file without
 * TEXCOORD_0; such a column gets a name of its own, _uv1, which is read back as uv1. Joints
 * without weights, which are whole numbers, are then stored in extras. */
static bool find_semantic(const he_mesh *m, const unsigned counts[HE_GLTF_SEMANTICS],
                          const he_column *column, he_glb_part *part)
{
    part->role = HE_GLTF_SEMANTICS;
    for (size_t i = 0; i < HE_GLTF_SEMANTICS; i++) {
        const he_gltf_semantic *s = &he_gltf_semantics[i];
        unsigned n = 0;
        while (n < MOST_NUMBERS && type_as(m, column, s, n) == 0) {
            n++;
        }
        if (n == MOST_NUMBERS || n >= counts[i] || find_shown(m, s, n) != column) {
            continue;
        }
        part->role = s->role;
        part->type = type_of(m, column, s);
        part->normalized = part->type == HE_GLTF_UINT8;
        snprintf(part->semantic, sizeof part->semantic, s->numbered ? "%s%u" : "%s", s->semantic,
                 n);
        return true;
    }
    bool fraction = column->type == HE_FLOAT || column->type == HE_DOUBLE;
    if (!fraction || column->components > 4 || !is_printable(column->name) ||
        column->domain != HE_VERTEX || has_corner_namesake(m, column)) {
        return false;
    }
    part->type = HE_GLTF_FLOAT;
    snprintf(part->semantic, sizeof part->semantic, "_%s", column->name);
    return true;
}

/* Returns true if hedge will read back the values of all vertices from the file with equal bits. */
static bool comes_back(const he_mesh *m, const he_glb_part *part)
{
    const he_column *column = part->column;
    for (uint32_t row = 0; row < m->c.vertices.issued; row++) {
        for (uint32_t i = 0; i < column->components; i++) {
            double value = he_export_number(column, row, i);
            double other = he_narrow(he_gltf_convert(part->role, i, value));
            if (he_vertex_is_live(m, (he_vertex){row}) &&
                he_gltf_convert(part->role, i, other) != value) {
                return false;
            }
        }
    }
    return true;
}

/* Returns true if a reader of the file will make of this part a column equal to the one that is
 * written. */
static bool is_exact(const he_mesh *m, const he_glb_part *part)
{
    const he_column *column = part->column;
    if (column->domain != HE_VERTEX) {
        return false;
    }
    if (part->type == HE_GLTF_UINT16) {
        return column->rule == HE_COPY;
    }
    he_type type = part->role == HE_GLTF_UV ? HE_DOUBLE : HE_FLOAT;
    return column->type == type && column->rule == HE_INTERPOLATE &&
           (part->role != HE_GLTF_UV || comes_back(m, part));
}

/* --- choosing --- */

static uint64_t rows_of(const he_mesh *m, he_kind domain)
{
    switch (domain) {
    case HE_VERTEX:
        return m->c.vertices.live;
    case HE_FACE:
        return m->c.faces.live;
    case HE_HALFEDGE:
        return corner_count(m);
    case HE_EDGE:
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 0;
}

static bool is_shown(const he_glb_parts *g, const he_column *column)
{
    size_t i = 0;
    while (i < g->count && (g->parts[i].content != HE_GLB_VALUES || g->parts[i].column != column)) {
        i++;
    }
    return i < g->count;
}

/* Returns true if the column is one of the attributes of faces by which the meshes, primitives and
 * materials of the file are separated, so that other programs see it. */
static bool is_told_apart(const he_glb_parts *g, const he_column *column)
{
    size_t i = 0;
    while (i < HE_GLB_NAMES && g->groups.names[i] != column) {
        i++;
    }
    return i < HE_GLB_NAMES;
}

static void add_words(he_glb_parts *g, const he_column *column, he_warnings *warnings)
{
    uint32_t words = column->components * (column->type == HE_DOUBLE ? 2 : 1);
    char subject[HE_COLUMN_NAME + 16];
    int length =
        snprintf(subject, sizeof subject, "%s %s", he_kind_name(column->domain), column->name);
    add(g, (he_glb_part){.content = HE_GLB_WORDS,
                         .column = column,
                         .type = HE_GLTF_UINT32,
                         .components = 1,
                         .count = rows_of(g->mesh, column->domain) * words,
                         .stride = 4});
    if ((column->domain == HE_HALFEDGE && is_shown(g, column)) || is_told_apart(g, column)) {
        return; /* other programs see the attribute, too, so no warning is needed */
    }
    he_warnings_add(warnings,
                    &(he_occurrence){.code = "in_extras",
                                     .text = "attribute % is stored in extras, which only hedge "
                                             "reads, because no attribute of glTF can hold it",
                                     .subject = subject,
                                     .length = (size_t)length});
}

/* Adds a part for each attribute that all programs read. The attributes that only hedge reads
 * are added after the triangles, by add_rest. */
static void add_values(he_glb_parts *g, he_warnings *warnings)
{
    const he_mesh *m = g->mesh;
    unsigned counts[HE_GLTF_SEMANTICS];
    for (size_t i = 0; i < HE_GLTF_SEMANTICS; i++) {
        counts[i] = count_numbers(m, &he_gltf_semantics[i]);
    }
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        const he_column *column = he_mesh_column(m, i);
        he_glb_part part = {.content = HE_GLB_VALUES, .column = column};
        if (column == NULL || (column->domain != HE_VERTEX && column->domain != HE_HALFEDGE) ||
            he_export_find(m, column->domain, column->name, 1, HE_COLUMN_COMPONENTS, warnings) ==
                NULL ||
            !find_semantic(m, counts, column, &part)) {
            continue;
        }
        part.components = column->components;
        part.stride = part.type == HE_GLTF_UINT8    ? 4
                      : part.type == HE_GLTF_UINT16 ? 8
                                                    : 4 * column->components;
        add(g, part);
    }
}

/* Splits vertices whose corners have different values of the attributes that all programs read. */
static he_status split(he_glb_parts *g, he_progress *progress, he_error *err)
{
    const he_column *columns[HE_GLTF_SEMANTICS * MOST_NUMBERS];
    size_t count = 0;
    for (size_t i = 0; i < g->count; i++) {
        if (g->parts[i].column->domain == HE_HALFEDGE) {
            columns[count++] = g->parts[i].column;
        }
    }
    return count == 0
               ? HE_OK
               : he_splits_make(g->mesh, g->numbers, columns, count, progress, &g->splits, err);
}

static void add_rest(he_glb_parts *g, const he_column **used, he_warnings *warnings)
{
    const he_mesh *m = g->mesh;
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        const he_column *column = he_mesh_column(m, i);
        if (column != NULL && used[i] == NULL && rows_of(m, column->domain) > 0) {
            add_words(g, column, warnings);
            used[i] = column;
        }
    }
}

/* Puts the part of positions before the parts of attributes. Each of these parts has an element for
 * each vertex and each copy of a vertex. */
static void place_values(he_glb_parts *g, const he_column **used)
{
    const he_mesh *m = g->mesh;
    size_t values = g->count;
    uint64_t vertices = m->c.vertices.live + g->splits.copies.count;
    memmove(g->parts + 1, g->parts, values * sizeof *g->parts);
    g->parts[0] = (he_glb_part){.content = HE_GLB_POSITIONS,
                                .semantic = "POSITION",
                                .type = HE_GLTF_FLOAT,
                                .components = 3,
                                .stride = 12};
    g->count = 0;
    g->bytes = 0;
    for (size_t i = 0; i <= values; i++) {
        he_glb_part part = g->parts[i];
        part.count = vertices;
        for (size_t k = 0; k < he_mesh_columns(m) && i > 0; k++) {
            if (he_mesh_column(m, k) == part.column && is_exact(m, &part)) {
                used[k] = part.column;
            }
        }
        add(g, part);
    }
}

/* Returns true if corners have attributes. Then the corners of faces must be stored if triangles
 * are compressed, because a compressed triangle may begin at another of its corners. */
static bool has_corner_values(const he_mesh *m)
{
    for (size_t i = 0; i < he_mesh_columns(m); i++) {
        const he_column *column = he_mesh_column(m, i);
        if (column != NULL && column->domain == HE_HALFEDGE) {
            return m->c.faces.live > 0;
        }
    }
    return false;
}

static void add_rest_of_geometry(he_glb_parts *g)
{
    const he_mesh *m = g->mesh;
    uint64_t faces = m->c.faces.live, copies = g->splits.copies.count;
    bool few = m->c.vertices.live + copies <= SHORT_VERTICES;
    if (faces > 0) {
        add(g, (he_glb_part){.content = HE_GLB_TRIANGLES,
                             .type = few ? HE_GLTF_UINT16 : HE_GLTF_UINT32,
                             .components = 1,
                             .count = 3 * he_export_triangles_count(&g->cuts),
                             .stride = few ? 2 : 4});
    }
    he_glb_part words = {.type = HE_GLTF_UINT32, .components = 1, .stride = 4};
    if (copies > 0) {
        words.content = HE_GLB_COPIES;
        words.count = copies;
        add(g, words);
    }
    if (g->cuts.polygons > 0 || (g->packs && has_corner_values(m))) {
        words.content = HE_GLB_DEGREES;
        words.count = faces;
        add(g, words);
        words.content = HE_GLB_CORNERS;
        words.count = corner_count(m);
        add(g, words);
    }
    if (g->groups.order != NULL) {
        words.content = HE_GLB_ORDER;
        words.count = faces;
        add(g, words);
    }
}

static he_status add_parts(he_glb_parts *g, const he_column **used, he_progress *progress,
                           he_warnings *warnings, he_error *err)
{
    add_values(g, warnings);
    he_status status = split(g, progress, err);
    if (status == HE_OK) {
        place_values(g, used);
        add_rest_of_geometry(g);
        add_rest(g, used, warnings);
    }
    return status;
}

static he_status note_positions(const he_mesh *m, he_warnings *warnings, he_error *err)
{
    he_narrowed narrowed = {0};
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (he_vertex_is_live(m, (he_vertex){v})) {
            he_narrowed_add(&narrowed, v, m->c.position[v]);
        }
    }
    return he_narrowed_finish(&narrowed, warnings, err);
}

static void note_geometry(const he_glb_parts *g, he_warnings *warnings)
{
    he_warnings_add_count(
        warnings, "triangulated",
        "a face is cut into triangles for other programs, and also stored whole for hedge",
        g->cuts.polygons);
    he_warnings_add_count(warnings, "split_vertices",
                          "a vertex is duplicated for other programs, because values of its "
                          "corners differ, and hedge merges the copies when it reads the file",
                          g->splits.copies.count);
    he_warnings_add_count(warnings, "turned_triangles",
                          "a face is cut into triangles of which some have no area or are "
                          "reversed, because no better cut was found",
                          g->cuts.turned);
}

static he_status make(he_glb_parts *g, he_progress *progress, he_warnings *warnings, he_error *err)
{
    size_t columns = he_mesh_columns(g->mesh);
    he_status status = note_positions(g->mesh, warnings, err);
    if (status == HE_OK) {
        status = he_export_triangles_make(g->mesh, progress, &g->cuts, err);
    }
    if (status == HE_OK) {
        status = he_glb_groups_make(g->mesh, warnings, &g->groups, err);
    }
    if (status == HE_OK) {
        status = he_export_numbers(g->mesh, &g->numbers, err);
    }
    if (status != HE_OK) {
        return status;
    }
    g->capacity = 6 + 2 * columns;
    g->parts = he_mem_array(NULL, g->capacity, sizeof *g->parts);
    const he_column **used = he_mem_zero(columns + 1, sizeof *used);
    if (g->parts == NULL || used == NULL) {
        he_mem_free(used);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu attributes", columns);
    }
    if (g->mesh->c.vertices.live > 0) {
        status = add_parts(g, used, progress, warnings, err);
    }
    note_geometry(g, warnings);
    he_export_note_lost(g->mesh, used, columns, warnings);
    he_mem_free(used);
    return status;
}

he_status he_glb_parts_make(const he_mesh *mesh, bool packs, he_progress *progress,
                            he_warnings *warnings, he_glb_parts *out, he_error *err)
{
    he_glb_parts made = {.mesh = mesh, .packs = packs};
    he_status status = make(&made, progress, warnings, err);
    if (status != HE_OK) {
        he_glb_parts_clear(&made);
        return status;
    }
    *out = made;
    return HE_OK;
}
