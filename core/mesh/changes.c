/* changes.c - finds the net effect on elements of one or several deltas (logs of edits): he_changes
 * of delta.h. */
#include "mesh/delta.h"

#include "mesh/change_marks.h"
#include "mesh/column.h"
#include "mesh/walk.h"

#include <string.h>

/* The change of one 32-bit word in one of the mesh's arrays, taken from a record of a delta (the
 * log of an edit). Sorting such changes by `key` brings all changes of one word together, in the
 * order in which they were made. */
typedef struct word_record {
    /* identifies the word: number of the array, of the element and of the word in the element's
     * entry */
    uint64_t key;
    uint32_t before, after;
} word_record;

static uint64_t key_of(const he_record *r)
{
    return (uint64_t)r->column << 40 | (uint64_t)r->word << 32 | r->row;
}

/* Sorts a few records by key, with insertion sort. Records with equal keys stay in order. */
static void sort_few(word_record *records, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        word_record r = records[i];
        size_t k = i;
        for (; k > 0 && records[k - 1].key > r.key; k--) {
            records[k] = records[k - 1];
        }
        records[k] = r;
    }
}

enum { FEW = 96 };

/* Sorts records by key. Records with equal keys stay in order. Up to FEW records, such as those of
 * a local edit, are sorted by insertion sort; more are sorted by radix sort, which skips the bytes
 * that are equal in all keys. */
static he_status sort_records(word_record **records, size_t count, he_progress *progress,
                              he_error *err)
{
    if (count <= FEW) {
        sort_few(*records, count);
        return HE_OK;
    }
    word_record *from = *records, *to = he_mem_array(NULL, count, sizeof *to);
    if (to == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to sort %zu changes", count);
    }
    uint64_t differs = 0;
    for (size_t i = 1; i < count; i++) {
        differs |= from[i].key ^ from[0].key;
    }
    he_status status = HE_OK;
    for (unsigned shift = 0; shift < 64 && status == HE_OK; shift += 8) {
        if ((differs >> shift & 255) == 0) {
            continue;
        }
        status = he_progress_step(progress, shift, 128, err);
        size_t starts[257] = {0};
        for (size_t i = 0; i < count; i++) {
            starts[(from[i].key >> shift & 255) + 1]++;
        }
        for (size_t b = 1; b < 257; b++) {
            starts[b] += starts[b - 1];
        }
        for (size_t i = 0; i < count && status == HE_OK; i++) {
            status = he_progress_at(progress, i, 128 * (uint64_t)count, err);
            to[starts[from[i].key >> shift & 255]++] = from[i];
        }
        word_record *swap = from;
        from = to;
        to = swap;
    }
    he_mem_free(to);
    *records = from;
    return status;
}

static he_status note_face(he_change_marks *out, uint32_t face, he_error *err)
{
    return face == HE_NONE || face == HE_DEAD
               ? HE_OK
               : he_change_marks_add(out, HE_MODIFIED, HE_FACE, face, err);
}

static he_status note_row(he_change_marks *out, he_kind kind, uint32_t row, uint32_t before,
                          uint32_t after, he_error *err)
{
    const he_change_set set = before == HE_DEAD  ? HE_CREATED
                              : after == HE_DEAD ? HE_DELETED
                                                 : HE_MODIFIED;
    return he_change_marks_add(out, set, kind, row, err);
}

static he_status note_attribute(const he_mesh *mesh, he_change_marks *out, const he_column *column,
                                uint32_t row, he_error *err)
{
    if (column->domain == HE_HALFEDGE) {
        out->lists->others |= mesh->c.face[row] == HE_NONE;
        return note_face(out, mesh->c.face[row], err);
    }
    if (column->domain == HE_MESH_KIND) {
        out->lists->others = true;
        return HE_OK;
    }
    return he_change_marks_add(out, HE_MODIFIED, column->domain, row, err);
}

/* The net change of one 32-bit word in one of the mesh's arrays over all edits that are
 * summed up. */
typedef struct word_change {
    uint32_t column, row, before, after;
} word_change;

/* Adds the element to which a changed word belongs to the lists of changed elements. `attribute` is
 * the attribute column of the word; NULL if the word is a link or part of a position. Elements that
 * were created or deleted are also added to the list of modified elements; keep_modified removes
 * them from that list at the end. */
static he_status note_word(const he_mesh *mesh, he_change_marks *out, const he_column *attribute,
                           const word_change *change, he_error *err)
{
    const uint32_t row = change->row, before = change->before, after = change->after;
    he_status status = HE_OK;
    switch ((he_col)change->column) {
    case HE_COL_NEXT:
        if ((row & 1u) == 0 && (before == HE_DEAD || after == HE_DEAD)) {
            status = note_row(out, HE_EDGE, row >> 1, before, after, err);
        }
        out->lists->others |= mesh->c.face[row] == HE_NONE;
        return status != HE_OK ? status : note_face(out, mesh->c.face[row], err);
    case HE_COL_PREV:
        return HE_OK;
    case HE_COL_ORIGIN:
        status = he_change_marks_add(out, HE_MODIFIED, HE_EDGE, row >> 1, err);
        return status != HE_OK ? status : note_face(out, mesh->c.face[row], err);
    case HE_COL_FACE:
        status = he_change_marks_add(out, HE_MODIFIED, HE_EDGE, row >> 1, err);
        if (status == HE_OK) {
            status = note_face(out, before, err);
        }
        return status != HE_OK ? status : note_face(out, after, err);
    case HE_COL_VERTEX_HALFEDGE:
        return note_row(out, HE_VERTEX, row, before, after, err);
    case HE_COL_FACE_HALFEDGE:
        return note_row(out, HE_FACE, row, before, after, err);
    case HE_COL_POSITION:
        return he_change_marks_add(out, HE_MODIFIED, HE_VERTEX, row, err);
    case HE_COL_PARENT:
    case HE_COL_MERGED:
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
    case HE_COL_MATERIAL:
    case HE_COL_POSITIONS:
    case HE_COL_REPLACED:
        return HE_OK;
    case HE_COL_ATTRIBUTE:
        break;
    }
    return note_attribute(mesh, out, attribute, row, err);
}

static bool is_word(const he_record *r)
{
    return r->column <= HE_COL_POSITION || r->column >= HE_COL_ATTRIBUTE;
}

/* What the edits did to one entry of the mesh's array of attribute columns. The entries are called
 * slots. */
typedef struct attribute_slot {
    /* the column that was in the slot before all edits, if one of the edits dropped it;
     * else NULL */
    const he_column *before;
    bool has_changed; /* a column was added to the slot or dropped from it */
    /* An edit dropped the column that was in the slot at first, and another edit put it back into
     * the mesh. No delta owns this column now, so `before` is NULL. */
    bool is_unknown;
} attribute_slot;

/* Returns the label of component i of an attribute value, which starts at `row`. Returns "" if the
 * component is not the index of a label, which can happen only if the stored mesh was damaged. */
static const char *label_of(const he_column *column, const unsigned char *row, uint32_t i)
{
    uint32_t index;
    memcpy(&index, row + i * sizeof index, sizeof index);
    return index < he_labels_count(column->labels) ? he_labels_get(column->labels, index) : "";
}

/* Returns true if two attribute columns have equal labels for element `row`. If one of the columns
 * does not exist (NULL), the element counts as having the default label of the column
 * that exists. */
static bool same_labels(const he_column *a, const he_column *b, size_t row)
{
    const he_column *x = a != NULL ? a : b, *y = b != NULL ? b : a;
    const unsigned char *one = a != NULL ? he_column_value(a, row) : b->fallback;
    const unsigned char *other = b != NULL ? he_column_value(b, row) : a->fallback;
    bool same = true;
    for (uint32_t i = 0; i < x->components && same; i++) {
        same = strcmp(label_of(x, one, i), label_of(y, other, i)) == 0;
    }
    return same;
}

/* The changes of 32-bit words that all edits made, sorted by key. Changes with equal keys are in
 * the order in which they took effect. If the marks have bits, links and positions are not among
 * them (note_at_once). */
typedef struct words {
    word_record *records;
    size_t count, capacity;
    /* what the edits did to each entry of the mesh's array of attribute columns */
    attribute_slot *slots;
    size_t slot_count;
    /* The positions that the first `moved` vertices had before all edits, if one of the edits wrote
     * all positions at once (HE_COL_POSITIONS); single words of these positions are then not among
     * the records. */
    const he_vec3 *from;
    he_vec3 *own_from; /* `from`, if it is a copy that must be freed, else NULL */
    uint32_t moved;
} words;

/* Evaluates a record which says that an attribute column was added to a slot (an entry of the
 * mesh's array of columns) or dropped from a slot. If the column is not in the mesh now, it is in
 * the delta's array `objects`. A slot number that is too high for the mesh is from a time before
 * all data of the mesh were replaced; such a record is ignored. */
static void note_slot(words *w, const he_change_part *part, const he_record *r)
{
    if (r->row >= w->slot_count) {
        return;
    }
    attribute_slot *slot = &w->slots[r->row];
    bool drops = (r->column == HE_COL_COLUMN_DROPPED) != part->undone;
    if (!slot->has_changed && drops) {
        slot->before = part->delta->objects[r->before];
        slot->is_unknown = slot->before == NULL;
    }
    slot->has_changed = true;
}

/* Returns true if an earlier record added a column to the slot or dropped one from it. Single
 * values that were written to the slot after that are not compared, because the column that was in
 * the slot before all edits is compared with the present column as a whole. */
static bool is_written_later(const words *w, uint32_t slot)
{
    return slot < w->slot_count && w->slots[slot].has_changed;
}

static bool is_moved(const words *w, uint64_t key)
{
    return key >> 40 == HE_COL_POSITION && (uint32_t)key < w->moved;
}

/* Evaluates the first record which says that all positions were written at once. The column that it
 * names now holds the positions from before that; words that were written earlier are put back in a
 * copy of them. A later record of this kind has more vertices only if those were made since. */
static he_status note_positions(words *w, const he_change_part *part, const he_record *r,
                                he_error *err)
{
    const he_column *kept = part->delta->objects[r->before];
    size_t earlier = 0, rest = 0;
    if (w->from != NULL || r->row == 0) {
        return HE_OK;
    }
    w->from = (const he_vec3 *)(const void *)kept->data;
    w->moved = r->row;
    for (size_t i = 0; i < w->count; i++) {
        earlier += is_moved(w, w->records[i].key);
    }
    if (earlier == 0) {
        return HE_OK;
    }
    w->own_from = he_mem_array(NULL, w->moved, sizeof *w->own_from);
    if (w->own_from == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to list %u changes", w->moved);
    }
    memcpy(w->own_from, w->from, w->moved * sizeof *w->own_from);
    w->from = w->own_from;
    for (size_t i = w->count; i > 0; i--) {
        const word_record *one = &w->records[i - 1];
        if (is_moved(w, one->key)) {
            unsigned char *row = (unsigned char *)&w->own_from[(uint32_t)one->key];
            memcpy(row + 4 * (one->key >> 32 & 255), &one->before, sizeof one->before);
        }
    }
    for (size_t i = 0; i < w->count; i++) {
        if (!is_moved(w, w->records[i].key)) {
            w->records[rest++] = w->records[i];
        }
    }
    w->count = rest;
    return HE_OK;
}

/* Returns true if the position of a vertex differs from that before all edits, in a word that
 * note_at_once has not compared already. */
static bool has_moved(const he_mesh *mesh, const words *w, const he_change_marks *marks, uint32_t v)
{
    uint32_t before[HE_POSITION_WORDS], now[HE_POSITION_WORDS];
    memcpy(before, &w->from[v], sizeof before);
    memcpy(now, &mesh->c.position[v], sizeof now);
    bool moved = false;
    for (uint32_t word = 0; word < HE_POSITION_WORDS && !moved; word++) {
        moved = before[word] != now[word] &&
                !(marks->has_bits && he_change_marks_met_position(marks, v, word));
    }
    return moved;
}

/* Adds the vertices whose positions differ from those before all edits, which wrote all positions
 * at once, to the modified vertices. */
static he_status note_moved(const he_mesh *mesh, const words *w, he_change_marks *out,
                            he_error *err)
{
    he_status status = HE_OK;
    for (uint32_t v = 0; v < w->moved && status == HE_OK; v++) {
        if (v % HE_PROGRESS_STRIDE == 0) {
            status = he_progress_step(mesh->progress, 1, 2, err);
        }
        if (status == HE_OK && has_moved(mesh, w, out, v)) {
            status = he_change_marks_add(out, HE_MODIFIED, HE_VERTEX, v, err);
        }
    }
    return status;
}

static void words_clear(words *w)
{
    he_mem_free(w->records);
    he_mem_free(w->slots);
    he_mem_free(w->own_from);
}

/* Returns the present value of the word of a record that is a link or part of a position. */
static uint32_t word_now(const he_mesh *mesh, const he_record *r)
{
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
        return mesh->c.next[r->row];
    case HE_COL_PREV:
        return mesh->c.prev[r->row];
    case HE_COL_ORIGIN:
        return mesh->c.origin[r->row];
    case HE_COL_FACE:
        return mesh->c.face[r->row];
    case HE_COL_VERTEX_HALFEDGE:
        return mesh->c.vertex_halfedge[r->row];
    case HE_COL_FACE_HALFEDGE:
        return mesh->c.face_halfedge[r->row];
    case HE_COL_POSITION: {
        uint32_t parts[HE_POSITION_WORDS];
        memcpy(parts, &mesh->c.position[r->row], sizeof parts);
        return parts[r->word];
    }
    case HE_COL_PARENT:
    case HE_COL_MERGED:
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
    case HE_COL_MATERIAL:
    case HE_COL_POSITIONS:
    case HE_COL_REPLACED:
    case HE_COL_ATTRIBUTE:
        break;
    }
    return 0;
}

/* Evaluates a record of a link or position. The first record of a word has its value before all
 * edits, and the mesh has its value now; so further records of the word say nothing more. A row
 * that the mesh does not have is from a time before all its data were replaced. */
static he_status note_at_once(const he_mesh *mesh, const he_change_part *part, const he_record *r,
                              he_change_marks *out, he_error *err)
{
    if (r->column == HE_COL_PREV || r->row >= he_change_rows(mesh, r->column) ||
        !he_change_marks_meet(out, r)) {
        return HE_OK;
    }
    const uint32_t before = part->undone ? r->after : r->before, after = word_now(mesh, r);
    const word_change change = {r->column, r->row, before, after};
    return before == after ? HE_OK : note_word(mesh, out, NULL, &change, err);
}

/* Appends a record to the list of those that are sorted. */
static he_status add_word(const he_change_part *part, const he_record *r, words *w, he_error *err)
{
    if (w->count == w->capacity) {
        const size_t grown = he_mem_grown(w->capacity, w->count + 1);
        word_record *records = he_mem_array(w->records, grown, sizeof *records);
        if (records == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to list %zu changes", grown);
        }
        w->records = records;
        w->capacity = grown;
    }
    w->records[w->count++] = (word_record){key_of(r), part->undone ? r->after : r->before,
                                           part->undone ? r->before : r->after};
    return HE_OK;
}

static he_status gather_part(const he_mesh *mesh, const he_change_part *part, words *w,
                             he_change_marks *out, he_error *err)
{
    he_changes *found = out->lists;
    he_status status = HE_OK;
    for (size_t i = part->from; i < part->to && status == HE_OK; i++) {
        if (i % HE_PROGRESS_STRIDE == 0) {
            status = he_progress_step(mesh->progress, 0, 1, err);
            if (status != HE_OK) {
                break;
            }
        }
        const he_record *r =
            &part->delta->records[part->undone ? part->to - 1 - (i - part->from) : i];
        if (r->column == HE_COL_POSITION && r->row < w->moved) {
            continue;
        }
        if (r->column <= HE_COL_POSITION && out->has_bits) {
            status = note_at_once(mesh, part, r, out, err);
        } else if (r->column >= HE_COL_ATTRIBUTE &&
                   is_written_later(w, r->column - HE_COL_ATTRIBUTE)) {
            continue;
        } else if (is_word(r)) {
            status = add_word(part, r, w, err);
        } else if (r->column == HE_COL_REPLACED) {
            found->replaced = true;
            found->renumbered |= r->row != 0;
        } else if (r->column == HE_COL_COLUMN_ADDED || r->column == HE_COL_COLUMN_DROPPED) {
            found->others = true;
            note_slot(w, part, r);
        } else if (r->column == HE_COL_MATERIAL) {
            found->others = true;
        } else if (r->column == HE_COL_POSITIONS) {
            status = note_positions(w, part, r, err);
        }
    }
    return status;
}

/* Returns the number of all records of the parts. */
static size_t count_records(const he_change_part *parts, size_t part_count)
{
    size_t total = 0;
    for (size_t i = 0; i < part_count; i++) {
        total += parts[i].to - parts[i].from;
    }
    return total;
}

static he_status gather(const he_mesh *mesh, const he_change_part *parts, size_t part_count,
                        words *w, he_change_marks *out, he_error *err)
{
    const size_t total = out->has_bits ? 0 : count_records(parts, part_count);
    w->slot_count = mesh->c.column_count;
    w->slots = he_mem_zero(w->slot_count + 1, sizeof *w->slots);
    w->records = total == 0 ? NULL : he_mem_array(NULL, total, sizeof *w->records);
    w->capacity = w->records == NULL ? 0 : total;
    if (w->slots == NULL || w->capacity < total) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to list %zu changes", total);
    }
    he_status status = HE_OK;
    for (size_t i = 0; i < part_count && status == HE_OK; i++) {
        status = gather_part(mesh, &parts[i], w, out, err);
    }
    return status == HE_OK ? sort_records(&w->records, w->count, mesh->progress, err) : status;
}

/* Returns the attribute column that has the number `column` in records of a delta. Returns NULL if
 * links or positions have this number, or if a column without labels was dropped; the loss of such
 * a column is reported by he_changes.others and not for each element. */
static const he_column *attribute_of(const he_mesh *mesh, const words *w, uint32_t column)
{
    if (column < HE_COL_ATTRIBUTE) {
        return NULL;
    }
    const attribute_slot *slot = &w->slots[column - HE_COL_ATTRIBUTE];
    if (!slot->has_changed) {
        return mesh->c.columns[column - HE_COL_ATTRIBUTE];
    }
    return slot->before != NULL && slot->before->labels != NULL ? slot->before : NULL;
}

/* Compares the attribute columns `before` and `after`, and adds the elements whose labels differ to
 * the list of modified elements. If one of the columns does not exist (NULL), the elements count as
 * having the default label of the column that exists. */
static he_status note_labels(const he_mesh *mesh, he_change_marks *out, const he_column *before,
                             const he_column *after, he_error *err)
{
    const he_column *any = after != NULL ? after : before;
    size_t rows = before != NULL ? before->rows : 0;
    rows = after != NULL && after->rows > rows ? after->rows : rows;
    he_status status = HE_OK;
    for (size_t row = 0; row < rows && status == HE_OK; row++) {
        if (row % HE_PROGRESS_STRIDE == 0) {
            status = he_progress_step(mesh->progress, 1, 2, err);
        }
        if (status == HE_OK && !same_labels(before, after, row)) {
            status = note_attribute(mesh, out, any, (uint32_t)row, err);
        }
    }
    return status;
}

static bool was_there(const words *w, const he_column *column)
{
    bool found = false;
    for (size_t i = 0; i < w->slot_count && !found; i++) {
        const he_column *before = w->slots[i].before;
        found = w->slots[i].is_unknown || (before != NULL && before->domain == column->domain &&
                                           strcmp(before->name, column->name) == 0);
    }
    return found;
}

static he_status note_slots(const he_mesh *mesh, const words *w, he_change_marks *out,
                            he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < w->slot_count && status == HE_OK; i++) {
        const attribute_slot *slot = &w->slots[i];
        const he_column *before = slot->before, *after = mesh->c.columns[i];
        if (before != NULL && before->labels != NULL) {
            const he_column *is = he_mesh_find_column(mesh, before->domain, before->name);
            if (is == NULL || (is->labels != NULL && is->components == before->components)) {
                status = note_labels(mesh, out, before, is, err);
            }
        }
        if (status == HE_OK && slot->has_changed && after != NULL && after->labels != NULL &&
            !was_there(w, after)) {
            status = note_labels(mesh, out, NULL, after, err);
        }
    }
    return status;
}

static he_status note_all(const he_mesh *mesh, const words *w, he_change_marks *out, he_error *err)
{
    const word_record *records = w->records;
    size_t count = w->count;
    he_status status = HE_OK;
    for (size_t i = 0, noted = 0; i < count && status == HE_OK; noted++) {
        size_t last = i;
        while (last + 1 < count && records[last + 1].key == records[i].key) {
            last++;
        }
        uint32_t column = (uint32_t)(records[i].key >> 40), row = (uint32_t)records[i].key;
        const he_column *attribute = attribute_of(mesh, w, column);
        if (records[i].before != records[last].after &&
            (column < HE_COL_ATTRIBUTE || attribute != NULL)) {
            const word_change change = {column, row, records[i].before, records[last].after};
            status = note_word(mesh, out, attribute, &change, err);
        }
        if (status == HE_OK && noted % HE_PROGRESS_STRIDE == 0) {
            status = he_progress_step(mesh->progress, count + i, 2 * (uint64_t)count, err);
        }
        i = last + 1;
    }
    return status;
}

static he_status note_lineage(const he_change_part *part, const he_change_marks *marks,
                              he_progress *progress, he_error *err)
{
    he_changes *out = marks->lists;
    he_status status = HE_OK;
    for (size_t i = part->from; i < part->to && status == HE_OK; i++) {
        if (i % HE_PROGRESS_STRIDE == 0) {
            status = he_progress_step(progress, 1, 1, err);
            if (status != HE_OK) {
                break;
            }
        }
        const he_record *r = &part->delta->records[i];
        he_kind kind = (he_kind)r->word;
        he_ids *pairs = NULL;
        if (r->column == HE_COL_PARENT && he_change_marks_has(marks, HE_CREATED, kind, r->row)) {
            pairs = &out->parents[kind];
        } else if (r->column == HE_COL_MERGED &&
                   he_change_marks_has(marks, HE_DELETED, kind, r->row)) {
            pairs = &out->merged[kind];
        }
        if (pairs != NULL) {
            status = he_ids_reserve(pairs, 2, err);
            if (status == HE_OK) {
                pairs->ids[pairs->count++] = r->row;
                pairs->ids[pairs->count++] = r->before;
            }
        }
    }
    return status;
}

he_status he_changes_find(const he_mesh *mesh, const he_delta *delta, size_t from, size_t to,
                          bool undone, he_changes *out, he_error *err)
{
    return he_changes_sum(mesh, &(he_change_part){delta, from, to, undone}, 1, out, err);
}

he_status he_changes_sum(const he_mesh *mesh, const he_change_part *parts, size_t part_count,
                         he_changes *out, he_error *err)
{
    he_changes found = {0};
    he_change_marks marks = {.lists = &found};
    words w = {.records = NULL};
    he_status status = he_progress_phase(mesh->progress, "listing changes", 1, err);
    if (status == HE_OK) {
        status = he_change_marks_init(&marks, mesh, count_records(parts, part_count), &found, err);
    }
    if (status == HE_OK) {
        status = gather(mesh, parts, part_count, &w, &marks, err);
    }
    if (status != HE_OK || found.replaced) {
        goto out;
    }
    status = note_moved(mesh, &w, &marks, err);
    if (status == HE_OK) {
        status = note_all(mesh, &w, &marks, err);
    }
    if (status == HE_OK) {
        status = note_slots(mesh, &w, &marks, err);
    }
    if (status == HE_OK) {
        status = he_change_marks_finish(&marks, mesh, err);
    }
    for (size_t i = 0; i < part_count && status == HE_OK; i++) {
        if (!parts[i].undone) {
            status = note_lineage(&parts[i], &marks, mesh->progress, err);
        }
    }
out:
    he_change_marks_clear(&marks);
    words_clear(&w);
    if (status != HE_OK || found.replaced) {
        const he_changes flags = {
            .replaced = found.replaced, .renumbered = found.renumbered, .others = found.others};
        he_changes_clear(&found);
        found = flags;
    }
    if (status == HE_OK) {
        *out = found;
    }
    return status;
}

void he_changes_clear(he_changes *changes)
{
    for (size_t kind = 0; kind < HE_KIND_COUNT; kind++) {
        he_ids_clear(&changes->created[kind]);
        he_ids_clear(&changes->deleted[kind]);
        he_ids_clear(&changes->modified[kind]);
        he_ids_clear(&changes->parents[kind]);
        he_ids_clear(&changes->merged[kind]);
    }
}

bool he_changes_none(const he_changes *changes)
{
    size_t total = (size_t)changes->replaced + changes->others;
    for (size_t kind = 0; kind < HE_KIND_COUNT; kind++) {
        total += changes->created[kind].count + changes->deleted[kind].count +
                 changes->modified[kind].count;
    }
    return total == 0;
}
