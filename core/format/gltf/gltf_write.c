#include "format/gltf/gltf.h"

#include "format/gltf/glb_parts.h"
#include "format/gltf/gltf_asset.h"
#include "format/io/colors.h"

#include <assert.h>
#include <string.h>

/* The parts of a GLB document, in the order in which they are written. */
typedef enum stage { HEADER, JSON, BIN_HEADER, PARTS, END } stage;

/* Room for one element of any part; the largest has sixteen doubles. */
enum { ELEMENT_ROOM = 128 };

typedef struct glb_writer {
    he_glb_parts g;
    /* if vertices are split, the number in the file of each vertex of the present face */
    uint32_t *at;
    uint32_t *ranks; /* number of each face among the live faces; NULL if the ids are the numbers */
    stage stage;
    size_t json;       /* the next byte of the JSON */
    size_t part;       /* the part being written */
    uint32_t row;      /* the next vertex or face */
    uint32_t halfedge; /* the next corner of the face, or HE_NONE */
    size_t copy;       /* the next copy */
    he_export_triangle_walk walk;
    /* Number of bytes written so far of the present part or, if parts are compressed, of all
     * streams. */
    uint64_t written;
} glb_writer;

static void glb_close(void *state)
{
    glb_writer *w = state;
    he_glb_parts_clear(&w->g);
    he_mem_free(w->at);
    he_mem_free(w->ranks);
    he_mem_free(w);
}

/* --- elements --- */

static char *put_word(uint32_t value, size_t bytes, char *p)
{
    for (size_t i = 0; i < bytes; i++, value >>= 8) {
        *p++ = (char)(unsigned char)value;
    }
    return p;
}

static char *put_float(double value, char *p)
{
    float number = he_narrow(value);
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return put_word(bits, 4, p);
}

static char *put_value(const he_glb_part *part, uint32_t id, char *p)
{
    char *end = p + part->stride;
    for (uint32_t i = 0; i < part->components; i++) {
        double value = he_gltf_convert(part->role, i, he_export_number(part->column, id, i));
        if (part->type == HE_GLTF_FLOAT) {
            p = put_float(value, p);
            continue;
        }
        uint32_t whole = part->normalized ? he_color_byte(value) : (uint32_t)value;
        p = put_word(whole, he_gltf_type_bytes((he_gltf_type)part->type), p);
    }
    while (p < end) {
        *p++ = 0;
    }
    return p;
}

static char *put_words(const he_column *column, uint32_t id, char *p)
{
    const unsigned char *at = he_column_value(column, id);
    for (uint32_t i = 0; i < column->components; i++) {
        uint64_t bits = 0;
        size_t bytes = he_type_bytes(column->type);
        if (column->type == HE_FLOAT || column->type == HE_DOUBLE) {
            double value = he_export_number(column, id, i);
            float narrow = (float)value;
            memcpy(&bits, column->type == HE_FLOAT ? (void *)&narrow : &value, bytes);
        } else {
            memcpy(&bits, at, bytes);
        }
        at += bytes;
        p = put_word((uint32_t)bits, 4, p);
        p = bytes == 8 ? put_word((uint32_t)(bits >> 32), 4, p) : p;
    }
    return p;
}

static uint32_t number_of(const glb_writer *w, uint32_t vertex)
{
    return w->g.numbers != NULL ? w->g.numbers[vertex] : vertex;
}

/* --- walks over the elements of a part, which return HE_NONE after the last one --- */

/* Returns the half-edge whose corner the next copy of a vertex stands for, or HE_NONE after the
 * last copy. */
static uint32_t next_copy(glb_writer *w)
{
    return w->copy < w->g.splits.copies.count ? w->g.splits.copies.ids[w->copy++] : HE_NONE;
}

static uint32_t next_vertex(glb_writer *w)
{
    uint32_t issued = w->g.mesh->c.vertices.issued;
    while (w->row < issued && !he_vertex_is_live(w->g.mesh, (he_vertex){w->row})) {
        w->row++;
    }
    return w->row == issued ? HE_NONE : w->row++;
}

static uint32_t next_face(glb_writer *w)
{
    uint32_t issued = w->g.mesh->c.faces.issued;
    if (w->g.groups.order != NULL) {
        return w->row < w->g.mesh->c.faces.live ? w->g.groups.order[w->row++] : HE_NONE;
    }
    while (w->row < issued && !he_face_is_live(w->g.mesh, (he_face){w->row})) {
        w->row++;
    }
    return w->row == issued ? HE_NONE : w->row++;
}

static uint32_t next_corner(glb_writer *w)
{
    const he_content *c = &w->g.mesh->c;
    if (w->halfedge == HE_NONE) {
        uint32_t face = next_face(w);
        if (face == HE_NONE) {
            return HE_NONE;
        }
        w->halfedge = c->face_halfedge[face];
    }
    uint32_t h = w->halfedge;
    w->halfedge = c->next[h] == c->face_halfedge[c->face[h]] ? HE_NONE : c->next[h];
    return h;
}

static uint32_t next_row(glb_writer *w, he_kind domain)
{
    return domain == HE_VERTEX ? next_vertex(w) : domain == HE_FACE ? next_face(w) : next_corner(w);
}

/* Sets the numbers by which a face refers to its vertices: for some of them, the numbers of
 * copies. */
static void enter_face(const glb_writer *w, uint32_t face)
{
    const he_content *c = &w->g.mesh->c;
    uint32_t h = c->face_halfedge[face];
    do {
        w->at[c->origin[h]] = w->g.splits.number[h];
        h = c->next[h];
    } while (h != c->face_halfedge[face]);
}

static char *put_triangle(glb_writer *w, const he_glb_part *part, char *p)
{
    uint32_t v[3];
    if (w->walk.left == 0) {
        uint32_t face = next_face(w);
        if (face == HE_NONE) {
            return p;
        }
        w->walk.face = face;
        if (w->g.groups.cut != NULL) {
            w->walk.corner = w->g.groups.cut[face];
        }
        if (w->at != NULL) {
            enter_face(w, face);
        }
    }
    (void)he_export_triangles_next(&w->g.cuts, &w->walk, v);
    for (size_t i = 0; i < 3; i++) {
        p = put_word(w->at != NULL ? w->at[v[i]] : number_of(w, v[i]), part->stride, p);
    }
    return p;
}

static char *put_position(const glb_writer *w, uint32_t vertex, char *p)
{
    for (size_t i = 0; i < 3; i++) {
        p = put_float((&w->g.mesh->c.position[vertex].x)[i], p);
    }
    return p;
}

/* Writes a part's value for the next vertex, and after the last vertex for the next copy of a
 * vertex; after the last copy it writes nothing. A copy has the values of the corner it stands
 * for. */
static char *put_vertex(glb_writer *w, const he_glb_part *part, char *p)
{
    const he_content *c = &w->g.mesh->c;
    uint32_t id = next_vertex(w), h = HE_NONE;
    if (id == HE_NONE) {
        h = next_copy(w);
        if (h == HE_NONE) {
            return p;
        }
        id = c->origin[h];
    } else if (w->g.splits.own != NULL) {
        h = w->g.splits.own[id];
    }
    if (part->content == HE_GLB_POSITIONS) {
        return put_position(w, id, p);
    }
    return put_value(part, part->column->domain == HE_HALFEDGE ? h : id, p);
}

/* Writes the next element of a part. After the last element it writes nothing. */
static char *put_element(glb_writer *w, const he_glb_part *part, char *p)
{
    const he_mesh *m = w->g.mesh;
    uint32_t id;
    switch (part->content) {
    case HE_GLB_TRIANGLES:
        return put_triangle(w, part, p);
    case HE_GLB_POSITIONS:
    case HE_GLB_VALUES:
        return put_vertex(w, part, p);
    case HE_GLB_COPIES:
        id = next_copy(w);
        return id == HE_NONE ? p : put_word(number_of(w, m->c.origin[id]), 4, p);
    case HE_GLB_DEGREES:
        id = next_face(w);
        return id == HE_NONE ? p : put_word(he_face_degree(m, (he_face){id}), 4, p);
    case HE_GLB_CORNERS:
        id = next_corner(w);
        return id == HE_NONE ? p : put_word(number_of(w, m->c.origin[id]), 4, p);
    case HE_GLB_ORDER:
        id = next_face(w);
        return id == HE_NONE ? p : put_word(w->ranks != NULL ? w->ranks[id] : id, 4, p);
    case HE_GLB_WORDS:
        break;
    }
    id = next_row(w, part->column->domain);
    return id == HE_NONE ? p : put_words(part->column, id, p);
}

/* --- compression --- */

static void begin_part(glb_writer *w)
{
    w->row = 0;
    w->copy = 0;
    w->written = 0;
}

/* Collects all elements of a part and compresses them. The codec takes indices as 32-bit words. */
static he_status pack_part(glb_writer *w, he_glb_part *part, he_error *err)
{
    he_glb_part plain = *part;
    if (part->content == HE_GLB_TRIANGLES) {
        plain.stride = sizeof(uint32_t);
    }
    size_t size = (size_t)he_glb_part_bytes(&plain);
    char *bytes = he_mem_alloc(size + ELEMENT_ROOM), *at = bytes, *after;
    if (bytes == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to pack %zu bytes", size);
    }
    while ((after = put_element(w, &plain, at)) != at) {
        at = after;
    }
    assert((size_t)(at - bytes) == size);
    begin_part(w);
    he_status status = he_glb_pack(&w->g, part, bytes, err);
    he_mem_free(bytes);
    return status;
}

static he_status pack(glb_writer *w, he_progress *progress, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < w->g.count && status == HE_OK; i++) {
        status = he_progress_step(progress, w->g.parts[i].offset, w->g.bytes, err);
        if (status == HE_OK) {
            status = pack_part(w, &w->g.parts[i], err);
        }
    }
    return status;
}

/* --- the file --- */

static he_status rank_faces(glb_writer *w, he_error *err)
{
    const he_content *c = &w->g.mesh->c;
    uint32_t next = 0;
    if (c->faces.live == c->faces.issued) {
        return HE_OK;
    }
    w->ranks = he_mem_array(NULL, c->faces.issued, sizeof *w->ranks);
    if (w->ranks == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to number %u faces", c->faces.issued);
    }
    for (uint32_t f = 0; f < c->faces.issued; f++) {
        w->ranks[f] = next;
        next += he_face_is_live(w->g.mesh, (he_face){f});
    }
    return HE_OK;
}

static he_status glb_open(const he_mesh *mesh, size_t encoding, he_progress *progress,
                          he_warnings *warnings, void **state, he_error *err)
{
    glb_writer *w = he_mem_zero(1, sizeof *w);
    if (w == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to write the GLB file");
    }
    w->halfedge = HE_NONE;
    bool packs = encoding == HE_GLB_MESHOPT;
    he_status status = he_glb_parts_make(mesh, packs, progress, warnings, &w->g, err);
    if (status == HE_OK && w->g.splits.copies.count > 0) {
        w->at = he_mem_array(NULL, mesh->c.vertices.issued, sizeof *w->at);
        if (w->at == NULL) {
            status = he_fail_plain(err, HE_NO_MEMORY, "no memory to write the GLB file");
        }
    }
    if (status == HE_OK && w->g.groups.order != NULL) {
        status = rank_faces(w, err);
    }
    if (status == HE_OK && packs) {
        status = pack(w, progress, err);
    }
    if (status == HE_OK) {
        status = he_glb_describe(&w->g, err);
    }
    if (status != HE_OK) {
        glb_close(w);
        return status;
    }
    *state = w;
    return HE_OK;
}

static char *write_header(const glb_writer *w, char *p)
{
    uint64_t length =
        12 + 8 + w->g.json_length + (w->g.count > 0 ? 8 + he_glb_bin_bytes(&w->g) : 0);
    p = he_export_text("glTF", p);
    p = put_word(2, 4, p);
    p = put_word((uint32_t)length, 4, p);
    p = put_word((uint32_t)w->g.json_length, 4, p);
    return he_export_text("JSON", p);
}

static char *write_json(glb_writer *w, char *p, const char *end)
{
    size_t left = w->g.json_length - w->json, room = (size_t)(end - p);
    size_t n = left < room ? left : room;
    memcpy(p, w->g.json + w->json, n);
    w->json += n;
    if (w->json == w->g.json_length) {
        w->stage = w->g.count > 0 ? BIN_HEADER : END;
    }
    return p + n;
}

static char *write_streams(glb_writer *w, char *p, const char *end)
{
    size_t left = w->g.streams_length - (size_t)w->written, room = (size_t)(end - p);
    size_t n = left < room ? left : room;
    memcpy(p, w->g.streams + w->written, n);
    w->written += n;
    w->stage = n == left ? END : PARTS;
    return p + n;
}

static char *write_parts(glb_writer *w, char *p, const char *end)
{
    while (end - p >= ELEMENT_ROOM) {
        const he_glb_part *part = &w->g.parts[w->part];
        char *after = put_element(w, part, p);
        w->written += (uint64_t)(after - p);
        if (after == p) {
            for (; w->written % 4 != 0; w->written++) {
                *after++ = 0;
            }
            w->part++;
            begin_part(w);
            if (w->part == w->g.count) {
                w->stage = END;
                return after;
            }
        }
        p = after;
    }
    return p;
}

static bool glb_step(void *state, char **p, const char *end)
{
    glb_writer *w = state;
    switch (w->stage) {
    case HEADER:
        *p = write_header(w, *p);
        w->stage = JSON;
        break;
    case JSON:
        *p = write_json(w, *p, end);
        break;
    case BIN_HEADER:
        *p = put_word((uint32_t)he_glb_bin_bytes(&w->g), 4, *p);
        *p = put_word(0x004E4942, 4, *p);
        w->stage = PARTS;
        break;
    case PARTS:
        *p = w->g.packs ? write_streams(w, *p, end) : write_parts(w, *p, end);
        break;
    case END:
        break;
    }
    return w->stage != END;
}

const he_writing he_glb_writing = {
    .open = glb_open,
    .step = glb_step,
    .close = glb_close,
    .cuts = true,
};
