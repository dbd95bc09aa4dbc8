/* edit_write.c - writes a delta (the recorded changes of an edit) as the bytes that stored.h
 * describes. */
#include "mesh/content.h"
#include "stored/attribute_code.h"
#include "stored/edit_code.h"
#include "stored/stored.h"

#include <assert.h>

static he_code code_of(const he_record *r)
{
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
        return HE_CODE_NEXT;
    case HE_COL_PREV:
        return HE_CODE_PREV;
    case HE_COL_ORIGIN:
        return HE_CODE_ORIGIN;
    case HE_COL_FACE:
        return HE_CODE_FACE;
    case HE_COL_VERTEX_HALFEDGE:
        return HE_CODE_VERTEX_HALFEDGE;
    case HE_COL_FACE_HALFEDGE:
        return HE_CODE_FACE_HALFEDGE;
    case HE_COL_POSITION:
        return HE_CODE_POSITION;
    case HE_COL_PARENT:
        return HE_CODE_PARENT;
    case HE_COL_MERGED:
        return HE_CODE_MERGED;
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
    case HE_COL_MATERIAL:
    case HE_COL_POSITIONS:
    case HE_COL_REPLACED:
        return HE_CODE_OBJECT;
    case HE_COL_ATTRIBUTE:
        break;
    }
    return HE_CODE_ATTRIBUTE;
}

/* Returns true if a record of the delta replaces all mesh data. Sets *renumbers to true if ids mean
 * other elements afterwards. */
static bool replaces(const he_delta *delta, bool *renumbers)
{
    bool found = false;
    *renumbers = false;
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        if (delta->records[i].column == HE_COL_REPLACED) {
            found = true;
            *renumbers |= delta->records[i].row != 0;
        }
    }
    return found;
}

/* Returns the index of the next record after record i that adds or removes an attribute in the slot
 * that record i names; delta->count if there is none. */
static size_t next_of_slot(const he_delta *delta, size_t i)
{
    uint32_t slot = delta->records[i].row;
    size_t k = i + 1;
    while (k < delta->count && !(delta->records[k].row == slot &&
                                 (delta->records[k].column == HE_COL_COLUMN_ADDED ||
                                  delta->records[k].column == HE_COL_COLUMN_DROPPED))) {
        k++;
    }
    return k;
}

/* Returns the attribute that record i added. If record `next` of this delta has removed the
 * attribute again, the attribute is the object of record `next`; otherwise the mesh has it. */
static const he_column *added_column(const he_delta *delta, size_t i, size_t next,
                                     const he_mesh *after)
{
    return next == delta->count ? he_mesh_column(after, delta->records[i].row)
                                : delta->objects[delta->records[next].before];
}

/* Returns the material that record i put into its slot. If a later record of this delta has
 * replaced the material, it is the object of that record; otherwise the mesh has it. Returns NULL
 * if record i emptied the slot. */
static const he_material *put_material(const he_delta *delta, size_t i, const he_mesh *after)
{
    uint32_t slot = delta->records[i].row;
    size_t k = i + 1;
    while (k < delta->count &&
           !(delta->records[k].column == HE_COL_MATERIAL && delta->records[k].row == slot)) {
        k++;
    }
    return k == delta->count ? after->c.materials.rows[slot]
                             : delta->objects[delta->records[k].before];
}

static size_t object_room(const he_delta *delta, size_t i, const he_mesh *after)
{
    const he_record *r = &delta->records[i];
    if (r->column == HE_COL_COLUMN_DROPPED) {
        return HE_OBJECT_HEAD + HE_SLOT_ROOM + HE_HEAD_ROOM;
    }
    if (r->column == HE_COL_MATERIAL) {
        const he_material *row = put_material(delta, i, after);
        return HE_OBJECT_HEAD + HE_SLOT_ROOM + sizeof(uint32_t) +
               (row == NULL ? 0 : he_material_code_bytes(row));
    }
    if (r->column == HE_COL_POSITIONS) {
        return HE_OBJECT_HEAD + HE_VARINT_BYTES + r->row * sizeof(he_vec3);
    }
    const he_column *column = added_column(delta, i, next_of_slot(delta, i), after);
    return HE_OBJECT_HEAD + HE_SLOT_ROOM + HE_HEAD_ROOM + he_labels_bytes(column->labels) +
           HE_VARINT_BYTES + column->rows * column->row_bytes;
}

size_t he_stored_edit_bound(const he_delta *delta, const he_mesh *after)
{
    bool renumbers;
    if (replaces(delta, &renumbers)) {
        return HE_EDIT_HEAD + HE_OBJECT_HEAD + 1 + he_stored_content_bound(after);
    }
    size_t bytes = HE_EDIT_HEAD + HE_CHANGE_ROOM * delta->count;
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        if (code_of(&delta->records[i]) == HE_CODE_OBJECT) {
            bytes += object_room(delta, i, after);
        }
    }
    return bytes;
}

static unsigned char *put_tag(unsigned char *to, he_code code, size_t count)
{
    return he_put_varint(to, 16 * ((uint64_t)count - 1) + code);
}

static unsigned char *begin_object(unsigned char *to, he_object kind)
{
    to = he_put_byte(put_tag(to, HE_CODE_OBJECT, 1), kind);
    return he_put_u64(to, 0);
}

/* Ends an object that was written from `from` to `to`: writes its length into the 8 bytes before
 * `from`, which begin_object has left free. */
static unsigned char *end_object(unsigned char *from, unsigned char *to)
{
    (void)he_put_u64(from - 8, (uint64_t)(to - from));
    return to;
}

static unsigned char *put_dropped(unsigned char *to, const he_delta *delta, const he_record *r)
{
    unsigned char *from = begin_object(to, HE_OBJECT_DROPPED);
    to = he_put_varint(from, r->row);
    return end_object(from, he_head_put(to, delta->objects[r->before]));
}

static unsigned char *put_material_change(unsigned char *to, const he_delta *delta, size_t i,
                                          const he_mesh *after)
{
    const he_record *r = &delta->records[i];
    const he_material *row = put_material(delta, i, after);
    unsigned char *from = begin_object(to, HE_OBJECT_MATERIAL);
    to = he_put_u32(he_put_varint(from, r->row), r->after);
    if (row != NULL) {
        to = he_put_bytes(he_material_put_head(to, row), row->name, row->length);
    }
    return end_object(from, to);
}

/* Writes an attribute that record i added, with the values that it had then. Later changes of the
 * values have records of their own, so they are undone in the written values. */
static unsigned char *put_added(unsigned char *to, const he_delta *delta, size_t i,
                                const he_mesh *after)
{
    size_t next = next_of_slot(delta, i);
    const he_column *column = added_column(delta, i, next, after);
    unsigned char *from = begin_object(to, HE_OBJECT_ADDED);
    to = he_put_varint(from, delta->records[i].row);
    to = he_labels_put(he_head_put(to, column), column->labels);
    to = he_put_varint(to, column->rows);
    unsigned char *rows = to;
    to = he_put_bytes(to, column->data, column->rows * column->row_bytes);
    for (size_t k = next; k > i + 1; k--) {
        const he_record *r = &delta->records[k - 1];
        if (r->column == HE_COL_ATTRIBUTE + delta->records[i].row) {
            size_t rest = column->row_bytes - 4 * (size_t)r->word;
            memcpy(rows + (size_t)r->row * column->row_bytes + 4 * (size_t)r->word, &r->before,
                   rest < 4 ? rest : 4);
        }
    }
    return end_object(from, to);
}

/* Writes the positions that record i put into the mesh. They are those that the next such record
 * has kept or, if there is none, those of the mesh; positions that were written between have
 * records of their own, so they are undone in the written values. */
static unsigned char *put_positions(unsigned char *to, const he_delta *delta, size_t i,
                                    const he_mesh *after)
{
    const uint32_t rows = delta->records[i].row;
    size_t next = i + 1;
    while (next < delta->count && delta->records[next].column != HE_COL_POSITIONS) {
        next++;
    }
    const void *values = after->c.position;
    if (next < delta->count) {
        values = ((const he_column *)delta->objects[delta->records[next].before])->data;
    }
    unsigned char *from = begin_object(to, HE_OBJECT_POSITIONS);
    unsigned char *written = he_put_varint(from, rows);
    to = he_put_bytes(written, values, rows * sizeof(he_vec3));
    for (size_t k = next; k > i + 1; k--) {
        const he_record *r = &delta->records[k - 1];
        if (r->column == HE_COL_POSITION && r->row < rows) {
            memcpy(written + r->row * sizeof(he_vec3) + 4 * (size_t)r->word, &r->before, 4);
        }
    }
    return end_object(from, to);
}

/* Writes the object (an attribute, a material or positions) of record i. */
static unsigned char *put_object(unsigned char *to, const he_delta *delta, size_t i,
                                 const he_mesh *after)
{
    const he_record *r = &delta->records[i];
    return r->column == HE_COL_COLUMN_ADDED ? put_added(to, delta, i, after)
           : r->column == HE_COL_MATERIAL   ? put_material_change(to, delta, i, after)
           : r->column == HE_COL_POSITIONS  ? put_positions(to, delta, i, after)
                                            : put_dropped(to, delta, r);
}

static unsigned char *put_change(unsigned char *to, he_code code, uint32_t last, const he_record *r)
{
    to = he_put_varint(to, he_difference(r->row, last));
    if (code == HE_CODE_POSITION || code == HE_CODE_ATTRIBUTE) {
        to = he_put_byte(to, r->word);
        return he_put_u32(he_put_u32(to, r->before), r->after);
    }
    if (code == HE_CODE_PARENT || code == HE_CODE_MERGED) {
        unsigned kind = 0;
        while (he_code_kinds[kind] != (he_kind)r->word) {
            kind++;
            assert(kind < HE_CODE_KINDS);
        }
        return he_put_varint(he_put_byte(to, kind), he_difference(r->before, r->row));
    }
    to = he_put_varint(to, he_link_code(r->before, r->row));
    return he_put_varint(to, he_link_code(r->after, r->row));
}

static unsigned char *put_changes(unsigned char *to, const he_delta *delta, const he_mesh *after)
{
    uint32_t last[HE_CODE_COUNT] = {0};
    for (size_t i = 0; i < delta->count;) {
        const he_record *r = &delta->records[i];
        he_code code = code_of(r);
        if (code == HE_CODE_OBJECT) {
            to = put_object(to, delta, i, after);
            i++;
            continue;
        }
        size_t end = i + 1;
        while (end < delta->count && delta->records[end].column == r->column) {
            end++;
        }
        to = put_tag(to, code, end - i);
        if (code == HE_CODE_ATTRIBUTE) {
            to = he_put_varint(to, r->column - HE_COL_ATTRIBUTE);
        }
        for (; i < end; i++) {
            to = put_change(to, code, last[code], &delta->records[i]);
            last[code] = delta->records[i].row;
        }
    }
    return to;
}

static unsigned version_of(const he_delta *delta)
{
    unsigned version = 1;
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        version = delta->records[i].column == HE_COL_POSITIONS ? HE_EDIT_VERSION : version;
    }
    return version;
}

size_t he_stored_edit_write(const he_delta *delta, const he_mesh *after, unsigned char *to)
{
    bool renumbers, whole = replaces(delta, &renumbers);
    unsigned char *at = he_put_byte(to, whole ? 1 : version_of(delta));
    at = he_put_varint(at, whole ? 1 : delta->count);
    if (whole) {
        unsigned char *from = begin_object(at, HE_OBJECT_REPLACED);
        at = he_put_byte(from, renumbers);
        at = end_object(from, at + he_stored_content_write(after, at));
    } else {
        at = put_changes(at, delta, after);
    }
    return (size_t)(at - to);
}
