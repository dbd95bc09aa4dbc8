#include "api/event/change_json.h"

/* Writes a map from old to new ids as a list: the item with index i is the new id of the element
 * whose old id was i. A new id is null if there was no element with the old id. */
static void write_map(api_out *out, const he_ids *map)
{
    api_out_array_begin(out);
    for (size_t i = 0; i < map->count; i++) {
        api_out_id(out, map->ids[i]);
    }
    api_out_array_end(out);
}

/* Writes the column of a result of an operation that ran once for each item of a list. */
static void write_column(api_out *out, const he_result_row *row, const he_results *results,
                         size_t k)
{
    switch (row->type) {
    case HE_RESULT_ELEMENTS:
        api_out_id_lists(out, results->list[k].ids, results->ends[k].ids, results->ends[k].count);
        return;
    case HE_RESULT_ELEMENT:
        api_out_ids(out, results->list[k].ids, results->list[k].count);
        return;
    case HE_RESULT_NUMBER:
        api_out_numbers(out, results->numbers[k], results->runs);
        return;
    case HE_RESULT_CHOICE:
    case HE_RESULT_MAP:
    case HE_RESULT_COUNTS:
        break;
    }
    /* No operation with such a result takes lists. */
    api_out_null(out);
}

static void write_columns(api_out *out, const he_op *op, const he_results *results)
{
    api_out_key(out, "each");
    api_out_object_begin(out);
    for (size_t i = 0; i < he_op_results(op); i++) {
        api_out_key(out, op->results[i].name);
        write_column(out, &op->results[i], results, i);
    }
    api_out_object_end(out);
}

void api_write_results(api_out *out, const he_op *op, const he_results *results)
{
    api_out_object_begin(out);
    api_out_key_string(out, "op", op->name);
    if (results->each) {
        write_columns(out, op, results);
        api_out_object_end(out);
        return;
    }
    for (size_t i = 0; i < he_op_results(op); i++) {
        if (!results->present[i]) {
            continue;
        }
        api_out_key(out, op->results[i].name);
        switch (op->results[i].type) {
        case HE_RESULT_ELEMENT:
            api_out_id(out, results->id[i]);
            break;
        case HE_RESULT_ELEMENTS:
            api_out_ids(out, results->list[i].ids, results->list[i].count);
            break;
        case HE_RESULT_NUMBER:
            api_out_number(out, results->number[i]);
            break;
        case HE_RESULT_COUNTS:
            api_out_ids(out, results->list[i].ids, results->list[i].count);
            break;
        case HE_RESULT_CHOICE:
            api_out_string(out, op->results[i].choices[results->id[i]]);
            break;
        case HE_RESULT_MAP:
            write_map(out, &results->list[i]);
            break;
        }
    }
    api_out_object_end(out);
}

static const he_kind published[] = {HE_VERTEX, HE_EDGE, HE_FACE};
enum { PUBLISHED = sizeof published / sizeof *published };

static void write_set(api_out *out, const char *key, const he_ids lists[HE_KIND_COUNT])
{
    api_out_key(out, key);
    api_out_object_begin(out);
    for (size_t i = 0; i < PUBLISHED; i++) {
        const he_ids *list = &lists[published[i]];
        api_out_key_ids(out, he_kind_plural(published[i]), list->ids, list->count);
    }
    api_out_object_end(out);
}

static void write_pairs(api_out *out, const char *key, const he_ids lists[HE_KIND_COUNT])
{
    api_out_key(out, key);
    api_out_object_begin(out);
    for (size_t i = 0; i < PUBLISHED; i++) {
        const he_ids *list = &lists[published[i]];
        if (list->count > 0) {
            api_out_key(out, he_kind_plural(published[i]));
            api_out_pairs(out, list->ids, list->count);
        }
    }
    api_out_object_end(out);
}

void api_write_changes(api_out *out, const he_changes *changes)
{
    write_set(out, "created", changes->created);
    write_set(out, "deleted", changes->deleted);
    write_set(out, "modified", changes->modified);
    write_pairs(out, "parents", changes->parents);
    write_pairs(out, "merged", changes->merged);
    if (changes->replaced) {
        api_out_key_bool(out, "replaced", true);
    }
}

const char *api_action_name(st_action action)
{
    static const char *const names[] = {
        [ST_EDIT] = "edit", [ST_UNDO] = "undo", [ST_REDO] = "redo", [ST_REPLACE] = "replace"};
    return names[action];
}
