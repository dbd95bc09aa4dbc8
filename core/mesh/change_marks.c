#include "mesh/change_marks.h"

#include "mesh/walk.h"

#include <string.h>

static const he_kind published[] = {HE_VERTEX, HE_EDGE, HE_FACE};
enum { PUBLISHED = sizeof published / sizeof *published };

/* Fewer records than this are sorted in little time. */
enum { FEW_RECORDS = 96 };

/* With one record for this many ids of the mesh, clearing and reading bits takes less time than
 * sorting the records. */
enum { IDS_A_RECORD = 64 };

static he_ids *list_of(const he_change_marks *marks, he_change_set set, he_kind kind)
{
    he_changes *lists = marks->lists;
    return set == HE_CREATED   ? &lists->created[kind]
           : set == HE_DELETED ? &lists->deleted[kind]
                               : &lists->modified[kind];
}

static size_t words_for(size_t bits)
{
    return bits / 64 + 1;
}

/* Returns the number of bits for an array of the mesh; 0 for the array `prev`, whose changes say
 * nothing that those of `next` do not say. */
static size_t bits_of(const he_mesh *mesh, he_col column)
{
    const size_t rows = column == HE_COL_PREV ? 0 : he_change_rows(mesh, column);
    return column == HE_COL_POSITION ? rows * HE_POSITION_WORDS : rows;
}

he_status he_change_marks_init(he_change_marks *marks, const he_mesh *mesh, size_t records,
                               he_changes *lists, he_error *err)
{
    *marks = (he_change_marks){.lists = lists};
    size_t total = 0, ids = 0;
    for (he_col column = HE_COL_NEXT; column <= HE_COL_POSITION; column++) {
        total += words_for(bits_of(mesh, column));
    }
    for (size_t i = 0; i < PUBLISHED; i++) {
        marks->count[published[i]] = he_mesh_issued(mesh, published[i]);
        ids += marks->count[published[i]];
        total += HE_CHANGE_SETS * words_for(marks->count[published[i]]);
    }
    if (records < FEW_RECORDS || ids / IDS_A_RECORD > records) {
        return HE_OK;
    }
    marks->memory = he_mem_zero(total, sizeof *marks->memory);
    if (marks->memory == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to list changes");
    }
    uint64_t *at = marks->memory;
    for (he_col column = HE_COL_NEXT; column <= HE_COL_POSITION; column++) {
        marks->met[column] = at;
        at += words_for(bits_of(mesh, column));
    }
    for (size_t i = 0; i < PUBLISHED; i++) {
        for (size_t set = 0; set < HE_CHANGE_SETS; set++) {
            marks->sets[set][published[i]] = at;
            at += words_for(marks->count[published[i]]);
        }
    }
    marks->has_bits = true;
    return HE_OK;
}

void he_change_marks_clear(he_change_marks *marks)
{
    he_mem_free(marks->memory);
    *marks = (he_change_marks){.lists = NULL};
}

he_status he_change_marks_list(he_change_marks *marks, he_change_set set, he_kind kind, uint32_t id,
                               he_error *err)
{
    return he_ids_add(list_of(marks, set, kind), id, err);
}

/* Appends the ids whose bits are set to a list. */
static he_status list_bits(const uint64_t *bits, size_t words, he_ids *list, he_error *err)
{
    size_t count = 0;
    for (size_t w = 0; w < words; w++) {
        count += (size_t)__builtin_popcountll(bits[w]);
    }
    he_status status = count == 0 ? HE_OK : he_ids_reserve(list, count, err);
    for (size_t w = 0; w < words && status == HE_OK; w++) {
        for (uint64_t left = bits[w]; left != 0; left &= left - 1) {
            list->ids[list->count++] = (uint32_t)(w * 64 + (size_t)__builtin_ctzll(left));
        }
    }
    return status;
}

static bool contains(const he_ids *sorted, uint32_t id)
{
    size_t low = 0, high = sorted->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (sorted->ids[middle] < id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < sorted->count && sorted->ids[low] == id;
}

bool he_change_marks_has(const he_change_marks *marks, he_change_set set, he_kind kind, uint32_t id)
{
    if (marks->has_bits && id < marks->count[kind]) {
        return (marks->sets[set][kind][id / 64] >> id % 64 & 1) != 0;
    }
    return contains(list_of(marks, set, kind), id);
}

static void keep_modified(const he_change_marks *marks, const he_mesh *mesh, he_kind kind)
{
    he_ids *list = list_of(marks, HE_MODIFIED, kind);
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        uint32_t id = list->ids[i];
        if (he_mesh_is_live(mesh, kind, id) && !he_change_marks_has(marks, HE_CREATED, kind, id)) {
            list->ids[kept++] = id;
        }
    }
    list->count = kept;
}

static he_status finish(const he_change_marks *marks, he_change_set set, he_kind kind,
                        he_error *err)
{
    he_ids *list = list_of(marks, set, kind);
    return marks->has_bits
               ? list_bits(marks->sets[set][kind], words_for(marks->count[kind]), list, err)
               : he_ids_sort(list, err);
}

he_status he_change_marks_finish(he_change_marks *marks, const he_mesh *mesh, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < PUBLISHED && status == HE_OK; i++) {
        status = he_progress_step(mesh->progress, 1, 1, err);
        for (he_change_set set = HE_CREATED; set <= HE_MODIFIED && status == HE_OK; set++) {
            status = finish(marks, set, published[i], err);
        }
        if (status == HE_OK) {
            keep_modified(marks, mesh, published[i]);
        }
    }
    return status;
}
