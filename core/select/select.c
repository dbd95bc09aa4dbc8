#include "select/select.h"

#include "edit/whole/attribute.h"
#include "mesh/write.h"
#include "select/rules.h"

static he_status pick(const he_mesh *m, const he_select_rule *rule, he_set *out, he_error *err)
{
    switch (rule->by) {
    case HE_BY_REGION:
        return he_pick_region(m, rule, out, err);
    case HE_BY_COMPONENT:
        return he_pick_component(m, rule, out, err);
    case HE_BY_BOX:
        return he_pick_box(m, rule, out, err);
    case HE_BY_HALF_SPACE:
        return he_pick_half_space(m, rule, out, err);
    case HE_BY_LASSO:
        return he_pick_lasso(m, rule, out, err);
    case HE_BY_CONE:
        return he_pick_cone(m, rule, out, err);
    case HE_BY_MEASURE:
        return he_pick_measure(m, rule, out, err);
    case HE_BY_ATTRIBUTE:
        return he_pick_attribute(m, rule, out, err);
    case HE_BY_GROW:
        return he_pick_grown(m, rule, out, err);
    case HE_BY_SHRINK:
        return he_pick_shrunk(m, rule, out, err);
    case HE_BY_BOUNDARY:
        return he_pick_boundary(m, rule, out, err);
    }
    return HE_OK;
}

/* --- the attribute --- */

static bool fits(const he_column *column, const he_select_into *into)
{
    const bool whole = column->type == HE_INT32 || column->type == HE_UINT32;
    return column->components == 1 && column->labels == NULL &&
           (into->value == 0 ? column->type == HE_BOOL : whole);
}

/* Finds the attribute that is to be written; *out is NULL if it must be created. */
static he_status find(const he_mesh *m, he_kind kind, const he_select_into *into,
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
    if (*out == NULL && into->mode == HE_SELECT_REMOVE) {
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

static values values_of(const he_select_into *into)
{
    values v = {{1, 0, 0, 0}, {0, 0, 0, 0}};
    if (into->value != 0) {
        memcpy(v.in, &into->value, sizeof v.in);
    }
    return v;
}

/* --- the changes --- */

/* Compares the set that the attribute has with the one it is to have, and appends the ids of the
 * elements that differ. `column` may be NULL: then the set is empty. */
static he_status compare(const he_mesh *m, const he_column *column, const he_select_into *into,
                         const he_set *found, he_ids *changed, he_selected *out, he_error *err)
{
    const values v = values_of(into);
    he_status status = HE_OK;
    for (uint32_t id = 0; id < found->issued && status == HE_OK; id++) {
        status = he_progress_at(m->progress, id, found->issued, err);
        if (status != HE_OK || !he_mesh_is_live(m, found->kind, id)) {
            continue;
        }
        const bool was =
            column != NULL && memcmp(he_column_value(column, id), v.in, column->row_bytes) == 0;
        const bool is = he_set_has(found, id);
        const bool will = into->mode == HE_SELECT_ONLY  ? is
                          : into->mode == HE_SELECT_ADD ? was || is
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
static he_status put_column(he_mesh *m, he_kind kind, const he_select_into *into,
                            const he_ids *changed, he_error *err)
{
    const values v = values_of(into);
    const he_type type = into->value == 0 ? HE_BOOL : HE_INT32;
    he_column *made = NULL;
    he_status status =
        he_column_new(&(he_column_schema){into->name, kind, type, 1, HE_COPY}, &made, err);
    if (status == HE_OK) {
        status = he_column_extend(made, he_mesh_issued(m, kind), err);
    }
    for (size_t i = 0; i < changed->count && status == HE_OK; i++) {
        memcpy(he_column_row(made, changed->ids[i]), v.in, made->row_bytes);
    }
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
static he_status write_values(he_mesh *m, const he_column *column, const he_select_into *into,
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

he_status he_select(he_mesh *m, const he_select_rule *rule, const he_select_into *into,
                    he_selected *out, he_error *err)
{
    const he_column *column = NULL;
    he_set found = {.bits = NULL};
    he_ids changed = {0};
    he_selected done = {0, 0, 0};
    he_status status = find(m, rule->of, into, &column, err);
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "searching", 0.8, err);
    }
    if (status == HE_OK) {
        status = he_set_new(m, rule->of, &found, err);
    }
    if (status == HE_OK) {
        status = pick(m, rule, &found, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "writing the set", 1, err);
    }
    if (status == HE_OK) {
        status = compare(m, column, into, &found, &changed, &done, err);
    }
    if (status == HE_OK) {
        status = column == NULL ? put_column(m, rule->of, into, &changed, err)
                                : write_values(m, column, into, &changed, err);
    }
    if (status == HE_OK && out != NULL) {
        *out = done;
    }
    he_ids_clear(&changed);
    he_set_clear(&found);
    return status;
}
