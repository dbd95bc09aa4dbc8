#include "select/set_write.h"

#include "edit/whole/attribute.h"
#include "mesh/write.h"

static bool fits(const he_column *column, const he_set_into *into)
{
    const bool whole = column->type == HE_INT32 || column->type == HE_UINT32;
    return column->components == 1 && column->labels == NULL &&
           (into->value == 0 ? column->type == HE_BOOL : whole);
}

/* Finds the attribute that is to be written; *out is NULL if it must be created. */
static he_status find(const he_mesh *m, he_kind kind, const he_set_into *into,
                      const he_column **out, he_error *err)
{
    const char *kinds = he_kind_plural(kind);
    const size_t length = strlen(into->name);
    if (length == 0 || length >= HE_COLUMN_NAME) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the name of a set must have 1 to %d bytes, but has %zu",
                             HE_COLUMN_NAME - 1, length);
    }
    if (strcmp(into->name, "position") == 0) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "a set cannot have the name \"position\", which is built in");
    }
    *out = he_mesh_find_column(m, kind, into->name);
    if (*out == NULL && into->mode == HE_SET_REMOVE) {
        return he_fail_plain(err, HE_NO_SUCH_ATTRIBUTE,
                             "%s have no attribute \"%s\" from which elements could be removed",
                             kinds, into->name);
    }
    if (*out == NULL || fits(*out, into)) {
        return HE_OK;
    }
    return he_fail_plain(err, HE_ATTRIBUTE_CLASH,
                         "the attribute \"%s\" of %s has %u components of type %s%s; a set %s",
                         into->name, kinds, (*out)->components, he_type_name((*out)->type),
                         (*out)->labels != NULL ? " with labels" : "",
                         into->value == 0 ? "without a value needs one component of type bool"
                                          : "with a value needs one component of type int32 or "
                                            "uint32");
}

/* The bytes of the attribute's value for elements that are in the set, and for those that left
 * it. */
typedef struct values {
    unsigned char in[4], out[4];
} values;

static values values_of(const he_set_into *into)
{
    values v = {{1, 0, 0, 0}, {0, 0, 0, 0}};
    if (into->value != 0) {
        memcpy(v.in, &into->value, sizeof v.in);
    }
    return v;
}

/* --- the changes --- */

/* Compares the set that the attribute has with the one it is to have, and appends the ids of the
 * elements that differ. */
static he_status compare(const he_mesh *m, const he_column *column, const he_set_into *into,
                         const he_set *found, he_ids *changed, he_set_counts *out, he_error *err)
{
    const values v = values_of(into);
    he_status status = HE_OK;
    for (uint32_t id = 0; id < found->issued && status == HE_OK; id++) {
        status = he_progress_at(m->progress, id, found->issued, err);
        if (status != HE_OK || !he_mesh_is_live(m, found->kind, id)) {
            continue;
        }
        const bool was = memcmp(he_column_value(column, id), v.in, column->row_bytes) == 0;
        const bool is = he_set_has(found, id);
        const bool will = into->mode == HE_SET_ONLY  ? is
                          : into->mode == HE_SET_ADD ? was || is
                                                     : was && !is;
        out->selected += will;
        out->added += will && !was;
        out->removed += was && !will;
        if (will != was) {
            status = he_ids_add(changed, id, err);
        }
    }
    return status;
}

/* Adds a new column with the set to the mesh. */
static he_status put_column(he_mesh *m, const he_set_into *into, const he_set *set,
                            he_set_counts *out, he_error *err)
{
    const values v = values_of(into);
    const he_type type = into->value == 0 ? HE_BOOL : HE_INT32;
    he_column *made = NULL;
    he_status status =
        he_column_new(&(he_column_schema){into->name, set->kind, type, 1, HE_COPY}, &made, err);
    if (status == HE_OK) {
        status = he_column_extend(made, set->issued, err);
    }
    for (uint32_t word = 0; word * 64 < set->issued && status == HE_OK; word++) {
        for (uint64_t bits = set->bits[word]; bits != 0; bits &= bits - 1) {
            const uint32_t id = word * 64 + (uint32_t)__builtin_ctzll(bits);
            memcpy(he_column_row(made, id), v.in, made->row_bytes);
            out->added++;
        }
    }
    out->selected = out->added;
    if (status == HE_OK) {
        status = he_attribute_put(m, made, err);
    }
    if (status != HE_OK) {
        he_column_free(made);
    }
    return status;
}

/* Changes the values of a column of the mesh: each element that changes joins the set or leaves
 * it. */
static he_status write_values(he_mesh *m, const he_column *column, const he_set_into *into,
                              const he_ids *changed, he_error *err)
{
    const values v = values_of(into);
    const size_t slot = he_mesh_column_slot(m, column);
    he_status status = he_reserve_values(m, slot, changed->count, err);
    for (size_t i = 0; i < changed->count && status == HE_OK; i++) {
        const uint32_t id = changed->ids[i];
        const bool was = memcmp(he_column_value(column, id), v.in, column->row_bytes) == 0;
        he_set_attribute(m, slot, id, was ? v.out : v.in);
    }
    return status;
}

he_status he_set_into_check(const he_mesh *m, he_kind kind, const he_set_into *into, he_error *err)
{
    const he_column *column;
    return find(m, kind, into, &column, err);
}

he_status he_set_write(he_mesh *m, const he_set *set, const he_set_into *into, he_set_counts *out,
                       he_error *err)
{
    const he_column *column = NULL;
    he_ids changed = {0};
    he_set_counts done = {0, 0, 0};
    he_status status = find(m, set->kind, into, &column, err);
    if (status == HE_OK && column == NULL) {
        status = put_column(m, into, set, &done, err);
    } else if (status == HE_OK) {
        status = compare(m, column, into, set, &changed, &done, err);
        if (status == HE_OK) {
            status = write_values(m, column, into, &changed, err);
        }
    }
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    he_ids_clear(&changed);
    return status;
}
