#include "api/document/document_out.h"

#include "api/json/attribute_value.h"
#include "api/json/material_value.h"
#include "format/text/number.h"
#include "mesh/walk.h"

#include <string.h>

/* The text is made one buffer of BUFFER bytes at a time. One vertex or one corner takes at most
 * UNIT bytes, so a vertex or corner is written only if UNIT bytes of the buffer are free. */
enum { BUFFER = 64 * 1024, UNIT = 128 };

typedef enum phase {
    PHASE_HEAD,
    PHASE_VERTICES,
    PHASE_FACES,
    PHASE_ATTRIBUTES,
    PHASE_END,
    PHASE_DONE
} phase;

struct api_document_out {
    const he_mesh *mesh;
    /* The document's text before the vertices, and later pieces of the attributes and its end. */
    api_text text;
    bool from_text; /* true if `begin` and `end` are positions in `text`, not in `buffer` */
    uint32_t *rank; /* number of each live vertex in the document; NULL if no vertex was deleted */
    /* One half-edge of each edge, in the order in which the document has the edges. It is the
     * half-edge in that face of the edge which is written first. NULL if no attribute needs this
     * list. */
    uint32_t *edges;
    size_t column; /* index of the attribute that is being written */
    bool begun;    /* true if the attribute's members before "values" were written */
    phase phase;
    uint32_t next; /* id of the next vertex or face, or index of the next value of an attribute */
    bool listed;   /* true if the list being written has an item already */
    /* While faces are written: true if a face is begun, whose next corner is `corner`. While
     * attributes are written: true if a value of the present attribute was written already. */
    bool open;
    he_halfedge corner;
    /* Positions of the bytes in `buffer` or `text` that the server has not read yet. */
    size_t begin, end;
    char buffer[BUFFER];
};

static bool make_rank(api_document_out *out)
{
    const he_mesh *mesh = out->mesh;
    uint32_t issued = he_mesh_issued(mesh, HE_VERTEX), live = 0;
    if (he_mesh_vertices(mesh) == issued) {
        return true;
    }
    out->rank = he_mem_array(NULL, issued, sizeof *out->rank);
    for (uint32_t v = 0; out->rank != NULL && v < issued; v++) {
        out->rank[v] = live;
        live += he_vertex_is_live(mesh, (he_vertex){v});
    }
    return out->rank != NULL;
}

static bool needs_edges(const he_mesh *mesh)
{
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (column != NULL && (column->domain == HE_EDGE || column->domain == HE_HALFEDGE)) {
            return true;
        }
    }
    return false;
}

static bool make_edges(api_document_out *out)
{
    const he_mesh *mesh = out->mesh;
    uint32_t live = 0, faces = he_mesh_issued(mesh, HE_FACE);
    if (!needs_edges(mesh)) {
        return true;
    }
    uint64_t *seen = he_bits_new(he_mesh_issued(mesh, HE_EDGE) + 1);
    out->edges = he_mem_array(NULL, (size_t)he_mesh_edges(mesh) + 1, sizeof *out->edges);
    for (uint32_t f = 0; seen != NULL && out->edges != NULL && f < faces; f++) {
        if (!he_face_is_live(mesh, (he_face){f})) {
            continue;
        }
        he_halfedge first = he_face_halfedge(mesh, (he_face){f}), h = first;
        do {
            if (!he_bits_get(seen, he_edge_of(h).i)) {
                he_bits_set(seen, he_edge_of(h).i);
                out->edges[live++] = h.i;
            }
            h = he_next(mesh, h);
        } while (h.i != first.i);
    }
    bool good = seen != NULL && out->edges != NULL;
    he_mem_free(seen);
    return good;
}

api_document_out *api_document_out_new(const he_mesh *mesh, const char *name)
{
    api_document_out *out = he_mem_alloc(sizeof *out);
    if (out == NULL) {
        return NULL;
    }
    *out = (api_document_out){.mesh = mesh};
    api_out json;
    api_out_init(&json, &out->text);
    api_out_object_begin(&json);
    api_out_key_string(&json, "name", name);
    api_out_key(&json, "vertices");
    api_text_add_char(&out->text, '[');
    if (out->text.failed || !make_rank(out) || !make_edges(out)) {
        api_document_out_free(out);
        return NULL;
    }
    out->from_text = true;
    out->end = out->text.length;
    return out;
}

void api_document_out_free(api_document_out *out)
{
    if (out != NULL) {
        he_mem_free(out->rank);
        he_mem_free(out->edges);
        api_text_clear(&out->text);
        he_mem_free(out);
    }
}

static void put(api_document_out *out, const char *text)
{
    size_t length = strlen(text);
    memcpy(out->buffer + out->end, text, length);
    out->end += length;
}

/* Writes the separator before an item of a list, with a line break, so that each item has its own
 * line. */
static void begin_item(api_document_out *out)
{
    put(out, out->listed ? ",\n[" : "\n[");
    out->listed = true;
}

static void write_vertex(api_document_out *out)
{
    he_vertex v = {out->next++};
    if (!he_vertex_is_live(out->mesh, v)) {
        return;
    }
    he_vec3 p = he_position(out->mesh, v);
    begin_item(out);
    char *at = out->buffer + out->end;
    at += he_double_print(p.x, at);
    *at++ = ',';
    at += he_double_print(p.y, at);
    *at++ = ',';
    at += he_double_print(p.z, at);
    *at++ = ']';
    out->end = (size_t)(at - out->buffer);
}

static void open_face(api_document_out *out)
{
    he_face f = {out->next++};
    if (he_face_is_live(out->mesh, f)) {
        begin_item(out);
        out->open = true;
        out->corner = he_face_halfedge(out->mesh, f);
    }
}

static void write_corner(api_document_out *out)
{
    uint32_t v = he_origin(out->mesh, out->corner).i;
    out->end += he_u32_print(out->rank == NULL ? v : out->rank[v], out->buffer + out->end);
    he_halfedge first = he_face_halfedge(out->mesh, he_face_of(out->mesh, out->corner));
    out->corner = he_next(out->mesh, out->corner);
    out->open = out->corner.i != first.i;
    out->buffer[out->end++] = out->open ? ',' : ']';
}

/* --- writing attributes --- */

static size_t next_column(const he_mesh *mesh, size_t from)
{
    while (from < he_mesh_columns(mesh) && he_mesh_column(mesh, from) == NULL) {
        from++;
    }
    return from;
}

/* Returns for how many positions row_at must be called to find all values of an attribute. For
 * vertices and faces, deleted elements have positions, too. */
static uint64_t count_places(const api_document_out *out, he_kind domain)
{
    return domain == HE_EDGE || domain == HE_HALFEDGE ? he_mesh_count(out->mesh, domain)
                                                      : he_mesh_issued(out->mesh, domain);
}

/* Returns the index in an attribute's column at which the value of element number `i` of the
 * document is; HE_NONE if that element is deleted. For vertices and faces, `i` counts deleted
 * elements, too. */
static uint32_t row_at(const api_document_out *out, he_kind domain, uint32_t i)
{
    switch (domain) {
    case HE_EDGE:
        return out->edges[i] >> 1;
    case HE_HALFEDGE:
        return out->edges[i >> 1] ^ (i & 1);
    case HE_VERTEX:
    case HE_FACE:
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return he_mesh_is_live(out->mesh, domain, i) ? i : HE_NONE;
}

static void begin_attribute(api_document_out *out, const he_column *column)
{
    api_out json;
    const api_shown_column shown = api_show_column(out->mesh, column);
    api_text_add_string(&out->text, out->listed ? ",\n" : "\n");
    api_out_init(&json, &out->text);
    api_out_object_begin(&json);
    api_record_members(&json, &api_attribute_added_record, &shown);
    api_out_key(&json, "values");
    api_text_add_char(&out->text, '[');
    out->listed = true;
    out->begun = true;
    out->open = false; /* no value was written yet */
    out->next = 0;
}

/* Writes what follows the lists of vertices, faces and attributes: the materials, and the end of
 * the document. */
static void end_document(api_document_out *out)
{
    const he_materials *materials = he_mesh_materials(out->mesh);
    if (he_materials_count(materials) > 0) {
        api_out json;
        api_text_add_string(&out->text, ",\n\"materials\":");
        api_out_init(&json, &out->text);
        api_write_materials(&json, materials);
    }
    api_text_add_string(&out->text, "}\n");
    out->phase = PHASE_DONE;
}

/* Appends the next part of the attributes to the text. */
static void fill_attributes(api_document_out *out)
{
    const he_column *column = he_mesh_column(out->mesh, out->column);
    uint64_t places = count_places(out, column->domain);
    api_text_empty(&out->text);
    if (!out->begun) {
        begin_attribute(out, column);
    }
    for (; out->next < places && out->text.length < BUFFER && !out->text.failed; out->next++) {
        uint32_t row = row_at(out, column->domain, out->next);
        if (row == HE_NONE) {
            continue;
        }
        api_out json;
        api_out_init(&json, &out->text);
        if (out->open) {
            api_text_add_char(&out->text, ',');
        }
        out->open = true;
        api_write_value(&json, column, he_column_value(column, row));
    }
    if (out->next >= places) {
        api_text_add_string(&out->text, "]}");
        out->column = next_column(out->mesh, out->column + 1);
        out->begun = false;
    }
    if (out->column == he_mesh_columns(out->mesh)) {
        api_text_add_char(&out->text, ']');
        end_document(out);
    }
    out->from_text = true;
    out->begin = 0;
    out->end = out->text.length;
}

/* Makes the next bytes of the document, in `buffer` or `text`. A call may take long, because it
 * skips all deleted elements that it meets. */
static void fill(api_document_out *out)
{
    out->begin = out->end = 0;
    out->from_text = false;
    if (out->phase == PHASE_HEAD) {
        out->phase = PHASE_VERTICES;
    }
    uint32_t vertices = he_mesh_issued(out->mesh, HE_VERTEX);
    while (out->phase == PHASE_VERTICES && BUFFER - out->end >= UNIT) {
        if (out->next < vertices) {
            write_vertex(out);
            continue;
        }
        put(out, "],\n\"faces\":[");
        out->phase = PHASE_FACES;
        out->listed = false;
        out->next = 0;
    }
    uint32_t faces = he_mesh_issued(out->mesh, HE_FACE);
    while (out->phase == PHASE_FACES && BUFFER - out->end >= UNIT) {
        if (out->open) {
            write_corner(out);
        } else if (out->next < faces) {
            open_face(out);
        } else {
            out->column = next_column(out->mesh, 0);
            bool none = out->column == he_mesh_columns(out->mesh);
            put(out, none ? "]" : "],\n\"attributes\":[");
            out->phase = none ? PHASE_END : PHASE_ATTRIBUTES;
            out->listed = false;
            out->next = 0;
        }
    }
    if (out->phase == PHASE_ATTRIBUTES && out->end == 0) {
        fill_attributes(out);
    } else if (out->phase == PHASE_END && out->end == 0) {
        api_text_empty(&out->text);
        end_document(out);
        out->from_text = true;
        out->end = out->text.length;
    }
}

int64_t api_document_out_read(void *context, char *buffer, size_t size)
{
    api_document_out *out = context;
    if (out->begin == out->end && out->phase != PHASE_DONE) {
        fill(out);
    }
    if (out->text.failed) {
        return -1;
    }
    const char *from = out->from_text ? out->text.bytes : out->buffer;
    size_t length = out->end - out->begin < size ? out->end - out->begin : size;
    memcpy(buffer, from + out->begin, length);
    out->begin += length;
    return (int64_t)length;
}
