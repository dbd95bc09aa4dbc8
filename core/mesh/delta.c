#include "mesh/delta.h"

#include "base/word_hash.h"
#include "mesh/content.h"

#include <string.h>

he_delta *he_delta_new(void)
{
    return he_mem_zero(1, sizeof(he_delta));
}

void he_object_free(uint32_t column, void *object)
{
    if (object == NULL) {
        return;
    }
    if (column == HE_COL_REPLACED) {
        he_content_clear(object);
        he_mem_free(object);
    } else if (column == HE_COL_MATERIAL) {
        he_material_release(object);
    } else {
        he_column_free(object);
    }
}

size_t he_object_bytes(uint32_t column, const void *object)
{
    if (object == NULL) {
        return 0;
    }
    if (column == HE_COL_REPLACED) {
        return he_content_bytes(object);
    }
    if (column == HE_COL_MATERIAL) {
        return he_material_bytes(object);
    }
    /* The labels of a column count, too, unless another column shares them: after an edit that adds
     * or renames a label, only the delta has the old labels. */
    return he_column_bytes(object) + he_labels_own_bytes(((const he_column *)object)->labels);
}

/* Frees the objects (attribute columns, materials or whole mesh data that an edit replaced) of a
 * delta from index `from` on. The delta owns these objects, because they are not in the
 * mesh now. */
static void free_objects(he_delta *d, size_t from)
{
    for (size_t i = 0; i < d->count; i++) {
        const he_record *r = &d->records[i];
        if (he_has_object(r) && r->before >= from) {
            he_object_free(r->column, d->objects[r->before]);
        }
    }
    d->object_count = from;
}

void he_delta_empty(he_delta *d)
{
    if (d->object_count > 0) {
        free_objects(d, 0);
    }
    d->count = 0;
}

void he_delta_free(he_delta *d)
{
    if (d != NULL) {
        he_delta_empty(d);
        he_mem_free(d->records);
        he_mem_free(d->objects);
        he_mem_free(d);
    }
}

size_t he_delta_bytes(const he_delta *d)
{
    size_t bytes =
        sizeof *d + d->capacity * sizeof *d->records + d->object_count * sizeof *d->objects;
    if (d->object_count == 0) {
        return bytes;
    }
    for (size_t i = 0; i < d->count; i++) {
        const he_record *r = &d->records[i];
        if (he_has_object(r)) {
            bytes += he_object_bytes(r->column, d->objects[r->before]);
        }
    }
    return bytes;
}

void he_delta_trim(he_delta *d)
{
    if (d->count < d->capacity) {
        d->records = he_mem_shrink(d->records, d->count * sizeof *d->records);
        d->capacity = d->count;
    }
}

static uint64_t key_of(const he_record *r)
{
    return (uint64_t)r->row << 32 | (uint64_t)r->column << 8 | r->word;
}

/* The number of records that he_delta_fold combines between two reports of progress. Combining one
 * record costs a few cache misses. */
enum { FOLD_STRIDE = 16 * HE_PROGRESS_STRIDE };

/* Combines all records that changed one 32-bit word into one record, and does so for every word. A
 * hash table with open addressing finds the first record of a word; an entry of the table is the
 * index of a record plus 1, or 0 if the entry is free. */
he_status he_delta_fold(he_delta *d, size_t from, he_progress *progress, he_error *err)
{
    uint32_t bits = 4;
    while ((size_t)1 << bits < 2 * (d->count - from)) {
        bits++;
    }
    size_t mask = ((size_t)1 << bits) - 1, kept = from;
    size_t *table = he_mem_zero(mask + 1, sizeof *table);
    if (table == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to combine %zu changes",
                             d->count - from);
    }
    he_status status = HE_OK;
    size_t i = from;
    for (; i < d->count; i++) {
        if ((i - from) % FOLD_STRIDE == 0) {
            status = he_progress_step(progress, 0, 1, err);
            if (status != HE_OK) {
                break;
            }
        }
        he_record r = d->records[i];
        if (r.column >= HE_COL_PARENT && r.column < HE_COL_ATTRIBUTE) {
            d->records[kept++] = r;
            continue;
        }
        size_t at = he_word_hash((uintptr_t)table, key_of(&r)) >> (64 - bits);
        while (table[at] != 0) {
            const he_record *one = &d->records[table[at] - 1];
            if (key_of(one) == key_of(&r)) {
                break;
            }
            at = (at + 1) & mask;
        }
        if (table[at] != 0) {
            d->records[table[at] - 1].after = r.after;
        } else {
            d->records[kept++] = r;
            table[at] = kept;
        }
    }
    /* If the work was cancelled, the records that were not combined yet are moved directly behind
     * the combined records. */
    memmove(d->records + kept, d->records + i, (d->count - i) * sizeof *d->records);
    d->count -= i - kept;
    he_mem_free(table);
    return status;
}

he_status he_delta_reserve(he_delta *d, size_t records, size_t objects, he_error *err)
{
    if (records > d->capacity - d->count) {
        size_t capacity = he_mem_grown(d->capacity, d->count + records);
        he_record *grown = he_mem_array(d->records, capacity, sizeof *grown);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to record %zu changes", records);
        }
        d->records = grown;
        d->capacity = capacity;
    }
    if (objects > d->object_capacity - d->object_count) {
        size_t capacity = he_mem_grown(d->object_capacity, d->object_count + objects);
        void **grown = he_mem_array(d->objects, capacity, sizeof *grown);
        if (grown == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to record %zu changes", objects);
        }
        d->objects = grown;
        d->object_capacity = capacity;
    }
    return HE_OK;
}

he_delta *he_mesh_record(he_mesh *mesh, he_delta *delta)
{
    he_delta *before = mesh->delta;
    mesh->delta = delta;
    return before;
}

static void undo_to(he_delta *d, he_mesh *mesh, size_t to)
{
    he_content_apply(&mesh->c, d, d->count, to, d->objects);
}

void he_delta_undo(he_delta *delta, he_mesh *mesh)
{
    undo_to(delta, mesh, 0);
}

void he_delta_redo(he_delta *delta, he_mesh *mesh)
{
    he_content_apply(&mesh->c, delta, 0, delta->count, delta->objects);
}

he_status he_delta_forward(he_delta *delta, he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT],
                           size_t *refused, he_error *err)
{
    return he_content_forward(&mesh->c, delta, delta->objects, issued, refused, err);
}

he_status he_delta_ready(he_delta *delta, const he_mesh *mesh, he_error *err)
{
    he_status status = HE_OK;
    uint32_t issued[HE_KIND_COUNT] = {0};
    if (delta->object_count == 0) {
        return HE_OK;
    }
    for (he_kind kind = HE_VERTEX; kind <= HE_FACE; kind++) {
        issued[kind] = he_mesh_issued(mesh, kind);
    }
    for (size_t i = 0; i < delta->count && status == HE_OK; i++) {
        const he_record *r = &delta->records[i];
        if (r->column == HE_COL_REPLACED && r->row == 0) {
            status = he_content_issue(delta->objects[r->before], issued, err);
        }
    }
    return status;
}

he_status he_mesh_issue(he_mesh *mesh, const uint32_t issued[HE_KIND_COUNT], he_error *err)
{
    return he_content_issue(&mesh->c, issued, err);
}

static const he_kind tables[] = {HE_VERTEX, HE_EDGE, HE_FACE};

he_savepoint he_delta_mark(const he_mesh *mesh)
{
    he_savepoint mark = {.records = mesh->delta->count, .objects = mesh->delta->object_count};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        mark.issued[tables[i]] = he_mesh_issued(mesh, tables[i]);
    }
    return mark;
}

void he_delta_rollback(he_mesh *mesh, he_savepoint to)
{
    he_delta *d = mesh->delta;
    undo_to(d, mesh, to.records);
    if (d->object_count > to.objects) {
        free_objects(d, to.objects);
    }
    d->count = to.records;
    he_content_withdraw(&mesh->c, to.issued);
}
