#include "edit/whole/material.h"

#include "edit/piece/list.h"
#include "edit/whole/attribute.h"
#include "mesh/write.h"

/* Finds the attribute `material` of faces. Sets *out to NULL if the mesh does not have it, and
 * refuses if its values are not of the required type. */
static he_status find_column(const he_mesh *m, const he_column **out, he_error *err)
{
    *out = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    if (*out == NULL || he_is_material_column(*out)) {
        return HE_OK;
    }
    return he_fail_plain(err, HE_ATTRIBUTE_CLASH,
                         "the face attribute \"material\" has %u components of type %s%s, but must "
                         "have one component of type uint32 with labels",
                         (*out)->components, he_type_name((*out)->type),
                         (*out)->labels != NULL ? " with labels" : "");
}

/* Makes a column of the attribute `material` with the given labels and the values of `column`. If
 * `column` is NULL, no face has a material in the new column. */
static he_status column_with(const he_mesh *m, const he_column *column, he_labels *labels,
                             he_column **out, he_error *err)
{
    he_status status = column != NULL
                           ? he_column_copy(column, out, err)
                           : he_column_new(&(he_column_schema){HE_MATERIAL_ATTRIBUTE, HE_FACE,
                                                               HE_UINT32, 1, HE_COPY},
                                           out, err);
    if (status == HE_OK && column == NULL) {
        status = he_column_extend(*out, he_mesh_issued(m, HE_FACE), err);
    }
    if (status == HE_OK) {
        he_labels_release((*out)->labels);
        (*out)->labels = he_labels_retain(labels);
    }
    return status;
}

/* Makes a list of the labels of the column (none if the column is NULL). In the list, `from` is
 * replaced by `to`, so if the column has labels `from` and `to`, they become one. If `from` is
 * NULL, `to` is appended instead. new_index[i] gets the new index of label i, unless new_index is
 * NULL. */
static he_status make_labels(const he_column *column, const char *from, const char *to,
                             he_labels *out, uint32_t *new_index, he_error *err)
{
    he_status status = HE_OK;
    uint32_t index = 0;
    size_t count = column == NULL ? 0 : he_labels_count(column->labels);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        const char *text = he_labels_get(column->labels, i);
        text = from != NULL && strcmp(text, from) == 0 ? to : text;
        status = he_labels_add(out, text, strlen(text), &index, err);
        if (new_index != NULL) {
            new_index[i] = index;
        }
    }
    if (count == 0 && status == HE_OK) {
        status = he_labels_add(out, "", 0, &index, err);
    }
    return status == HE_OK && from == NULL ? he_labels_add(out, to, strlen(to), &index, err)
                                           : status;
}

static void change_indices(he_column *column, const uint32_t *new_index)
{
    uint32_t index = 0;
    for (size_t row = 0; row < column->rows; row++) {
        memcpy(&index, he_column_row(column, row), sizeof index);
        memcpy(he_column_row(column, row), &new_index[index], sizeof index);
    }
    memcpy(&index, column->fallback, sizeof index);
    memcpy(column->fallback, &new_index[index], sizeof index);
}

/* Replaces the column by a copy in which label `from` is replaced by `to`. If `from` is NULL, `to`
 * is appended to the labels instead. */
static he_status put_labels(he_mesh *m, const he_column *column, const char *from, const char *to,
                            uint32_t *new_index, he_error *err)
{
    he_column *made = NULL;
    he_labels *labels = he_labels_new();
    he_status status = labels == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory for names of materials")
                           : make_labels(column, from, to, labels, new_index, err);
    if (status == HE_OK) {
        status = column_with(m, column, labels, &made, err);
    }
    if (status == HE_OK && new_index != NULL) {
        change_indices(made, new_index);
    }
    if (status == HE_OK) {
        status = he_attribute_put(m, made, err);
    }
    if (status != HE_OK) {
        he_column_free(made);
    }
    he_labels_release(labels);
    return status;
}

static bool has_label(const he_column *column, const char *name, uint32_t *index)
{
    return column != NULL && he_labels_find(column->labels, name, strlen(name), index);
}

static he_status give(he_mesh *m, const char *name, const he_material_change *change, he_error *err)
{
    const he_column *column = NULL;
    uint32_t index = 0;
    he_status status = find_column(m, &column, err);
    if (status == HE_OK && !has_label(column, name, &index)) {
        status = put_labels(m, column, NULL, name, NULL, err);
        if (status == HE_OK) {
            status = find_column(m, &column, err);
        }
    }
    if (status != HE_OK) {
        return status;
    }
    bool found = has_label(column, name, &index);
    assert(found);
    (void)found;
    return he_attribute_write(m, column, change->faces, change->face_count, &index, true, err);
}

/* Renames a material in the labels of the attribute `material`. Refuses if the new name is in use,
 * or if no material has the old name. */
static he_status rename_label(he_mesh *m, const char *name, bool has_row, const char *to,
                              he_error *err)
{
    const he_column *column = NULL;
    uint32_t index = 0;
    he_status status = find_column(m, &column, err);
    if (status != HE_OK) {
        return status;
    }
    /* The empty label means that a face has no material. Renaming it would give a material to all
     * such faces. */
    if (*name == '\0') {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "a material without a name does not exist and cannot be renamed");
    }
    if (he_materials_find(&m->c.materials, to, strlen(to)) != SIZE_MAX ||
        has_label(column, to, &index)) {
        return he_fail_plain(err, HE_BAD_VALUE, "there is already a material \"%.80s\"", to);
    }
    bool named = has_label(column, name, &index);
    if (!named && !has_row) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the material \"%.80s\" cannot be renamed, because it does not exist",
                             name);
    }
    return named ? put_labels(m, column, name, to, NULL, err) : HE_OK;
}

static void change_look(const he_material_change *change, he_look *look)
{
    if (change->base_color != NULL) {
        memcpy(look->base_color, change->base_color,
               (change->opaque_too ? 4 : 3) * sizeof *look->base_color);
    }
    look->metallic = change->metallic != NULL ? *change->metallic : look->metallic;
    look->roughness = change->roughness != NULL ? *change->roughness : look->roughness;
    if (change->emission != NULL) {
        memcpy(look->emission, change->emission, sizeof look->emission);
    }
    look->two_sided = change->two_sided != NULL ? *change->two_sided : look->two_sided;
}

static he_status set_row(he_mesh *m, size_t slot, const char *name,
                         const he_material_change *change, he_error *err)
{
    const he_material *row = slot == SIZE_MAX ? NULL : m->c.materials.rows[slot];
    he_look look = row == NULL || change->replace ? he_plain_look : row->look;
    he_material *made = NULL;
    change_look(change, &look);
    he_status status = he_material_new(name, strlen(name), &look, &made, err);
    if (status != HE_OK) {
        return status;
    }
    bool same = he_material_equal(row, made);
    if (!same) {
        status = he_mesh_put_material(
            m, row == NULL ? he_materials_free_slot(&m->c.materials) : slot, made, err);
    }
    if (same || status != HE_OK) {
        he_material_release(made);
    }
    return status;
}

static bool only_gives(const he_material_change *change)
{
    return change->faces != NULL && change->rename == NULL && !change->replace &&
           change->base_color == NULL && change->metallic == NULL && change->roughness == NULL &&
           change->emission == NULL && change->two_sided == NULL;
}

/* Removes the material from the listed faces. If the mesh has no attribute `material`, no face has
 * a material, so only the list is checked. */
static he_status give_none(he_mesh *m, const he_material_change *change, he_error *err)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    return column != NULL ? give(m, "", change, err)
                          : he_list_require(m, HE_FACE, change->faces, change->face_count,
                                            HE_REPEATED_ELEMENT, err);
}

static he_status set_in_bracket(he_mesh *m, const char *name, const he_material_change *change,
                                he_error *err)
{
    if (*name == '\0' && only_gives(change)) {
        return give_none(m, change, err);
    }
    size_t slot = he_materials_find(&m->c.materials, name, strlen(name));
    const char *to =
        change->rename != NULL && strcmp(change->rename, name) != 0 ? change->rename : NULL;
    he_status status = HE_OK;
    if (to != NULL) {
        status = rename_label(m, name, slot != SIZE_MAX, to, err);
    }
    if (status == HE_OK) {
        status = set_row(m, slot, to != NULL ? to : name, change, err);
    }
    return status == HE_OK && change->faces != NULL ? give(m, to != NULL ? to : name, change, err)
                                                    : status;
}

he_status he_material_set(he_mesh *m, const char *name, const he_material_change *change,
                          he_error *err)
{
    he_bracket bracket;
    he_status status = he_edit_begin(m, &bracket, err);
    return status == HE_OK ? he_edit_end(m, &bracket, set_in_bracket(m, name, change, err))
                           : status;
}

static bool has_material(const he_mesh *m, const he_column *column, const char *name)
{
    uint32_t index = 0;
    return *name != '\0' && (he_materials_find(&m->c.materials, name, strlen(name)) != SIZE_MAX ||
                             has_label(column, name, &index));
}

static he_status merge_labels(he_mesh *m, const he_column *column, const char *from, const char *to,
                              he_error *err)
{
    uint32_t *new_index = he_mem_array(NULL, he_labels_count(column->labels), sizeof *new_index);
    he_status status = new_index == NULL
                           ? he_fail_plain(err, HE_NO_MEMORY, "no memory for names of materials")
                           : put_labels(m, column, from, to, new_index, err);
    he_mem_free(new_index);
    return status;
}

static he_status delete_in_bracket(he_mesh *m, const char *name, const char *to, he_error *err)
{
    const he_column *column = NULL;
    uint32_t index = 0;
    he_status status = find_column(m, &column, err);
    if (status != HE_OK) {
        return status;
    }
    if (!has_material(m, column, name)) {
        return he_fail_plain(err, HE_BAD_VALUE,
                             "the material \"%.80s\" cannot be deleted, because it does not exist",
                             name);
    }
    if (to != NULL && !has_material(m, column, to)) {
        return he_fail_plain(
            err, HE_BAD_VALUE,
            "the material \"%.80s\" cannot replace the deleted one, because it does not exist", to);
    }
    if (to != NULL && strcmp(name, to) == 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "the material \"%.80s\" cannot replace itself", to);
    }
    if (has_label(column, name, &index)) {
        status = merge_labels(m, column, name, to != NULL ? to : "", err);
    }
    size_t slot = he_materials_find(&m->c.materials, name, strlen(name));
    return status == HE_OK && slot != SIZE_MAX ? he_mesh_put_material(m, slot, NULL, err) : status;
}

he_status he_material_delete(he_mesh *m, const char *name, const char *to, he_error *err)
{
    he_bracket bracket;
    he_status status = he_edit_begin(m, &bracket, err);
    return status == HE_OK ? he_edit_end(m, &bracket, delete_in_bracket(m, name, to, err)) : status;
}
