/* content_read.c - reads the stored data of a mesh part by part: he_stored_reader of stored.h.
 * Bytes are copied into a buffer until the header is complete, then directly into the arrays of the
 * mesh, whose sizes the header states. */
#include "mesh/content.h"
#include "stored/attribute_code.h"
#include "stored/content_code.h"
#include "stored/stored.h"

struct he_stored_reader {
    /* `most`: how many bytes the mesh data may have; `total`: how many it has, UINT64_MAX until the
     * header is read */
    uint64_t most, total;
    uint64_t at; /* number of bytes read so far */
    unsigned char *header;
    /* `header_size`: number of bytes of the header read so far; `header_room`: size of the buffer
     * `header` */
    size_t header_size, header_room;
    /* length of the header; only that of its first bytes until these are read */
    uint64_t header_wanted;
    he_content c;
    /* number of the next array to fill: the HE_CONTENT_ARRAYS fixed arrays come first, then one
     * array for each attribute */
    size_t array;
    unsigned char *to; /* where the next bytes of the current array are written */
    size_t left;       /* number of bytes of the current array that are not read yet */
    he_links links;
    uint32_t row;  /* index in the current array of the next link (id) to read */
    uint32_t last; /* the last id that was read, if has_last is true */
    bool has_last; /* true if an id was read before in this part of this array */
};

he_status he_stored_reader_new(uint64_t most, he_stored_reader **out, he_error *err)
{
    he_stored_reader *r = he_mem_zero(1, sizeof *r);
    if (r == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to read a mesh");
    }
    r->most = most;
    r->total = UINT64_MAX;
    r->header_wanted = HE_CONTENT_START;
    *out = r;
    return HE_OK;
}

void he_stored_reader_free(he_stored_reader *r)
{
    if (r != NULL) {
        he_content_clear(&r->c);
        he_mem_free(r->header);
        he_mem_free(r);
    }
}

static he_status refuse(const he_stored_reader *r, he_error *err, const char *what)
{
    return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, r->at, "%s", what);
}

/* Reads the first bytes of the header, which state its length. */
static he_status read_start(he_stored_reader *r, he_error *err)
{
    he_cursor c = he_cursor_over(r->header, r->header_size);
    uint32_t magic = 0, version = 0;
    uint64_t bytes = 0;
    bool taken = he_take_u32(&c, &magic) && he_take_u32(&c, &version) && he_take_u64(&c, &bytes);
    if (!taken || magic != HE_CONTENT_MAGIC) {
        return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, 0, "the bytes are not a stored mesh");
    }
    if (version != HE_CONTENT_VERSION) {
        return he_fail_at(err, version > HE_CONTENT_VERSION ? HE_UNSUPPORTED : HE_CORRUPT,
                          HE_PLACE_BYTE, 4,
                          "the stored mesh has version %u, but this release reads version %u",
                          version, (unsigned)HE_CONTENT_VERSION);
    }
    if (bytes < HE_CONTENT_HEADER || bytes % 8 != 0 || bytes > r->most) {
        return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, 8,
                          "the header of the stored mesh declares an impossible length: %llu bytes",
                          (unsigned long long)bytes);
    }
    r->header_wanted = bytes;
    return HE_OK;
}

/* Reads the description of one attribute from the header. Memory for its values is allocated later,
 * when all attributes are known. */
static he_status read_slot(he_cursor *c, he_labels *names, he_column **out, size_t *rows,
                           he_error *err)
{
    unsigned char kind;
    uint64_t length, count = 0;
    uint32_t name;
    if (!he_take_bytes(c, 1, &kind) || !he_take_u64(c, &length) || length > he_left(c)) {
        return he_refuse_at(c, err, "the header of the stored mesh ends inside an attribute");
    }
    if (kind > HE_SLOT_ATTRIBUTE || (kind == HE_SLOT_EMPTY && length > 0)) {
        return he_refuse_at(c, err, "the stored mesh holds an attribute of an unknown kind");
    }
    if (kind == HE_SLOT_EMPTY) {
        *out = NULL;
        return HE_OK;
    }
    he_cursor slot = *c;
    c->at += length;
    slot.end = c->at;
    he_column *column = NULL;
    he_status status = he_head_take(&slot, &column, err);
    if (status == HE_OK) {
        status = he_labels_take(&slot, &column->labels, err);
    }
    if (status == HE_OK &&
        (!he_take_varint(&slot, 2 * (uint64_t)HE_MAX_ROWS, &count) || he_left(&slot) > 0)) {
        status = he_refuse_at(
            &slot, err, "the number of values of a stored attribute is missing or out of range");
    }
    if (status == HE_OK) {
        char text[1 + HE_COLUMN_NAME];
        size_t size = strlen(column->name), known = he_labels_count(names);
        text[0] = (char)('0' + column->domain);
        memcpy(text + 1, column->name, size);
        status = he_labels_add(names, text, 1 + size, &name, err);
        if (status == HE_OK && name != known) {
            status = he_refuse_at(&slot, err, "two stored attributes have the same name");
        }
    }
    if (status != HE_OK) {
        he_column_free(column);
        return status;
    }
    *out = column;
    *rows = (size_t)count;
    return HE_OK;
}

/* Reads the descriptions of all attributes. Sets the number of values of each without allocating
 * memory for them, and adds the bytes that they will take to *bytes. */
static he_status read_slots(he_stored_reader *r, he_cursor *c, uint32_t slots, uint64_t *bytes,
                            he_error *err)
{
    he_labels *names = he_labels_new();
    r->c.columns = slots == 0 ? NULL : he_mem_zero(slots, sizeof *r->c.columns);
    if (names == NULL || (slots > 0 && r->c.columns == NULL)) {
        he_labels_release(names);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for attributes");
    }
    r->c.column_capacity = slots;
    he_status status = HE_OK;
    for (uint32_t i = 0; i < slots && status == HE_OK; i++) {
        size_t rows = 0;
        status = read_slot(c, names, &r->c.columns[i], &rows, err);
        if (status != HE_OK) {
            break;
        }
        r->c.column_count++;
        he_column *column = r->c.columns[i];
        if (column != NULL) {
            column->rows = rows;
            *bytes += (uint64_t)rows * column->row_bytes;
            if (rows > he_content_issued(&r->c, column->domain)) {
                status = he_refuse_at(
                    c, err, "a stored attribute has more values than the mesh has elements");
            }
        }
    }
    he_labels_release(names);
    return status;
}

/* Reads the table of materials. */
static he_status read_materials(he_cursor *c, uint32_t slots, he_materials *out, he_error *err)
{
    he_status status =
        slots > HE_MATERIALS
            ? he_refuse_at(c, err, "the stored mesh has more materials than a mesh may have")
            : he_materials_reserve(out, slots, err);
    for (uint32_t i = 0; i < slots && status == HE_OK; i++) {
        unsigned char kind;
        uint64_t length;
        he_material *row = NULL;
        if (!he_take_bytes(c, 1, &kind) || !he_take_u64(c, &length) || length > he_left(c)) {
            return he_refuse_at(c, err, "the header of the stored mesh ends inside a material");
        }
        if ((kind != HE_SLOT_EMPTY && kind != HE_SLOT_MATERIAL) ||
            (kind == HE_SLOT_EMPTY && length > 0)) {
            return he_refuse_at(c, err, "the stored mesh holds a material of an unknown kind");
        }
        he_cursor slot = *c;
        c->at += length;
        slot.end = c->at;
        if (kind == HE_SLOT_MATERIAL) {
            status = he_material_take(&slot, &row, err);
        }
        if (status == HE_OK &&
            (he_left(&slot) > 0 ||
             (row != NULL && he_materials_find(out, row->name, row->length) != SIZE_MAX))) {
            status = he_refuse_at(&slot, err,
                                  "a stored material has extra bytes, or its name appears twice");
        }
        if (status != HE_OK) {
            he_material_release(row);
            return status;
        }
        out->rows[out->count++] = row;
    }
    return status;
}

static bool read_rows(he_cursor *c, he_content *content, uint32_t *slots, uint32_t *materials)
{
    he_rows *const tables[] = {&content->vertices, &content->edges, &content->faces};
    bool good = true;
    for (size_t i = 0; i < 3; i++) {
        good = good && he_take_u32(c, &tables[i]->issued) && tables[i]->issued <= HE_MAX_ROWS;
    }
    for (size_t i = 0; i < 3; i++) {
        good = good && he_take_u32(c, &tables[i]->live) && tables[i]->live <= tables[i]->issued;
    }
    uint32_t zero = 0;
    return good && he_take_u32(c, &content->boundary_halfedges) && he_take_u32(c, slots) &&
           he_take_u32(c, materials) && he_take_u32(c, &zero) && zero == 0;
}

/* Allocates all arrays of the mesh. Their sizes must have been checked before. */
static he_status make_room(he_content *c, he_error *err)
{
    he_rows rows[3] = {c->vertices, c->edges, c->faces};
    c->vertices.issued = c->edges.issued = c->faces.issued = 0;
    he_status status = he_content_reserve_vertices(c, rows[0].issued, err);
    if (status == HE_OK) {
        status = he_content_reserve_edges(c, rows[1].issued, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(c, rows[2].issued, err);
    }
    c->vertices.issued = rows[0].issued;
    c->edges.issued = rows[1].issued;
    c->faces.issued = rows[2].issued;
    for (size_t i = 0; i < c->column_count && status == HE_OK; i++) {
        he_column *column = c->columns[i];
        if (column != NULL) {
            size_t stored = column->rows;
            column->rows = 0;
            status = he_column_reserve(column, stored, err);
            column->rows = stored;
        }
    }
    return status;
}

/* Begins to fill the next array that is not empty. After the last array, `left` is 0. */
static void next_array(he_stored_reader *r)
{
    r->left = 0;
    for (; r->left == 0 && r->array < HE_CONTENT_ARRAYS + r->c.column_count; r->array++) {
        if (r->array < HE_CONTENT_ARRAYS) {
            he_content_array array = he_content_array_at(&r->c, r->array);
            r->to = array.bytes;
            r->left = array.size;
            r->links = array.links;
            r->row = 0;
            r->has_last = false;
        } else {
            he_column *column = r->c.columns[r->array - HE_CONTENT_ARRAYS];
            r->to = column == NULL ? NULL : column->data;
            r->left = column == NULL ? 0 : column->rows * column->row_bytes;
            r->links = HE_NO_LINKS;
        }
    }
}

static he_status read_header(he_stored_reader *r, he_error *err)
{
    he_cursor c = he_cursor_over(r->header, r->header_size);
    uint32_t slots = 0, materials = 0;
    uint64_t bytes = 0;
    c.at += HE_CONTENT_START;
    if (!read_rows(&c, &r->c, &slots, &materials) ||
        (uint64_t)slots + materials > he_left(&c) / HE_CONTENT_SLOT) {
        return he_refuse_at(&c, err, "the counts of elements in the stored mesh are impossible");
    }
    he_status status = read_slots(r, &c, slots, &bytes, err);
    if (status == HE_OK) {
        status = read_materials(&c, materials, &r->c.materials, err);
    }
    if (status != HE_OK) {
        return status;
    }
    bool zeros = he_left(&c) < 8;
    for (; zeros && he_left(&c) > 0; c.at++) {
        zeros = *c.at == 0;
    }
    if (!zeros) {
        return he_refuse_at(
            &c, err, "the header of the stored mesh must end in fewer than 8 bytes of zeros");
    }
    r->total = r->header_size + he_content_array_bytes(&r->c) + bytes;
    if (r->total > r->most) {
        return he_refuse_at(&c, err, "the stored mesh declares more bytes than its parts hold");
    }
    status = make_room(&r->c, err);
    if (status == HE_OK) {
        next_array(r);
    }
    return status;
}

/* Copies bytes to the header until it is complete. Sets *taken to the number of bytes that were
 * copied. */
static he_status take_header(he_stored_reader *r, const unsigned char *bytes, size_t size,
                             size_t *taken, he_error *err)
{
    uint64_t left = r->header_wanted - r->header_size;
    size_t now = size < left ? size : (size_t)left;
    if (now > r->header_room - r->header_size) {
        size_t room = he_mem_grown(r->header_room, r->header_size + now);
        unsigned char *grown = he_mem_resize(r->header, room);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for the header of a mesh");
        }
        r->header = grown;
        r->header_room = room;
    }
    memcpy(r->header + r->header_size, bytes, now);
    r->header_size += now;
    r->at += now;
    *taken = now;
    if (r->header_size < r->header_wanted) {
        return HE_OK;
    }
    return r->header_size == HE_CONTENT_START ? read_start(r, err) : read_header(r, err);
}

/* Reads more bytes of the current array from the cursor, at most `room` bytes. */
static he_status take_array(he_stored_reader *r, bool as_links, size_t room, he_cursor *c,
                            he_error *err)
{
    size_t most = r->left < room ? r->left : room, done = 0;
    if (as_links && r->links != HE_NO_LINKS) {
        for (uint32_t link; done < most && he_left(c) > 0; done += sizeof link) {
            bool by_last = r->has_last && r->links == HE_LINKS_BY_LAST;
            if (!he_take_link(c, by_last ? r->last : r->row, &link)) {
                return refuse(r, err, "the stored mesh holds an impossible link");
            }
            memcpy(r->to + done, &link, sizeof link);
            if (link < HE_DEAD) {
                r->last = link;
                r->has_last = true;
            }
            r->row++;
        }
    } else {
        done = most < he_left(c) ? most : he_left(c);
        memcpy(r->to, c->at, done);
        c->at += done;
        r->row += (uint32_t)(done / sizeof(uint32_t));
    }
    r->to += done;
    r->left -= done;
    r->at += done;
    if (r->left == 0) {
        next_array(r);
    }
    return HE_OK;
}

he_status he_stored_reader_part(he_stored_reader *r, unsigned coding, const unsigned char *bytes,
                                size_t size, he_error *err)
{
    if (coding > HE_CODING_LINKS) {
        return he_fail_at(err, HE_UNSUPPORTED, HE_PLACE_BYTE, r->at,
                          "a part of the stored mesh has the coding %u, but this release reads "
                          "only codings up to %u",
                          coding, (unsigned)HE_CODING_LINKS);
    }
    he_cursor c = he_cursor_over(bytes, size);
    uint64_t from = r->at;
    r->has_last = false;
    while (he_left(&c) > 0) {
        size_t room = HE_STORED_PART - (size_t)(r->at - from), taken = 0;
        if (room == 0 || r->at == r->total) {
            return refuse(r, err, "a part of the stored mesh is longer than expected");
        }
        he_status status;
        if (r->header_size < r->header_wanted) {
            size_t size_now = he_left(&c) < room ? he_left(&c) : room;
            status = take_header(r, c.at, size_now, &taken, err);
            c.at += taken;
        } else {
            status = take_array(r, coding == HE_CODING_LINKS, room, &c, err);
        }
        if (status != HE_OK) {
            return status;
        }
    }
    if (size == 0 || (r->at - from != HE_STORED_PART && r->at != r->total)) {
        return refuse(r, err, "a part of the stored mesh is shorter than expected");
    }
    return HE_OK;
}

he_status he_stored_reader_end(he_stored_reader *r, he_mesh **out, he_error *err)
{
    if (r->at != r->total) {
        return refuse(r, err, "parts of the stored mesh are missing");
    }
    he_mesh *mesh = he_mesh_new();
    if (mesh == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a mesh");
    }
    mesh->c = r->c;
    r->c = (he_content){0};
    *out = mesh;
    return HE_OK;
}

he_status he_stored_content_read(const unsigned char *bytes, size_t size, he_mesh **out,
                                 he_error *err)
{
    he_stored_reader *r;
    he_cursor c = he_cursor_over(bytes, size);
    /* Each link takes at least one byte of the input and four bytes in the mesh, so the mesh data
     * has at most four times as many bytes as the input. */
    he_status status = he_stored_reader_new(sizeof(uint32_t) * (uint64_t)size, &r, err);
    if (status != HE_OK) {
        return status;
    }
    while (status == HE_OK && he_left(&c) > 0) {
        unsigned char coding;
        uint32_t length;
        if (!he_take_bytes(&c, 1, &coding) || !he_take_u32(&c, &length) || length > he_left(&c)) {
            status = he_refuse_at(&c, err, "a part of the stored mesh runs past the end");
        } else {
            status = he_stored_reader_part(r, coding, c.at, length, err);
            c.at += length;
        }
    }
    if (status == HE_OK) {
        status = he_stored_reader_end(r, out, err);
    }
    he_stored_reader_free(r);
    return status;
}
