#include "api/document_out.h"

#include "api/json_out.h"
#include "format/number.h"
#include "mesh/walk.h"

#include <string.h>

/* Text is made a buffer at a time; what is written between two looks at the room left is at most
 * a vertex or a corner, so UNIT bytes must be free. */
enum { BUFFER = 64 * 1024, UNIT = 128 };

typedef enum phase { PHASE_HEAD, PHASE_VERTICES, PHASE_FACES, PHASE_DONE } phase;

struct api_document_out {
    const he_mesh *mesh;
    api_text head;  /* up to the '[' of the vertices */
    uint32_t *rank; /* number of each live vertex; NULL when none is dead */
    phase phase;
    uint32_t next; /* vertex or face */
    bool listed;   /* one was written already */
    bool open;     /* `corner` is the next corner of the open face */
    he_halfedge corner;
    size_t begin, end; /* of the text in the buffer */
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

api_document_out *api_document_out_new(const he_mesh *mesh, const char *name)
{
    api_document_out *out = he_mem_alloc(sizeof *out);
    if (out == NULL) {
        return NULL;
    }
    *out = (api_document_out){.mesh = mesh};
    api_out json;
    api_out_init(&json, &out->head);
    api_out_object_begin(&json);
    api_out_key_string(&json, "name", name);
    api_out_key(&json, "vertices");
    api_text_add_char(&out->head, '[');
    if (out->head.failed || !make_rank(out)) {
        api_document_out_free(out);
        return NULL;
    }
    return out;
}

void api_document_out_free(api_document_out *out)
{
    if (out != NULL) {
        he_mem_free(out->rank);
        api_text_clear(&out->head);
        he_mem_free(out);
    }
}

static void put(api_document_out *out, const char *text)
{
    size_t length = strlen(text);
    memcpy(out->buffer + out->end, text, length);
    out->end += length;
}

/* What stands before the next item of a list: every item has its line. */
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

/* Everything up to a full buffer. Dead rows write nothing, so a call may scan many. */
static void fill(api_document_out *out)
{
    out->begin = out->end = 0;
    if (out->phase == PHASE_HEAD) {
        out->phase = PHASE_VERTICES; /* the head is read where it is */
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
            put(out, "]}\n");
            out->phase = PHASE_DONE;
        }
    }
}

int64_t api_document_out_read(void *context, char *buffer, size_t size)
{
    api_document_out *out = context;
    const char *from = out->buffer;
    if (out->phase == PHASE_HEAD) {
        from = out->head.bytes;
        out->end = out->head.length;
    } else if (out->begin == out->end && out->phase != PHASE_DONE) {
        fill(out);
    }
    size_t length = out->end - out->begin < size ? out->end - out->begin : size;
    memcpy(buffer, from + out->begin, length);
    out->begin += length;
    if (out->phase == PHASE_HEAD && out->begin == out->end) {
        fill(out);
    }
    return (int64_t)length;
}
