#include "edit/whole/append.h"

#include "edit/whole/attribute.h"
#include "mesh/write.h"

/* Says to which attribute column of this mesh the values of a column of the other mesh are
 * appended, and how they are mapped. */
typedef struct target {
    size_t slot;
    /* Maps the index that a label (name of a value) has in the other mesh's column to its index in
     * this mesh's column; NULL: indices stay as they are. */
    uint32_t *label;
} target;

void he_appended_clear(he_appended *appended)
{
    he_ids_clear(&appended->vertices);
    he_ids_clear(&appended->edges);
    he_ids_clear(&appended->faces);
}

static he_status check_clash(const he_column *own, const he_column *theirs, he_error *err)
{
    if (own->type == theirs->type && own->components == theirs->components &&
        (own->labels == NULL) == (theirs->labels == NULL)) {
        return HE_OK;
    }
    const char *labelled[2] = {own->labels != NULL ? " with labels" : "",
                               theirs->labels != NULL ? " with labels" : ""};
    return he_fail_plain(
        err, HE_ATTRIBUTE_CLASH,
        "attribute %.60s of %s is %u %s%s in this mesh and %u %s%s in the other mesh", own->name,
        he_kind_plural(own->domain), own->components, he_type_name(own->type), labelled[0],
        theirs->components, he_type_name(theirs->type), labelled[1]);
}

static he_status check_columns(const he_mesh *m, const he_mesh *other, he_error *err)
{
    for (size_t i = 0; i < other->c.column_count; i++) {
        const he_column *theirs = other->c.columns[i];
        const he_column *own =
            theirs == NULL ? NULL : he_mesh_find_column(m, theirs->domain, theirs->name);
        if (own != NULL && own->domain != HE_MESH_KIND) {
            he_status status = check_clash(own, theirs, err);
            if (status != HE_OK) {
                return status;
            }
        }
    }
    return HE_OK;
}

static he_status no_memory(const he_column *column, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for attribute %s", column->name);
}

/* --- materials --- */

/* The materials of the other mesh that get another name in this mesh. */
typedef struct renames {
    /* the names of these materials in the other mesh; NULL: no material is renamed */
    he_labels *from;
    /* slots.ids[i] is the entry of material from[i] in this mesh's table of materials */
    he_ids slots;
} renames;

static void renames_clear(renames *r)
{
    he_labels_release(r->from);
    he_ids_clear(&r->slots);
}

static he_status rename_material(renames *r, const he_material *row, size_t slot, he_error *err)
{
    uint32_t index;
    if (r->from == NULL) {
        r->from = he_labels_new();
        if (r->from == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for names of materials");
        }
    }
    he_status status = he_labels_add(r->from, row->name, row->length, &index, err);
    return status == HE_OK ? he_ids_add(&r->slots, (uint32_t)slot, err) : status;
}

static bool is_label(const he_mesh *m, const char *name)
{
    const he_column *column = he_mesh_find_column(m, HE_FACE, HE_MATERIAL_ATTRIBUTE);
    uint32_t index;
    return column != NULL && column->labels != NULL &&
           he_labels_find(column->labels, name, strlen(name), &index);
}

/* Chooses the name that a material of the other mesh gets in this mesh. It keeps its own name,
 * unless a different material of this mesh has that name. Then it gets the first of the names
 * NAME_2, NAME_3 and so on that is free in both meshes or belongs to an equal material. */
static void choose_name(const he_mesh *m, const he_mesh *other, const he_material *row,
                        char name[HE_MATERIAL_NAME + 1])
{
    for (unsigned number = 1;; number++) {
        he_material_number_name(row->name, number, name);
        size_t slot = he_materials_find(&m->c.materials, name, strlen(name));
        if (slot != SIZE_MAX) {
            if (he_look_equal(&m->c.materials.rows[slot]->look, &row->look)) {
                return;
            }
        } else if (number == 1 || !(is_label(m, name) || is_label(other, name))) {
            return;
        }
    }
}

static he_status merge_material(he_mesh *m, const he_mesh *other, he_material *row, renames *r,
                                he_error *err)
{
    char name[HE_MATERIAL_NAME + 1];
    he_material *made = NULL;
    choose_name(m, other, row, name);
    bool same = strcmp(name, row->name) == 0;
    size_t slot = he_materials_find(&m->c.materials, name, strlen(name));
    he_status status = HE_OK;
    if (slot == SIZE_MAX) {
        slot = he_materials_free_slot(&m->c.materials);
        if (same) {
            made = he_material_retain(row);
        } else {
            status = he_material_new(name, strlen(name), &row->look, &made, err);
        }
        if (status == HE_OK) {
            status = he_mesh_put_material(m, slot, made, err);
        }
        if (status != HE_OK) {
            he_material_release(made);
        }
    }
    return status == HE_OK && !same ? rename_material(r, row, slot, err) : status;
}

/* Adds to this mesh the materials of the other mesh that it lacks. */
static he_status merge_materials(he_mesh *m, const he_mesh *other, renames *r, he_error *err)
{
    const he_materials *theirs = &other->c.materials;
    he_status status = HE_OK;
    for (size_t i = 0; i < theirs->count && status == HE_OK; i++) {
        if (theirs->rows[i] != NULL) {
            status = merge_material(m, other, theirs->rows[i], r, err);
        }
    }
    return status;
}

/* --- labels --- */

/* Returns the label of this mesh that corresponds to a label of the other mesh. The two labels
 * differ if the label is the name of a material that was renamed. */
static const char *name_here(const he_mesh *m, const he_column *theirs, const renames *r,
                             const char *text)
{
    uint32_t index;
    return r->from != NULL && he_is_material_column(theirs) &&
                   he_labels_find(r->from, text, strlen(text), &index)
               ? m->c.materials.rows[r->slots.ids[index]]->name
               : text;
}

static he_status add_labels(he_labels *to, const he_labels *from, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < he_labels_count(from) && status == HE_OK; i++) {
        const char *text = he_labels_get(from, i);
        uint32_t index;
        status = he_labels_add(to, text, strlen(text), &index, err);
    }
    return status;
}

static he_status add_theirs(const he_mesh *m, he_labels *to, const he_column *theirs,
                            const renames *r, uint32_t *at, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < he_labels_count(theirs->labels) && status == HE_OK; i++) {
        const char *text = name_here(m, theirs, r, he_labels_get(theirs->labels, i));
        status = he_labels_add(to, text, strlen(text), &at[i], err);
    }
    return status;
}

/* Makes a list of the labels of columns `own` (which may be NULL) and `theirs`, beginning with
 * those of `own`. out->label gets the index of each label of `theirs` in that list. */
static he_status make_labels(const he_mesh *m, const he_column *own, const he_column *theirs,
                             const renames *r, target *out, he_labels **labels, he_error *err)
{
    he_labels *both = he_labels_new();
    out->label = he_mem_array(NULL, he_labels_count(theirs->labels) + 1, sizeof *out->label);
    he_status status = both == NULL || out->label == NULL ? no_memory(theirs, err) : HE_OK;
    if (status == HE_OK && own != NULL) {
        status = add_labels(both, own->labels, err);
    }
    if (status == HE_OK) {
        status = add_theirs(m, both, theirs, r, out->label, err);
    }
    if (status != HE_OK) {
        he_labels_release(both);
        return status;
    }
    *labels = both;
    return HE_OK;
}

/* Adds the labels of column `theirs` to column `own` of this mesh: replaces `own` by a copy that
 * has all labels, unless `own` has them already. */
static he_status join_labels(he_mesh *m, const he_column *own, const he_column *theirs,
                             const renames *r, target *out, he_error *err)
{
    he_column *copy = NULL;
    he_labels *both = NULL;
    he_status status = make_labels(m, own, theirs, r, out, &both, err);
    if (status == HE_OK && he_labels_count(both) > he_labels_count(own->labels)) {
        status = he_column_copy(own, &copy, err);
        if (status == HE_OK) {
            he_labels_release(copy->labels);
            copy->labels = he_labels_retain(both);
            status = he_attribute_put(m, copy, err);
        }
        if (status == HE_OK) {
            out->slot = he_mesh_column_slot(m, copy);
        } else {
            he_column_free(copy);
        }
    }
    he_labels_release(both);
    return status;
}

/* Replaces indices of labels in the other mesh by the indices of these labels in this mesh. An
 * index without a label stays as it is. */
static void map_labels(const he_column *theirs, const target *to, unsigned char *value)
{
    for (uint32_t k = 0; to->label != NULL && k < theirs->components; k++) {
        uint32_t index;
        memcpy(&index, value + k * sizeof index, sizeof index);
        if (index < he_labels_count(theirs->labels)) {
            index = to->label[index];
        }
        memcpy(value + k * sizeof index, &index, sizeof index);
    }
}

/* --- columns --- */

/* Adds a column like `theirs` to this mesh. All elements of this mesh get its default value. If the
 * attribute belongs to a mesh as a whole, this mesh gets the value that the other mesh has. */
static he_status add_column(he_mesh *m, const he_column *theirs, const renames *r, target *out,
                            he_error *err)
{
    he_column *column = NULL;
    he_status status = he_column_copy(theirs, &column, err);
    if (status != HE_OK) {
        return status;
    }
    if (r->from != NULL && he_is_material_column(theirs)) {
        he_labels *labels = NULL;
        status = make_labels(m, NULL, theirs, r, out, &labels, err);
        if (status != HE_OK) {
            he_column_free(column);
            return status;
        }
        he_labels_release(column->labels);
        column->labels = labels;
        map_labels(theirs, out, column->fallback);
    }
    if (theirs->domain != HE_MESH_KIND) {
        column->rows = 0;
        status = he_column_extend(column, he_mesh_issued(m, theirs->domain), err);
    }
    if (status == HE_OK) {
        status = he_mesh_add_column(m, column, err);
    }
    if (status == HE_OK) {
        out->slot = he_mesh_column_slot(m, column);
    } else {
        he_column_free(column);
    }
    return status;
}

static he_status match_column(he_mesh *m, const he_column *theirs, const renames *r, target *out,
                              he_error *err)
{
    const he_column *own = he_mesh_find_column(m, theirs->domain, theirs->name);
    if (own == NULL) {
        return add_column(m, theirs, r, out, err);
    }
    if (theirs->domain == HE_MESH_KIND) {
        return HE_OK;
    }
    out->slot = he_mesh_column_slot(m, own);
    bool renamed = r->from != NULL && he_is_material_column(theirs);
    return theirs->labels == NULL || (theirs->labels == own->labels && !renamed)
               ? HE_OK
               : join_labels(m, own, theirs, r, out, err);
}

static void carry_row(he_mesh *m, const he_column *theirs, const target *to, uint32_t from,
                      uint32_t row)
{
    unsigned char value[HE_COLUMN_ROW_BYTES];
    memcpy(value, he_column_value(theirs, from), theirs->row_bytes);
    map_labels(theirs, to, value);
    he_set_attribute(m, to->slot, row, value);
}

/* --- COMMIT: writing --- */

/* Maps the ids of the other mesh's elements to the ids that they get in this mesh. */
typedef struct maps {
    uint32_t *vertex, *edge, *face;
} maps;

static uint32_t *map_of(const maps *at, he_kind kind)
{
    return kind == HE_VERTEX ? at->vertex : kind == HE_FACE ? at->face : at->edge;
}

static void make_rows(he_mesh *m, const he_mesh *other, const maps *at, he_appended *out)
{
    for (uint32_t i = 0; i < other->c.vertices.issued; i++) {
        if (he_vertex_is_live(other, (he_vertex){i})) {
            he_vertex v = he_new_vertex(m);
            he_set_position(m, v, he_position(other, (he_vertex){i}));
            at->vertex[i] = out->vertices.ids[out->vertices.count++] = v.i;
        }
    }
    for (uint32_t i = 0; i < other->c.edges.issued; i++) {
        if (he_edge_is_live(other, (he_edge){i})) {
            at->edge[i] = out->edges.ids[out->edges.count++] = he_new_edge(m).i;
        }
    }
    for (uint32_t i = 0; i < other->c.faces.issued; i++) {
        if (he_face_is_live(other, (he_face){i})) {
            at->face[i] = out->faces.ids[out->faces.count++] = he_new_face(m).i;
        }
    }
}

static he_halfedge moved(const maps *at, he_halfedge h)
{
    return h.i == HE_NONE ? h : (he_halfedge){2 * at->edge[h.i >> 1] + (h.i & 1)};
}

static void link_rows(he_mesh *m, const he_mesh *other, const maps *at)
{
    for (uint32_t i = 0; i < other->c.vertices.issued; i++) {
        if (he_vertex_is_live(other, (he_vertex){i})) {
            he_set_vertex_halfedge(m, (he_vertex){at->vertex[i]},
                                   moved(at, he_vertex_halfedge(other, (he_vertex){i})));
        }
    }
    for (uint32_t i = 0; i < 2 * other->c.edges.issued; i++) {
        he_halfedge h = {i}, to;
        if (!he_edge_is_live(other, he_edge_of(h))) {
            continue;
        }
        he_face f = he_face_of(other, h);
        to = moved(at, h);
        he_set_next(m, to, moved(at, he_next(other, h)));
        he_set_prev(m, to, moved(at, he_prev(other, h)));
        he_set_origin(m, to, (he_vertex){at->vertex[he_origin(other, h).i]});
        he_set_face(m, to, f.i == HE_NONE ? f : (he_face){at->face[f.i]});
    }
    for (uint32_t i = 0; i < other->c.faces.issued; i++) {
        if (he_face_is_live(other, (he_face){i})) {
            he_set_face_halfedge(m, (he_face){at->face[i]},
                                 moved(at, he_face_halfedge(other, (he_face){i})));
        }
    }
}

static void carry_column(he_mesh *m, const he_mesh *other, const he_column *theirs,
                         const target *to, const maps *at)
{
    he_kind kind = theirs->domain;
    const uint32_t *map = map_of(at, kind);
    uint32_t issued = he_mesh_issued(other, kind);
    for (uint32_t i = 0; i < issued; i++) {
        if (he_mesh_is_live(other, kind, i)) {
            uint32_t row = kind == HE_HALFEDGE ? 2 * map[i >> 1] + (i & 1) : map[i];
            carry_row(m, theirs, to, i, row);
        }
    }
}

static he_status append_in_bracket(he_mesh *m, const he_mesh *other, target *targets,
                                   const maps *at, he_appended *out, he_error *err)
{
    renames r = {.from = NULL};
    he_status status = he_progress_phase(m->progress, "matching attributes", 0.2, err);
    if (status == HE_OK) {
        status = merge_materials(m, other, &r, err);
    }
    for (size_t i = 0; status == HE_OK && i < other->c.column_count; i++) {
        if (other->c.columns[i] != NULL) {
            status = match_column(m, other->c.columns[i], &r, &targets[i], err);
        }
    }
    renames_clear(&r);
    const he_reservation need = {.vertices = other->c.vertices.live,
                                 .edges = other->c.edges.live,
                                 .faces = other->c.faces.live};
    if (status == HE_OK) {
        status = he_reserve(m, need, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "appending", 1, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    make_rows(m, other, at, out);
    link_rows(m, other, at);
    for (size_t i = 0; i < other->c.column_count; i++) {
        const he_column *theirs = other->c.columns[i];
        if (theirs != NULL && theirs->domain != HE_MESH_KIND) {
            carry_column(m, other, theirs, &targets[i], at);
        }
        he_progress_note(m->progress, i, other->c.column_count);
    }
    return HE_OK;
}

static he_status make_room(const he_mesh *other, maps *at, target **targets, he_appended *out,
                           he_error *err)
{
    size_t columns = other->c.column_count;
    at->vertex = he_mem_array(NULL, other->c.vertices.issued + 1u, sizeof *at->vertex);
    at->edge = he_mem_array(NULL, other->c.edges.issued + 1u, sizeof *at->edge);
    at->face = he_mem_array(NULL, other->c.faces.issued + 1u, sizeof *at->face);
    *targets = he_mem_zero(columns + 1, sizeof **targets);
    if (at->vertex == NULL || at->edge == NULL || at->face == NULL || *targets == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to append another mesh");
    }
    he_status status = he_ids_reserve(&out->vertices, other->c.vertices.live, err);
    if (status == HE_OK) {
        status = he_ids_reserve(&out->edges, other->c.edges.live, err);
    }
    return status == HE_OK ? he_ids_reserve(&out->faces, other->c.faces.live, err) : status;
}

he_status he_append(he_mesh *m, const he_mesh *other, he_appended *out, he_error *err)
{
    assert(m != other);
    maps at = {NULL, NULL, NULL};
    target *targets = NULL;
    he_appended made = {.vertices = {0}};
    he_bracket bracket;
    he_status status = check_columns(m, other, err);
    if (status == HE_OK) {
        status = make_room(other, &at, &targets, &made, err);
    }
    if (status == HE_OK) {
        status = he_edit_begin(m, &bracket, err);
        if (status == HE_OK) {
            status = append_in_bracket(m, other, targets, &at, &made, err);
            status = he_edit_end(m, &bracket, status);
        }
    }
    if (status == HE_OK && out != NULL) {
        *out = made;
        made = (he_appended){.vertices = {0}};
    }
    he_appended_clear(&made);
    for (size_t i = 0; targets != NULL && i < other->c.column_count; i++) {
        he_mem_free(targets[i].label);
    }
    he_mem_free(targets);
    he_mem_free(at.vertex);
    he_mem_free(at.edge);
    he_mem_free(at.face);
    return status;
}
