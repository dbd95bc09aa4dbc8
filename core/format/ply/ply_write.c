#include "format/ply/ply.h"

#include "format/io/colors.h"
#include "format/io/splits.h"
#include "format/ply/ply_groups.h"
#include "format/text/number.h"

#include <string.h>

/* The parts of a PLY document, in the order in which they are written. */
typedef enum part { HEADER, VERTICES, COPIES, FACES, END } part;

/* Room for one value, or for one line of the header. */
enum { VALUE_ROOM = 160 };

/* One number of a row. */
typedef struct output {
    const char *name;
    /* attribute to which the number belongs; NULL if it is a coordinate, or if `own` is set */
    const he_column *column;
    uint32_t component;
    he_ply_type type;
    bool color; /* true if the number is a component of a colour, written as a byte */
    bool own;   /* true if the number is the vertex's own number in the file */
} output;

typedef struct ply_writer {
    const he_mesh *mesh;
    uint32_t *numbers; /* numbers of vertices */
    he_splits splits;  /* copies of vertices whose corners have different values */
    /* The attributes of corners that are written as properties of vertices. */
    const he_column *corners[HE_PLY_GROUPS];
    size_t corner_count;
    const he_column *texcoord; /* attribute of `corners` that is also written as lists of faces */
    he_ply_encoding encoding;
    /* Describes the numbers in the row of a vertex, then those in the row of a face. */
    output *outputs;
    size_t vertex_outputs, count;
    he_ply_type degree; /* type in which a face's number of corners is written */
    he_ply_type list;   /* type in which the length of a face's texcoord list is written */
    part part;
    size_t line;       /* index in `outputs` of the next property to write in the header */
    uint32_t row;      /* the next vertex, copy or face */
    uint32_t stop;     /* the row before which a piece of the document ends; HE_NONE: no piece */
    size_t output;     /* index in `outputs` of the next number to write in the row */
    bool in_list;      /* true if the texture coordinates of the row have begun */
    bool in_face;      /* true if the corners of the row have begun */
    uint32_t halfedge; /* the next corner of the face being written, or HE_NONE */
} ply_writer;

static void ply_close(void *state)
{
    ply_writer *w = state;
    he_mem_free(w->numbers);
    he_splits_clear(&w->splits);
    he_mem_free(w->outputs);
    he_mem_free(w);
}

/* --- choosing which properties are written --- */

static bool positions_are_floats(const he_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->c.vertices.issued; v++) {
        if (he_vertex_is_live(mesh, (he_vertex){v}) && !he_are_floats(mesh->c.position[v])) {
            return false;
        }
    }
    return true;
}

/* Returns an integer type that can hold the length of each face's list, which has `numbers` numbers
 * for each corner. */
static he_ply_type type_of_degree(const he_mesh *mesh, uint32_t numbers)
{
    for (uint32_t f = 0; f < mesh->c.faces.issued; f++) {
        if (he_face_is_live(mesh, (he_face){f}) &&
            he_face_degree(mesh, (he_face){f}) > UINT8_MAX / numbers) {
            return HE_PLY_UINT32;
        }
    }
    return HE_PLY_UINT8;
}

static he_ply_type type_of(const he_column *column)
{
    switch (column->type) {
    case HE_BOOL:
        return HE_PLY_UINT8;
    case HE_INT32:
        return HE_PLY_INT32;
    case HE_UINT32:
        return HE_PLY_UINT32;
    case HE_FLOAT:
        return HE_PLY_FLOAT;
    case HE_DOUBLE:
    case HE_TYPE_COUNT:
        break;
    }
    return HE_PLY_DOUBLE;
}

static void add(ply_writer *w, const char *name, const he_column *column, uint32_t component,
                he_ply_type type)
{
    w->outputs[w->count++] =
        (output){.name = name, .column = column, .component = component, .type = type};
}

static const he_column *find_group(const ply_writer *w, const he_ply_group *group, he_kind domain,
                                   he_warnings *warnings)
{
    return group->color ? he_colors_find(w->mesh, domain, warnings)
                        : he_export_find(w->mesh, domain, group->attribute, group->least,
                                         group->most, warnings);
}

/* Adds the properties of a group to what is written. An attribute of corners takes precedence over
 * one of vertices. */
static void add_group(ply_writer *w, const he_ply_group *group, he_kind domain,
                      he_warnings *warnings)
{
    const he_column *column = NULL;
    uint64_t lost = 0;
    if (domain == HE_VERTEX && he_mesh_faces(w->mesh) > 0) {
        column = find_group(w, group, HE_HALFEDGE, warnings);
        if (column != NULL) {
            w->corners[w->corner_count++] = column;
            w->texcoord = strcmp(group->attribute, "uv") == 0 ? column : w->texcoord;
        }
    }
    column = column != NULL ? column : find_group(w, group, domain, warnings);
    for (uint32_t i = 0; column != NULL && i < column->components; i++) {
        add(w, group->names[i], column, i, group->color ? HE_PLY_UINT8 : type_of(column));
        w->outputs[w->count - 1].color = group->color;
    }
    if (column != NULL && group->color && !he_colors_are_bytes(w->mesh, column, &lost)) {
        he_warnings_add_count(warnings, "rounded_colors",
                              "a colour is rounded to 8 bits per component, because PLY files are "
                              "written with colours of bytes",
                              lost);
    }
}

static bool is_taken(const ply_writer *w, size_t first, const char *name)
{
    static const char *const own[] = {"vertex_indices",   "vertex_index", "x", "y", "z",
                                      HE_PLY_VERTEX_MARK, HE_PLY_TEXCOORD};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++) {
        if (strcmp(own[i], name) == 0) {
            return true;
        }
    }
    for (size_t i = first; i < w->count; i++) {
        if (strcmp(w->outputs[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Returns true if a name is one word, as the name of a property must be. */
static bool is_word(const char *name)
{
    for (const char *p = name; *p != '\0'; p++) {
        if (*p <= 0x20 || *p >= 0x7F) {
            return false;
        }
    }
    return true;
}

static void add_attributes(ply_writer *w, he_kind domain, const he_column **used,
                           he_warnings *warnings)
{
    size_t first = w->count;
    for (size_t g = 0; g < HE_PLY_GROUPS; g++) {
        if (he_ply_groups[g].written) {
            add_group(w, &he_ply_groups[g], domain, warnings);
        }
    }
    for (size_t i = 0; i < he_mesh_columns(w->mesh); i++) {
        const he_column *column = he_mesh_column(w->mesh, i);
        if (column != NULL && column->domain == domain && is_word(column->name) &&
            !is_taken(w, first, column->name) &&
            he_export_find(w->mesh, domain, column->name, 1, 1, warnings) != NULL) {
            add(w, column->name, column, 0, type_of(column));
        }
    }
    for (size_t i = first; i < w->count; i++) {
        used[i] = w->outputs[i].column;
    }
}

static he_status split(ply_writer *w, he_progress *progress, he_warnings *warnings, he_error *err)
{
    if (w->corner_count == 0) {
        return HE_OK;
    }
    he_status status =
        he_splits_make(w->mesh, w->numbers, w->corners, w->corner_count, progress, &w->splits, err);
    if (status == HE_OK && w->splits.copies.count > 0) {
        add(w, HE_PLY_VERTEX_MARK, NULL, 0, HE_PLY_UINT32);
        w->outputs[w->count - 1].own = true;
        he_warnings_add_count(warnings, "split_vertices",
                              "a vertex is duplicated for other programs, because values of its "
                              "corners differ, and hedge merges the copies when it reads the file",
                              w->splits.copies.count);
    }
    return status;
}

static he_status choose_outputs(ply_writer *w, he_progress *progress, he_warnings *warnings,
                                he_error *err)
{
    size_t most = 4;
    for (size_t i = 0; i < he_mesh_columns(w->mesh); i++) {
        const he_column *column = he_mesh_column(w->mesh, i);
        most += column == NULL ? 0 : column->components;
    }
    const he_column **used = he_mem_array(NULL, most, sizeof *used);
    w->outputs = he_mem_array(NULL, most, sizeof *w->outputs);
    if (used == NULL || w->outputs == NULL) {
        he_mem_free(used);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu properties", most);
    }
    static const char *const names[3] = {"x", "y", "z"};
    he_ply_type type = positions_are_floats(w->mesh) ? HE_PLY_FLOAT : HE_PLY_DOUBLE;
    for (uint32_t i = 0; i < 3; i++) {
        used[i] = NULL;
        add(w, names[i], NULL, i, type);
    }
    add_attributes(w, HE_VERTEX, used, warnings);
    used[w->count] = NULL;
    he_status status = split(w, progress, warnings, err);
    w->vertex_outputs = w->count;
    add_attributes(w, HE_FACE, used, warnings);
    he_export_note_lost(w->mesh, used, w->count, warnings);
    he_export_note_materials(w->mesh, warnings);
    he_mem_free(used);
    return status;
}

static he_status ply_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    /* This array has the order in which the table of formats (format.c) lists the encodings of
     * PLY. */
    static const he_ply_encoding encodings[] = {HE_PLY_LITTLE_ENDIAN, HE_PLY_ASCII,
                                                HE_PLY_BIG_ENDIAN};
    ply_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the PLY file");
    }
    w->mesh = mesh;
    w->encoding = encodings[encoding];
    w->halfedge = w->stop = HE_NONE;
    he_status status = he_export_numbers(mesh, &w->numbers, err);
    if (status == HE_OK) {
        status = choose_outputs(w, progress, warnings, err);
    }
    if (status != HE_OK) {
        ply_close(w);
        return status;
    }
    w->degree = type_of_degree(mesh, 1);
    w->list = type_of_degree(mesh, 2);
    *state = w;
    return HE_OK;
}

/* --- writing the document --- */

static char *put_whole(uint32_t value, size_t bytes, bool big, char *p)
{
    for (size_t i = 0; i < bytes; i++) {
        size_t shift = 8 * (big ? bytes - 1 - i : i);
        *p++ = (char)(unsigned char)(value >> shift);
    }
    return p;
}

static char *put_value(double value, he_ply_type type, bool big, char *p)
{
    uint64_t bits;
    uint32_t half;
    if (type == HE_PLY_DOUBLE) {
        memcpy(&bits, &value, sizeof bits);
        p = put_whole((uint32_t)(big ? bits >> 32 : bits), 4, big, p);
        return put_whole((uint32_t)(big ? bits : bits >> 32), 4, big, p);
    }
    if (type == HE_PLY_FLOAT) {
        float number = he_narrow(value);
        memcpy(&half, &number, sizeof half);
    } else {
        half = (uint32_t)(int64_t)value;
    }
    return put_whole(half, he_ply_type_bytes(type), big, p);
}

static char *write_whole(const ply_writer *w, uint32_t value, he_ply_type type, bool first, char *p)
{
    if (w->encoding != HE_PLY_ASCII) {
        return put_whole(value, he_ply_type_bytes(type), w->encoding == HE_PLY_BIG_ENDIAN, p);
    }
    if (!first) {
        *p++ = ' ';
    }
    return p + he_u32_print(value, p);
}

/* Writes the next number of a row, w->outputs[w->output]; the caller then increments w->output.
 * `row` is the vertex or face; attributes of corners are read at the half-edge `corner`. */
static char *write_output(const ply_writer *w, uint32_t row, uint32_t corner, char *p)
{
    const output *o = &w->outputs[w->output];
    const bool first = w->output == 0; /* the line begins with it */
    if (o->own) {
        return write_whole(w, w->numbers != NULL ? w->numbers[row] : row, o->type, first, p);
    }
    size_t at = o->column != NULL && o->column->domain == HE_HALFEDGE ? corner : row;
    double value = o->column != NULL ? he_export_number(o->column, at, o->component)
                                     : (&w->mesh->c.position[row].x)[o->component];
    if (o->color) {
        return write_whole(w, he_color_byte(value), HE_PLY_UINT8, first, p);
    }
    if (w->encoding != HE_PLY_ASCII) {
        return put_value(value, o->type, w->encoding == HE_PLY_BIG_ENDIAN, p);
    }
    if (!first) {
        *p++ = ' ';
    }
    return o->column != NULL ? he_export_value(o->column, at, o->component, p)
                             : p + he_double_print(value, p);
}

static char *write_element(const char *name, uint32_t count, char *p)
{
    p = he_export_text(name, he_export_text("element ", p));
    *p++ = ' ';
    p += he_u32_print(count, p);
    *p++ = '\n';
    return p;
}

static char *write_mark(const ply_writer *w, char *p)
{
    for (size_t i = 0; i < w->corner_count; i++) {
        p = i > 0 ? p : he_export_text("comment " HE_PLY_CORNERS_MARK, p);
        *p++ = ' ';
        p = he_export_text(w->corners[i]->name, p);
    }
    if (w->corner_count > 0) {
        *p++ = '\n';
    }
    return p;
}

static char *write_header(ply_writer *w, char *p)
{
    static const char *const names[] = {
        [HE_PLY_UNKNOWN] = "",
        [HE_PLY_ASCII] = "ascii",
        [HE_PLY_LITTLE_ENDIAN] = "binary_little_endian",
        [HE_PLY_BIG_ENDIAN] = "binary_big_endian",
    };
    if (w->line == 0) {
        p = he_export_text(" 1.0\n",
                           he_export_text(names[w->encoding], he_export_text("ply\nformat ", p)));
        p = write_mark(w, p);
        p = write_element("vertex", he_mesh_vertices(w->mesh) + (uint32_t)w->splits.copies.count,
                          p);
    }
    if (w->line == w->vertex_outputs) {
        p = write_element("face", he_mesh_faces(w->mesh), p);
        p = he_export_text(he_ply_type_name(w->degree), he_export_text("property list ", p));
        p = he_export_text(" int vertex_indices\n", p);
        if (w->texcoord != NULL) {
            p = he_export_text(he_ply_type_name(w->list), he_export_text("property list ", p));
            p = he_export_text(" float " HE_PLY_TEXCOORD "\n", p);
        }
    }
    if (w->line == w->count) {
        w->part = VERTICES;
        return he_export_text("end_header\n", p);
    }
    const output *o = &w->outputs[w->line++];
    p = he_export_text(he_ply_type_name(o->type), he_export_text("property ", p));
    *p++ = ' ';
    p = he_export_text(o->name, p);
    *p++ = '\n';
    return p;
}

static char *end_row(ply_writer *w, size_t first, char *p)
{
    w->row++;
    w->output = first;
    if (w->encoding == HE_PLY_ASCII) {
        *p++ = '\n';
    }
    return p;
}

/* Returns the row at which the part that is being written ends; 0 in a part without rows. */
static uint32_t end_of_part(const ply_writer *w)
{
    const he_content *c = &w->mesh->c;
    uint32_t count = w->part == VERTICES ? c->vertices.issued
                     : w->part == COPIES ? (uint32_t)w->splits.copies.count
                     : w->part == FACES  ? c->faces.issued
                                         : 0;
    return w->stop < count ? w->stop : count;
}

static char *write_vertices(ply_writer *w, char *p, const char *end)
{
    uint32_t count = end_of_part(w);
    while (w->row < count && end - p >= VALUE_ROOM) {
        if (!he_vertex_is_live(w->mesh, (he_vertex){w->row})) {
            w->row++;
            continue;
        }
        uint32_t corner = w->splits.own != NULL ? w->splits.own[w->row] : HE_NONE;
        p = write_output(w, w->row, corner, p);
        w->output++;
        if (w->output == w->vertex_outputs) {
            p = end_row(w, 0, p);
        }
    }
    if (w->row == count) {
        w->row = 0;
        w->part = w->stop == HE_NONE ? COPIES : END;
    }
    return p;
}

static char *write_copies(ply_writer *w, char *p, const char *end)
{
    const he_ids *copies = &w->splits.copies;
    uint32_t count = end_of_part(w);
    while (w->row < count && end - p >= VALUE_ROOM) {
        uint32_t corner = copies->ids[w->row], vertex = w->mesh->c.origin[corner];
        p = write_output(w, vertex, corner, p);
        w->output++;
        if (w->output == w->vertex_outputs) {
            p = end_row(w, 0, p);
        }
    }
    if (w->row == count) {
        w->row = 0;
        w->output = w->vertex_outputs;
        w->part = w->stop == HE_NONE ? FACES : END;
    }
    return p;
}

static char *write_corner(const ply_writer *w, uint32_t h, char *p)
{
    uint32_t id = w->mesh->c.origin[h];
    uint32_t number = w->splits.number != NULL ? w->splits.number[h]
                      : w->numbers != NULL     ? w->numbers[id]
                                               : id;
    return write_whole(w, number, HE_PLY_INT32, false, p);
}

static char *write_texcoord(const ply_writer *w, uint32_t h, char *p)
{
    for (uint32_t i = 0; i < 2; i++) {
        double value = he_export_number(w->texcoord, h, i);
        if (w->encoding != HE_PLY_ASCII) {
            p = put_value(value, HE_PLY_FLOAT, w->encoding == HE_PLY_BIG_ENDIAN, p);
        } else {
            *p++ = ' ';
            p += he_float_print(he_narrow(value), p);
        }
    }
    return p;
}

static char *begin_list(ply_writer *w, uint32_t numbers, he_ply_type type, char *p)
{
    uint32_t degree = he_face_degree(w->mesh, (he_face){w->row});
    w->halfedge = w->mesh->c.face_halfedge[w->row];
    w->in_list = numbers > 1;
    return write_whole(w, numbers * degree, type, !w->in_list, p);
}

/* Writes the rest of a face's list, corner by corner: first the list of vertices, then the list of
 * texture coordinates. */
static char *write_list(ply_writer *w, char *p)
{
    const he_content *c = &w->mesh->c;
    uint32_t h = w->halfedge;
    p = w->in_list ? write_texcoord(w, h, p) : write_corner(w, h, p);
    w->halfedge = c->next[h] == c->face_halfedge[w->row] ? HE_NONE : c->next[h];
    if (w->halfedge == HE_NONE && w->texcoord != NULL && !w->in_list) {
        p = begin_list(w, 2, w->list, p);
    }
    return p;
}

static char *write_faces(ply_writer *w, char *p, const char *end)
{
    const he_content *c = &w->mesh->c;
    uint32_t count = end_of_part(w);
    while (end - p >= VALUE_ROOM) {
        if (w->halfedge != HE_NONE) {
            p = write_list(w, p);
        } else if (w->in_face && w->output < w->count) {
            p = write_output(w, w->row, HE_NONE, p);
            w->output++;
        } else if (w->in_face) {
            p = end_row(w, w->vertex_outputs, p);
            w->in_face = false;
        } else if (w->row == count) {
            w->part = END;
            break;
        } else if (c->face_halfedge[w->row] == HE_DEAD) {
            w->row++;
        } else {
            w->in_face = true;
            p = begin_list(w, 1, w->degree, p);
        }
    }
    return p;
}

static bool ply_step(void *state, char **p, const char *end)
{
    ply_writer *w = state;
    switch (w->part) {
    case HEADER:
        *p = write_header(w, *p);
        break;
    case VERTICES:
        *p = write_vertices(w, *p, end);
        break;
    case COPIES:
        *p = write_copies(w, *p, end);
        break;
    case FACES:
        *p = write_faces(w, *p, end);
        break;
    case END:
        break;
    }
    return w->part != END;
}

static bool ply_cut(void *state, void *piece, uint32_t rows)
{
    ply_writer *w = state, *out = piece;
    uint32_t count = end_of_part(w);
    size_t first = w->part == FACES ? w->vertex_outputs : 0;
    if (w->row >= count || w->in_face || w->output != first) {
        return false;
    }
    *out = *w;
    out->stop = w->row = count - w->row < rows ? count : w->row + rows;
    return true;
}

const he_writing he_ply_writing = {
    .open = ply_open,
    .step = ply_step,
    .close = ply_close,
    .cut = ply_cut,
    .state_bytes = sizeof(ply_writer),
};
