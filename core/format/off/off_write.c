#include "format/off/off.h"

#include "format/io/colors.h"
#include "format/text/number.h"

#include <string.h>

/* The parts of an OFF document, in the order in which they are written. */
typedef enum part { HEADER, VERTICES, FACES, END } part;

typedef struct off_writer {
    const he_mesh *mesh;
    uint32_t *numbers; /* numbers of vertices */
    const he_column *normal, *color, *uv, *face_color;
    part part;
    uint32_t row;      /* the next vertex or face */
    uint32_t stop;     /* the row before which a piece of the document ends; HE_NONE: no piece */
    uint32_t halfedge; /* the next corner of the face being written, or HE_NONE */
} off_writer;

static void off_close(void *state)
{
    off_writer *w = state;
    he_mem_free(w->numbers);
    he_mem_free(w);
}

static he_status off_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    (void)encoding;
    (void)progress;
    off_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the OFF file");
    }
    w->mesh = mesh;
    w->halfedge = w->stop = HE_NONE;
    he_status status = he_export_numbers(mesh, &w->numbers, err);
    if (status != HE_OK) {
        off_close(w);
        return status;
    }
    w->normal = he_export_find(mesh, HE_VERTEX, "normal", 3, 3, warnings);
    w->color = he_colors_find(mesh, HE_VERTEX, warnings);
    w->uv = he_export_find(mesh, HE_VERTEX, "uv", 2, 2, warnings);
    w->face_color = he_colors_find(mesh, HE_FACE, warnings);
    const he_column *used[] = {w->normal, w->color, w->uv, w->face_color};
    he_export_note_lost(mesh, used, sizeof used / sizeof *used, warnings);
    he_export_note_materials(mesh, warnings);
    *state = w;
    return HE_OK;
}

static char *write_header(const off_writer *w, char *p)
{
    p = he_export_text(w->uv != NULL ? "ST" : "", p);
    p = he_export_text(w->color != NULL ? "C" : "", p);
    p = he_export_text(w->normal != NULL ? "N" : "", p);
    p = he_export_text("OFF\n", p);
    p += he_u32_print(he_mesh_vertices(w->mesh), p);
    *p++ = ' ';
    p += he_u32_print(he_mesh_faces(w->mesh), p);
    *p++ = ' ';
    p += he_u32_print(he_mesh_edges(w->mesh), p);
    *p++ = '\n';
    return p;
}

/* Writes a colour as four numbers, which is what readers expect of vertices. Readers distinguish
 * colours of 0 to 1 from those of 0 to 255 by the decimal point, so each number has one. */
static char *write_color(const he_column *column, size_t row, char *p)
{
    for (uint32_t i = 0; i < 4; i++) {
        *p++ = ' ';
        char *end =
            i < column->components ? he_export_value(column, row, i, p) : he_export_text("1", p);
        size_t length = (size_t)(end - p);
        if (memchr(p, '.', length) == NULL && memchr(p, 'e', length) == NULL) {
            end = he_export_text(".0", end);
        }
        p = end;
    }
    return p;
}

static char *write_vertex(const off_writer *w, uint32_t v, char *p)
{
    he_vec3 position = w->mesh->c.position[v];
    p += he_double_print(position.x, p);
    *p++ = ' ';
    p += he_double_print(position.y, p);
    *p++ = ' ';
    p += he_double_print(position.z, p);
    if (w->normal != NULL) {
        p = he_export_row(w->normal, v, p);
    }
    if (w->color != NULL) {
        p = write_color(w->color, v, p);
    }
    if (w->uv != NULL) {
        p = he_export_row(w->uv, v, p);
    }
    *p++ = '\n';
    return p;
}

/* Returns the row at which the part that is being written ends; 0 in a part without rows. */
static uint32_t end_of_part(const off_writer *w)
{
    const he_content *c = &w->mesh->c;
    uint32_t count = w->part == VERTICES ? c->vertices.issued
                     : w->part == FACES  ? c->faces.issued
                                         : 0;
    return w->stop < count ? w->stop : count;
}

static char *write_vertices(off_writer *w, char *p, const char *end)
{
    uint32_t count = end_of_part(w);
    while (w->row < count && end - p >= HE_WRITE_ROOM) {
        uint32_t v = w->row++;
        if (he_vertex_is_live(w->mesh, (he_vertex){v})) {
            p = write_vertex(w, v, p);
        }
    }
    if (w->row == count) {
        w->row = 0;
        w->part = w->stop == HE_NONE ? FACES : END;
    }
    return p;
}

static char *write_faces(off_writer *w, char *p, const char *end)
{
    const he_content *c = &w->mesh->c;
    uint32_t count = end_of_part(w);
    while (end - p >= HE_WRITE_ROOM) {
        if (w->halfedge != HE_NONE) {
            uint32_t id = c->origin[w->halfedge];
            *p++ = ' ';
            p += he_u32_print(w->numbers != NULL ? w->numbers[id] : id, p);
            w->halfedge = c->next[w->halfedge];
            if (w->halfedge == c->face_halfedge[w->row]) {
                if (w->face_color != NULL) {
                    p = write_color(w->face_color, w->row, p);
                }
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
            p += he_u32_print(he_face_degree(w->mesh, (he_face){w->row}), p);
            w->halfedge = c->face_halfedge[w->row];
        }
    }
    return p;
}

static bool off_step(void *state, char **p, const char *end)
{
    off_writer *w = state;
    switch (w->part) {
    case HEADER:
        *p = write_header(w, *p);
        w->part = VERTICES;
        break;
    case VERTICES:
        *p = write_vertices(w, *p, end);
        break;
    case FACES:
        *p = write_faces(w, *p, end);
        break;
    case END:
        break;
    }
    return w->part != END;
}

static bool off_cut(void *state, void *piece, uint32_t rows)
{
    off_writer *w = state, *out = piece;
    uint32_t count = end_of_part(w);
    if (w->row >= count || w->halfedge != HE_NONE) {
        return false;
    }
    *out = *w;
    out->stop = w->row = count - w->row < rows ? count : w->row + rows;
    return true;
}

const he_writing he_off_writing = {
    .open = off_open,
    .step = off_step,
    .close = off_close,
    .cut = off_cut,
    .state_bytes = sizeof(off_writer),
};
