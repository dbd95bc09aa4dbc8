/* content_forward.c - applies a delta (the log of an edit) to a content (the struct of all arrays
 * of a mesh) in which the ids of the edit's new elements are not issued yet: he_content_forward of
 * content.h. */
#include "mesh/content.h"
#include "mesh/delta.h"

#include <string.h>

/* Successive records of a delta (the log of an edit), from index `from` to `to` - 1, none of which
 * replaces all data of the mesh. Record `to`, if it exists, replaces all data of the mesh. */
typedef struct span {
    size_t from, to;
} span;

static span span_from(const he_delta *delta, size_t from)
{
    span s = {from, from};
    while (s.to < delta->count && delta->records[s.to].column != HE_COL_REPLACED) {
        s.to++;
    }
    return s;
}

static void raise(uint32_t *mark, uint32_t row)
{
    *mark = *mark <= row ? row + 1 : *mark;
}

/* Computes how many ids of each kind of element are issued after the records of a span were
 * applied. An edit writes the links of every element that it makes, so the highest id whose links
 * are written is the last id issued. */
static void marks_after(const he_content *c, const he_delta *delta, span s,
                        uint32_t marks[HE_KIND_COUNT])
{
    marks[HE_VERTEX] = c->vertices.issued;
    marks[HE_EDGE] = c->edges.issued;
    marks[HE_FACE] = c->faces.issued;
    for (size_t i = s.from; i < s.to; i++) {
        const he_record *r = &delta->records[i];
        if (r->column == HE_COL_NEXT) {
            raise(&marks[HE_EDGE], r->row >> 1);
        } else if (r->column == HE_COL_VERTEX_HALFEDGE) {
            raise(&marks[HE_VERTEX], r->row);
        } else if (r->column == HE_COL_FACE_HALFEDGE) {
            raise(&marks[HE_FACE], r->row);
        }
    }
}

/* Refuses record i of the delta; `why` is a sentence. */
static he_status refuse(size_t i, size_t *refused, const char *why, he_error *err)
{
    if (refused != NULL) {
        *refused = i;
    }
    return he_fail_plain(err, HE_CORRUPT, "change %zu cannot be applied: %s", i, why);
}

/* Adds a free entry at the end of the array of attribute columns. */
static he_status add_slot(he_content *c, he_error *err)
{
    if (c->column_count == c->column_capacity) {
        size_t capacity = he_mem_grown(c->column_capacity, c->column_count + 1);
        he_column **columns = he_mem_array(c->columns, capacity, sizeof(he_column *));
        if (columns == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for another attribute");
        }
        c->columns = columns;
        c->column_capacity = capacity;
    }
    c->columns[c->column_count++] = NULL;
    return HE_OK;
}

/* Prepares the mesh data for record i, which adds an attribute column: makes an entry in the array
 * of columns, and extends the new column so that it has a value for each element of its domain. */
static he_status ready_column(he_content *c, const he_delta *delta, size_t i, void **objects,
                              size_t *refused, he_error *err)
{
    const he_record *r = &delta->records[i];
    he_column *column = objects[r->before];
    he_status status = HE_OK;
    if (column == NULL) {
        return refuse(i, refused,
                      "the stored edit does not hold the attribute that the change adds", err);
    }
    if (r->row > c->column_count) {
        return refuse(
            i, refused,
            "the attribute that the change adds would get a slot after the first free one", err);
    }
    size_t rows = he_content_issued(c, column->domain);
    if (column->rows < rows) {
        status = he_column_extend(column, rows - column->rows, err);
    }
    return status == HE_OK && r->row == c->column_count ? add_slot(c, err) : status;
}

/* Makes an entry in the table of materials for the material that record i of a delta adds. */
static he_status ready_material(he_content *c, const he_delta *delta, size_t i, size_t *refused,
                                he_error *err)
{
    uint32_t slot = delta->records[i].row;
    if (slot > c->materials.count || slot >= HE_MATERIALS) {
        return refuse(i, refused,
                      "the material that the change sets would get a slot that is out of range or "
                      "after the first free one",
                      err);
    }
    if (slot < c->materials.count) {
        return HE_OK;
    }
    he_status status = he_materials_reserve(&c->materials, slot + 1u, err);
    if (status == HE_OK) {
        c->materials.rows[c->materials.count++] = NULL;
    }
    return status;
}

/* Makes entries in the arrays of attribute columns and of materials for everything that the records
 * of a span add. */
static he_status ready_slots(he_content *c, const he_delta *delta, span s, void **objects,
                             size_t *refused, he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = s.from; i < s.to && status == HE_OK; i++) {
        if (delta->records[i].column == HE_COL_COLUMN_ADDED) {
            status = ready_column(c, delta, i, objects, refused, err);
        } else if (delta->records[i].column == HE_COL_MATERIAL) {
            status = ready_material(c, delta, i, refused, err);
        }
    }
    return status;
}

/* Allocates all memory that is needed to apply the delta to the mesh data, so that applying the
 * records cannot fail for lack of memory. */
static he_status ready(he_content *c, const he_delta *delta, void **objects,
                       const uint32_t issued[HE_KIND_COUNT], size_t *refused, he_error *err)
{
    he_status status = HE_OK;
    for (span s = span_from(delta, 0); status == HE_OK; s = span_from(delta, s.to + 1)) {
        uint32_t marks[HE_KIND_COUNT];
        bool last = s.to == delta->count;
        if (!last) {
            marks_after(c, delta, s, marks);
        }
        status = he_content_issue(c, last ? issued : marks, err);
        if (status == HE_OK && delta->object_count > 0) {
            status = ready_slots(c, delta, s, objects, refused, err);
        }
        if (last) {
            break;
        }
        c = objects[delta->records[s.to].before];
    }
    return status;
}

static bool word_is(const void *row, size_t row_bytes, const he_record *r)
{
    uint32_t value = 0;
    size_t at = 4 * (size_t)r->word;
    size_t rest = at < row_bytes ? row_bytes - at : 0;
    if (rest == 0 || (rest < 4 && r->after >> 8 * rest != 0)) {
        return false;
    }
    memcpy(&value, (const unsigned char *)row + at, rest < 4 ? rest : 4);
    return value == r->before;
}

static bool link_is(const uint32_t *links, size_t rows, const he_record *r)
{
    return r->row < rows && links[r->row] == r->before;
}

static bool attribute_is(const he_content *c, const he_record *r)
{
    size_t slot = r->column - HE_COL_ATTRIBUTE;
    const he_column *column = slot < c->column_count ? c->columns[slot] : NULL;
    return column != NULL && r->row < column->rows &&
           word_is(he_column_value(column, r->row), column->row_bytes, r);
}

/* Returns true if `column` can be added as entry `slot` of the array of attribute columns: the
 * entry is unused, and no other column has the name and domain of `column`. */
static bool is_free(const he_content *c, size_t slot, const he_column *column)
{
    for (size_t i = 0; i < c->column_count; i++) {
        const he_column *there = c->columns[i];
        if (there != NULL && there->domain == column->domain &&
            strcmp(there->name, column->name) == 0) {
            return false;
        }
    }
    return c->columns[slot] == NULL;
}

/* Returns true if record r can put the material `comes` into entry r->row of the table of
 * materials: the entry has the material that the record replaces, and no other entry has a material
 * with the name of `comes`. */
static bool material_is(const he_content *c, const he_record *r, const he_material *comes)
{
    const he_material *row = c->materials.rows[r->row];
    size_t slot =
        comes == NULL ? SIZE_MAX : he_materials_find(&c->materials, comes->name, comes->length);
    return (row == NULL ? 0 : row->mark) == r->after && (slot == SIZE_MAX || slot == r->row);
}

/* Returns true if record r can be applied to the mesh data: they have the value, column, material
 * or vertices that the record replaces. */
static bool holds(const he_content *c, void **objects, const he_record *r)
{
    size_t halfedges = 2 * (size_t)c->edges.issued;
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
        return link_is(c->next, halfedges, r);
    case HE_COL_PREV:
        return link_is(c->prev, halfedges, r);
    case HE_COL_ORIGIN:
        return link_is(c->origin, halfedges, r);
    case HE_COL_FACE:
        return link_is(c->face, halfedges, r);
    case HE_COL_VERTEX_HALFEDGE:
        return link_is(c->vertex_halfedge, c->vertices.issued, r);
    case HE_COL_FACE_HALFEDGE:
        return link_is(c->face_halfedge, c->faces.issued, r);
    case HE_COL_POSITION:
        return r->row < c->vertices.issued && word_is(&c->position[r->row], sizeof *c->position, r);
    case HE_COL_PARENT:
    case HE_COL_MERGED:
    case HE_COL_REPLACED:
        return true;
    case HE_COL_COLUMN_ADDED:
        return is_free(c, r->row, objects[r->before]);
    case HE_COL_COLUMN_DROPPED:
        return r->row < c->column_count && c->columns[r->row] != NULL && objects[r->before] == NULL;
    case HE_COL_MATERIAL:
        return material_is(c, r, objects[r->before]);
    case HE_COL_POSITIONS:
        return r->row <= c->vertices.issued;
    case HE_COL_ATTRIBUTE:
        break;
    }
    return attribute_is(c, r);
}

he_status he_content_forward(he_content *c, const he_delta *delta, void **objects,
                             const uint32_t issued[HE_KIND_COUNT], size_t *refused, he_error *err)
{
    const uint32_t marks[HE_KIND_COUNT] = {
        [HE_VERTEX] = c->vertices.issued, [HE_EDGE] = c->edges.issued, [HE_FACE] = c->faces.issued};
    size_t columns = c->column_count, materials = c->materials.count;
    he_status status = ready(c, delta, objects, issued, refused, err);
    for (size_t i = 0; i < delta->count && status == HE_OK; i++) {
        if (!holds(c, objects, &delta->records[i])) {
            he_content_apply(c, delta, i, 0, objects);
            status = refuse(i, refused, "the mesh does not have the value that the change replaces",
                            err);
        } else {
            he_content_apply(c, delta, i, i + 1, objects);
        }
    }
    if (status != HE_OK) {
        c->column_count = columns;
        c->materials.count = materials;
    }
    he_content_withdraw(c, status == HE_OK ? issued : marks);
    return status;
}
