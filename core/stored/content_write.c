/* content_write.c - writes the data of a mesh as a sequence of bytes: he_stored_writer of stored.h.
 * The sequence is made piece by piece (a head, a label, an array), and cut into parts of equal
 * length, so a part may end inside a piece. */
#include "mesh/layout.h"
#include "stored/attribute_code.h"
#include "stored/content_code.h"
#include "stored/stored.h"

/* The kinds of pieces, which are sections of the byte sequence. `stage` of he_stored_writer is the
 * kind of the next piece. */
enum stage {
    HEADER,
    SLOT,
    LABELS,
    LABEL,
    LABEL_TEXT,
    ROWS,
    MATERIAL,
    MATERIAL_NAME,
    PADDING,
    ARRAYS, /* the first of HE_CONTENT_ARRAYS kinds, one for each fixed array of a mesh */
    COLUMNS = ARRAYS + HE_CONTENT_ARRAYS,
    DONE
};

static const he_column *slot_of(const he_stored_writer *w)
{
    return w->mesh->c.columns[w->slot];
}

/* Returns how many bytes the description of an attribute takes, without its kind and length. */
static uint64_t slot_bytes(const he_column *column)
{
    return column == NULL ? 0
                          : he_head_bytes(column) + he_labels_bytes(column->labels) +
                                he_varint_bytes(column->rows);
}

static uint64_t header_bytes(const he_content *c)
{
    uint64_t bytes = HE_CONTENT_HEADER;
    for (size_t i = 0; i < c->column_count; i++) {
        bytes += HE_CONTENT_SLOT + slot_bytes(c->columns[i]);
    }
    for (size_t i = 0; i < c->materials.count; i++) {
        const he_material *row = c->materials.rows[i];
        bytes += HE_CONTENT_SLOT + (row == NULL ? 0 : he_material_code_bytes(row));
    }
    return (bytes + 7) / 8 * 8;
}

void he_stored_writer_init(he_stored_writer *w, const he_mesh *mesh)
{
    memset(w, 0, sizeof *w);
    w->mesh = mesh;
    w->header = header_bytes(&mesh->c);
}

static uint64_t all_bytes(const he_mesh *mesh)
{
    uint64_t bytes = header_bytes(&mesh->c) + he_content_array_bytes(&mesh->c);
    for (size_t i = 0; i < mesh->c.column_count; i++) {
        const he_column *column = mesh->c.columns[i];
        bytes += column == NULL ? 0 : (uint64_t)column->rows * column->row_bytes;
    }
    return bytes;
}

uint64_t he_stored_parts(const he_mesh *mesh)
{
    return (all_bytes(mesh) + HE_STORED_PART - 1) / HE_STORED_PART;
}

static void set_piece(he_stored_writer *w, const void *from, size_t bytes)
{
    w->from = from;
    w->left = bytes;
    w->links = HE_NO_LINKS;
}

static void set_scratch(he_stored_writer *w, const unsigned char *end)
{
    set_piece(w, w->scratch, (size_t)(end - w->scratch));
}

static void make_header(he_stored_writer *w)
{
    const he_content *c = &w->mesh->c;
    const uint32_t words[] = {
        c->vertices.issued,
        c->edges.issued,
        c->faces.issued,
        c->vertices.live,
        c->edges.live,
        c->faces.live,
        c->boundary_halfedges,
        (uint32_t)c->column_count,
        (uint32_t)c->materials.count,
        0,
    };
    unsigned char *to = he_put_u32(w->scratch, HE_CONTENT_MAGIC);
    to = he_put_u64(he_put_u32(to, HE_CONTENT_VERSION), w->header);
    set_scratch(w, he_put_bytes(to, words, sizeof words));
    w->stage = c->column_count > 0 ? SLOT : MATERIAL;
}

static void next_slot(he_stored_writer *w)
{
    w->slot++;
    if (w->slot == w->mesh->c.column_count) {
        w->slot = 0;
        w->stage = MATERIAL;
    } else {
        w->stage = SLOT;
    }
}

static void make_slot(he_stored_writer *w)
{
    const he_column *column = slot_of(w);
    unsigned char *to = he_put_byte(w->scratch, column == NULL ? HE_SLOT_EMPTY : HE_SLOT_ATTRIBUTE);
    to = he_put_u64(to, slot_bytes(column));
    if (column == NULL) {
        set_scratch(w, to);
        next_slot(w);
        return;
    }
    set_scratch(w, he_head_put(to, column));
    w->stage = LABELS;
}

static void make_labels(he_stored_writer *w)
{
    const he_labels *labels = slot_of(w)->labels;
    size_t count = labels == NULL ? 0 : he_labels_count(labels);
    set_scratch(w, he_put_varint(w->scratch, labels == NULL ? 0 : (uint64_t)count + 1));
    w->label = 0;
    w->stage = count > 0 ? LABEL : ROWS;
}

static void make_label(he_stored_writer *w)
{
    set_scratch(w, he_put_varint(w->scratch, strlen(he_labels_get(slot_of(w)->labels, w->label))));
    w->stage = LABEL_TEXT;
}

static void make_label_text(he_stored_writer *w)
{
    const he_labels *labels = slot_of(w)->labels;
    const char *text = he_labels_get(labels, w->label);
    set_piece(w, text, strlen(text));
    w->label++;
    w->stage = w->label < he_labels_count(labels) ? LABEL : ROWS;
}

static void make_rows(he_stored_writer *w)
{
    set_scratch(w, he_put_varint(w->scratch, slot_of(w)->rows));
    next_slot(w);
}

static void make_material(he_stored_writer *w)
{
    const he_materials *table = &w->mesh->c.materials;
    if (w->slot == table->count) {
        w->stage = PADDING;
        return;
    }
    const he_material *row = table->rows[w->slot];
    unsigned char *to = he_put_byte(w->scratch, row == NULL ? HE_SLOT_EMPTY : HE_SLOT_MATERIAL);
    to = he_put_u64(to, row == NULL ? 0 : he_material_code_bytes(row));
    set_scratch(w, row == NULL ? to : he_material_put_head(to, row));
    w->stage = row == NULL ? MATERIAL : MATERIAL_NAME;
    w->slot += row == NULL;
}

static void make_material_name(he_stored_writer *w)
{
    const he_material *row = w->mesh->c.materials.rows[w->slot++];
    set_piece(w, row->name, row->length);
    w->stage = MATERIAL;
}

static void make_padding(he_stored_writer *w)
{
    memset(w->scratch, 0, 8);
    set_piece(w, w->scratch, (size_t)(w->header - w->done));
    w->stage = ARRAYS;
}

static void make_array(he_stored_writer *w)
{
    he_content c = w->mesh->c;
    he_content_array array = he_content_array_at(&c, w->stage - ARRAYS);
    set_piece(w, array.bytes, array.size);
    w->links = array.links;
    w->row = 0;
    w->has_last = false;
    w->stage++;
    w->slot = 0;
}

static void make_column(he_stored_writer *w)
{
    const he_content *c = &w->mesh->c;
    if (w->slot == c->column_count) {
        w->stage = DONE;
        return;
    }
    const he_column *column = slot_of(w);
    if (column != NULL) {
        set_piece(w, column->data, column->rows * column->row_bytes);
    }
    w->slot++;
}

/* If the current piece of the byte sequence is written, makes the next piece that is not empty.
 * Returns false after the last piece. */
static bool has_piece(he_stored_writer *w)
{
    while (w->left == 0 && w->stage != DONE) {
        switch (w->stage) {
        case HEADER:
            make_header(w);
            break;
        case SLOT:
            make_slot(w);
            break;
        case LABELS:
            make_labels(w);
            break;
        case LABEL:
            make_label(w);
            break;
        case LABEL_TEXT:
            make_label_text(w);
            break;
        case ROWS:
            make_rows(w);
            break;
        case MATERIAL:
            make_material(w);
            break;
        case MATERIAL_NAME:
            make_material_name(w);
            break;
        case PADDING:
            make_padding(w);
            break;
        case COLUMNS:
            make_column(w);
            break;
        default:
            make_array(w);
            break;
        }
        w->done += w->left;
    }
    return w->left > 0;
}

/* Writes the links (ids) in the next `bytes` bytes of the current piece, each as a varint. */
static unsigned char *put_links(he_stored_writer *w, size_t bytes, unsigned char *to)
{
    for (size_t i = 0; i < bytes; i += sizeof(uint32_t)) {
        uint32_t link;
        memcpy(&link, w->from + i, sizeof link);
        bool by_last = w->has_last && w->links == HE_LINKS_BY_LAST;
        to = he_put_varint(to, he_link_code(link, by_last ? w->last : w->row));
        if (link < HE_DEAD) {
            w->last = link;
            w->has_last = true;
        }
        w->row++;
    }
    return to;
}

/* Writes a part in the given coding. Returns SIZE_MAX if the part would be longer than it is in
 * HE_CODING_PLAIN. */
static size_t make_part(he_stored_writer *w, unsigned coding, unsigned char *to, bool *has_links)
{
    enum { STRIDE = 4096 };
    unsigned char *at = to;
    size_t taken = 0;
    w->has_last = false;
    while (taken < HE_STORED_PART && has_piece(w)) {
        size_t room = HE_STORED_PART - taken, bytes = w->left < room ? w->left : room;
        if (w->links != HE_NO_LINKS && coding == HE_CODING_LINKS) {
            bytes = bytes < STRIDE ? bytes : STRIDE;
            if ((size_t)(at - to) + bytes / sizeof(uint32_t) * HE_LINK_BYTES > HE_STORED_PART) {
                return SIZE_MAX;
            }
            at = put_links(w, bytes, at);
        } else {
            at = he_put_bytes(at, w->from, bytes);
            w->row += w->links != HE_NO_LINKS ? (uint32_t)(bytes / sizeof(uint32_t)) : 0;
        }
        *has_links |= w->links != HE_NO_LINKS;
        w->from += bytes;
        w->left -= bytes;
        taken += bytes;
    }
    return (size_t)(at - to);
}

size_t he_stored_writer_next(he_stored_writer *w, unsigned char *to, unsigned *coding)
{
    he_stored_writer from = *w;
    bool links = false;
    size_t size = make_part(w, HE_CODING_LINKS, to, &links);
    if (size == SIZE_MAX) {
        *w = from;
        links = false;
        size = make_part(w, HE_CODING_PLAIN, to, &links);
        links = false;
    }
    *coding = links ? HE_CODING_LINKS : HE_CODING_PLAIN;
    return size;
}

size_t he_stored_content_bound(const he_mesh *mesh)
{
    uint64_t bytes = all_bytes(mesh), last = bytes % HE_STORED_PART;
    /* A link may take more bytes as a varint than the four bytes of a word, so the bound assumes
     * that all words of the last part are links. */
    last += last / sizeof(uint32_t) * (HE_LINK_BYTES - sizeof(uint32_t));
    last = last > HE_STORED_PART ? HE_STORED_PART : last;
    return (size_t)(bytes / HE_STORED_PART * (HE_PART_HEAD + HE_STORED_PART) + HE_PART_HEAD + last);
}

size_t he_stored_content_write(const he_mesh *mesh, unsigned char *to)
{
    he_stored_writer w;
    unsigned char *at = to;
    unsigned coding;
    size_t size;
    he_stored_writer_init(&w, mesh);
    while ((size = he_stored_writer_next(&w, at + HE_PART_HEAD, &coding)) > 0) {
        (void)he_put_u32(he_put_byte(at, coding), (uint32_t)size);
        at += HE_PART_HEAD + size;
    }
    return (size_t)(at - to);
}
