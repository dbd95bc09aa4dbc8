#include "format/obj/obj.h"

#include "format/io/colors.h"
#include "format/obj/mtl.h"
#include "format/obj/obj_name.h"
#include "format/text/number.h"

#include <string.h>

/* The parts of an OBJ document, in the order in which they are written. */
typedef enum part { HEADER, LIBRARIES, VERTICES, UVS, NORMALS, FACES, END } part;

/* The kinds of lines that apply to all faces after them, until the next line of the same kind. */
enum { OBJECT, GROUP, MATERIAL, SMOOTHING, GROUPS };

static const struct {
    const char *attribute, *keyword;
} groups[GROUPS] = {{"object", "o"}, {"group", "g"}, {"material", "usemtl"}, {"smoothing", "s"}};

/* A source of texture coordinates or normals: an attribute of corners, or of vertices, or none. */
typedef struct values {
    const he_column *column;
    const char *keyword;
    bool of_corners;
    he_distinct distinct; /* for corners */
} values;

typedef struct obj_writer {
    const he_mesh *mesh;
    uint32_t *numbers; /* number of each vertex in the file; NULL if the ids are the numbers */
    const he_column *color;
    values uv, normal;
    const he_column *groups[GROUPS];
    uint32_t said[GROUPS]; /* for each kind of line (OBJECT, GROUP ...), the value in the last such
                            * line; HE_NONE before the first one */
    part part;
    uint32_t row;      /* the next vertex, value or face to write */
    uint32_t stop;     /* the row before which a piece of the document ends; HE_NONE: no piece */
    uint32_t halfedge; /* the next corner of the face being written, or HE_NONE */
    he_obj_name name;
    const char *libraries[HE_COLUMN_COMPONENTS];
    size_t library_count;
} obj_writer;

static const char *label_of(const he_column *column, uint32_t value)
{
    return value < he_labels_count(column->labels) ? he_labels_get(column->labels, value) : "";
}

static void note_changed_names(const he_column *column, he_warnings *warnings)
{
    for (size_t i = 0; i < he_labels_count(column->labels); i++) {
        he_obj_note_name(he_labels_get(column->labels, i), warnings);
    }
}

static he_status find_values(values *v, const he_mesh *mesh, const char *name, uint32_t least,
                             he_progress *progress, he_warnings *warnings, he_error *err)
{
    v->column = he_export_find(mesh, HE_HALFEDGE, name, least, 3, warnings);
    if (v->column != NULL) {
        v->of_corners = true;
        return he_distinct_make(mesh, &v->column, 1, false, progress, &v->distinct, err);
    }
    v->column = he_export_find(mesh, HE_VERTEX, name, least, 3, warnings);
    return HE_OK;
}

/* Counts the vertices without a face whose texture coordinate or normal is not the default. No
 * corner in the file refers to such a value. */
static uint64_t count_unnamed(const values *v, const he_mesh *mesh)
{
    uint64_t count = 0;
    for (uint32_t i = 0; v->column != NULL && !v->of_corners && i < mesh->c.vertices.issued; i++) {
        he_vertex vertex = {i};
        count +=
            he_vertex_is_live(mesh, vertex) && he_is_isolated(mesh, vertex) &&
            memcmp(he_column_value(v->column, i), v->column->fallback, v->column->row_bytes) != 0;
    }
    return count;
}

static void note_unnamed(const obj_writer *w, he_warnings *warnings)
{
    he_warnings_add_count(warnings, "unnamed_uv",
                          "the texture coordinates of a vertex will be lost when the file is read, "
                          "because OBJ files give them to corners and the vertex has no face",
                          count_unnamed(&w->uv, w->mesh));
    he_warnings_add_count(warnings, "unnamed_normal",
                          "the normal of a vertex will be lost when the file is read, because OBJ "
                          "files give normals to corners and the vertex has no face",
                          count_unnamed(&w->normal, w->mesh));
}

/* Finds the names of the material libraries. Returns the attribute that has them, or NULL. */
static const he_column *find_libraries(obj_writer *w, he_warnings *warnings)
{
    w->library_count = he_mtl_names(w->mesh, w->libraries);
    for (size_t i = 0; i < w->library_count; i++) {
        he_obj_note_name(w->libraries[i], warnings);
    }
    if (he_materials_count(he_mesh_materials(w->mesh)) > 0) {
        he_warnings_add(warnings,
                        &(he_occurrence){
                            .code = "in_library",
                            .text = "the colours and other properties of materials are not written "
                                    "to this file, but to the material library (format=mtl)"});
    }
    return he_mesh_find_column(w->mesh, HE_MESH_KIND, HE_OBJ_LIBRARY);
}

static void obj_close(void *state)
{
    obj_writer *w = state;
    he_mem_free(w->numbers);
    he_distinct_clear(&w->uv.distinct);
    he_distinct_clear(&w->normal.distinct);
    he_mem_free(w);
}

static he_status obj_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    (void)encoding;
    obj_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the OBJ file");
    }
    w->mesh = mesh;
    w->halfedge = w->stop = HE_NONE;
    w->uv.keyword = "vt";
    w->normal.keyword = "vn";
    w->said[OBJECT] = w->said[GROUP] = w->said[MATERIAL] = HE_NONE;
    he_status status = he_export_numbers(mesh, &w->numbers, err);
    if (status == HE_OK) {
        status = find_values(&w->uv, mesh, "uv", 2, progress, warnings, err);
    }
    if (status == HE_OK) {
        status = find_values(&w->normal, mesh, "normal", 3, progress, warnings, err);
    }
    if (status != HE_OK) {
        obj_close(w);
        return status;
    }
    w->color = he_colors_find(mesh, HE_VERTEX, warnings);
    if (w->color != NULL && w->color->components == 4) {
        he_warnings_add(warnings, &(he_occurrence){
                                      .code = "alpha_lost",
                                      .text = "the fourth component of attribute % is not written, "
                                              "because OBJ files hold only red, green and blue",
                                      .subject = "vertex color",
                                      .length = strlen("vertex color")});
    }
    const he_column *used[GROUPS + 4] = {w->color, w->uv.column, w->normal.column};
    used[GROUPS + 3] = find_libraries(w, warnings);
    for (size_t i = 0; i < GROUPS; i++) {
        const he_column *column = he_mesh_find_column(mesh, HE_FACE, groups[i].attribute);
        bool named = i != SMOOTHING;
        if (column != NULL && column->type == HE_UINT32 && column->components == 1 &&
            (column->labels != NULL) == named) {
            w->groups[i] = used[3 + i] = column;
            if (named) {
                note_changed_names(column, warnings);
            }
        }
    }
    note_unnamed(w, warnings);
    he_export_note_lost(mesh, used, GROUPS + 4, warnings);
    *state = w;
    return HE_OK;
}

static char *write_header(const obj_writer *w, char *p)
{
    p = he_export_text("# ", p);
    p += he_u32_print(he_mesh_vertices(w->mesh), p);
    p = he_export_text(" vertices, ", p);
    p += he_u32_print(he_mesh_faces(w->mesh), p);
    return he_export_text(" faces\n", p);
}

static char *write_libraries(obj_writer *w, char *p, const char *end)
{
    if (w->name.rest != NULL) {
        return he_obj_name_write(&w->name, p, end);
    }
    if (w->row == w->library_count) {
        w->row = 0;
        w->part++;
        return p;
    }
    w->name.rest = w->libraries[w->row++];
    return he_export_text("mtllib ", p);
}

static char *write_vertex(const obj_writer *w, uint32_t v, char *p)
{
    const double *position = &w->mesh->c.position[v].x;
    *p++ = 'v';
    for (size_t i = 0; i < 3; i++) {
        *p++ = ' ';
        p += he_double_print(position[i], p);
    }
    for (uint32_t i = 0; w->color != NULL && i < 3; i++) {
        *p++ = ' ';
        p = he_export_value(w->color, v, i, p);
    }
    *p++ = '\n';
    return p;
}

static char *write_value(const values *v, uint32_t row, char *p)
{
    p = he_export_row(v->column, v->of_corners ? v->distinct.first.ids[row] : row,
                      he_export_text(v->keyword, p));
    *p++ = '\n';
    return p;
}

/* Returns true if a part of the document has a line for `row`, which is a vertex or the value of a
 * corner. */
static bool has_row(const obj_writer *w, const values *v, uint32_t row)
{
    return (v != NULL && v->of_corners) || he_vertex_is_live(w->mesh, (he_vertex){row});
}

static uint32_t value_count(const obj_writer *w, const values *v)
{
    if (v->column == NULL) {
        return 0;
    }
    return v->of_corners ? (uint32_t)v->distinct.first.count : w->mesh->c.vertices.issued;
}

/* Returns the number of rows of the part that is being written, or the row at which it ends. */
static uint32_t end_of_part(const obj_writer *w)
{
    uint32_t count = 0;
    switch (w->part) {
    case VERTICES:
        count = w->mesh->c.vertices.issued;
        break;
    case UVS:
        count = value_count(w, &w->uv);
        break;
    case NORMALS:
        count = value_count(w, &w->normal);
        break;
    case FACES:
        count = w->mesh->c.faces.issued;
        break;
    case HEADER:
    case LIBRARIES:
    case END:
        break;
    }
    return w->stop < count ? w->stop : count;
}

/* Writes the lines of a part of the document: vertices, or, if `v` is not NULL, texture coordinates
 * or normals. */
static char *write_rows(obj_writer *w, const values *v, char *p, const char *end)
{
    uint32_t count = end_of_part(w);
    while (w->row < count && end - p >= HE_WRITE_ROOM) {
        uint32_t row = w->row++;
        if (has_row(w, v, row)) {
            p = v == NULL ? write_vertex(w, row, p) : write_value(v, row, p);
        }
    }
    if (w->row == count) {
        w->row = 0;
        w->part = w->stop == HE_NONE ? w->part + 1 : END;
    }
    return p;
}

/* Writes the line for the first attribute (object, group, material or smoothing) in which the face
 * differs from the lines written last. */
static char *write_span(obj_writer *w, uint32_t face, char *p)
{
    for (size_t i = 0; i < GROUPS; i++) {
        uint32_t value;
        if (w->groups[i] == NULL) {
            continue;
        }
        memcpy(&value, he_column_value(w->groups[i], face), sizeof value);
        if (value == w->said[i]) {
            continue;
        }
        bool first = w->said[i] == HE_NONE;
        w->said[i] = value;
        if (first && i != SMOOTHING && *label_of(w->groups[i], value) == '\0') {
            continue;
        }
        p = he_export_text(groups[i].keyword, p);
        if (i == SMOOTHING) {
            *p++ = ' ';
            p += he_u32_print(value, p);
            *p++ = '\n';
        } else {
            w->name.rest = label_of(w->groups[i], value);
            if (*w->name.rest != '\0') {
                *p++ = ' ';
            }
        }
        break;
    }
    return p;
}

static uint32_t value_number(const values *v, uint32_t h, uint32_t vertex)
{
    return v->of_corners ? v->distinct.number[h] : vertex;
}

static char *write_corner(const obj_writer *w, uint32_t h, char *p)
{
    uint32_t id = w->mesh->c.origin[h];
    uint32_t vertex = w->numbers != NULL ? w->numbers[id] : id;
    *p++ = ' ';
    p += he_u32_print(vertex + 1, p);
    if (w->uv.column != NULL || w->normal.column != NULL) {
        *p++ = '/';
        if (w->uv.column != NULL) {
            p += he_u32_print(value_number(&w->uv, h, vertex) + 1, p);
        }
        if (w->normal.column != NULL) {
            *p++ = '/';
            p += he_u32_print(value_number(&w->normal, h, vertex) + 1, p);
        }
    }
    return p;
}

static char *write_faces(obj_writer *w, char *p, const char *end)
{
    const he_content *c = &w->mesh->c;
    uint32_t count = end_of_part(w);
    while (end - p >= HE_WRITE_ROOM) {
        if (w->name.rest != NULL) {
            p = he_obj_name_write(&w->name, p, end);
        } else if (w->halfedge != HE_NONE) {
            p = write_corner(w, w->halfedge, p);
            w->halfedge = c->next[w->halfedge];
            if (w->halfedge == c->face_halfedge[w->row]) {
                *p++ = '\n';
                w->halfedge = HE_NONE;
                w->row++;
            }
        } else if (w->row == count) {
            w->part = END;
            break;
        } else if (c->face_halfedge[w->row] == HE_DEAD) {
            w->row++;
        } else {
            char *before = p;
            p = write_span(w, w->row, p);
            if (p == before) {
                *p++ = 'f';
                w->halfedge = c->face_halfedge[w->row];
            }
        }
    }
    return p;
}

static bool obj_step(void *state, char **p, const char *end)
{
    obj_writer *w = state;
    switch (w->part) {
    case HEADER:
        *p = write_header(w, *p);
        w->part = LIBRARIES;
        break;
    case LIBRARIES:
        *p = write_libraries(w, *p, end);
        break;
    case VERTICES:
        *p = write_rows(w, NULL, *p, end);
        break;
    case UVS:
        *p = write_rows(w, &w->uv, *p, end);
        break;
    case NORMALS:
        *p = write_rows(w, &w->normal, *p, end);
        break;
    case FACES:
        *p = write_faces(w, *p, end);
        break;
    case END:
        break;
    }
    return w->part != END;
}

/* Notes the values of the last live face before `end`, at or after the row of the writer, as if its
 * lines had been written. */
static void skip_spans(obj_writer *w, uint32_t end)
{
    uint32_t face = end;
    while (face > w->row && w->mesh->c.face_halfedge[face - 1] == HE_DEAD) {
        face--;
    }
    for (size_t i = 0; i < GROUPS && face > w->row; i++) {
        if (w->groups[i] != NULL) {
            memcpy(&w->said[i], he_column_value(w->groups[i], face - 1), sizeof w->said[i]);
        }
    }
}

static bool obj_cut(void *state, void *piece, uint32_t rows)
{
    obj_writer *w = state, *out = piece;
    uint32_t count = end_of_part(w);
    if (w->row >= count || w->halfedge != HE_NONE || w->name.rest != NULL) {
        return false;
    }
    *out = *w;
    out->stop = count - w->row < rows ? count : w->row + rows;
    if (w->part == FACES) {
        skip_spans(w, out->stop);
    }
    w->row = out->stop;
    return true;
}

const he_writing he_obj_writing = {
    .open = obj_open,
    .step = obj_step,
    .close = obj_close,
    .cut = obj_cut,
    .state_bytes = sizeof(obj_writer),
};
