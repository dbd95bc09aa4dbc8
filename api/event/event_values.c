#include "api/event/event_values.h"

#include "api/json/attribute_value.h"
#include "api/json/material_value.h"
#include "mesh/column.h"
#include "mesh/walk.h"

#include <string.h>

/* What a delta changed in one attribute slot of a mesh, which is the place of one attribute column.
 * If a column replaced another column, `dropped` and `added` are both set. */
typedef struct slot {
    /* Indices of the values that the delta changed; in an added column, of those that are not the
     * default. */
    he_ids rows;
    const he_column *dropped; /* the column that the delta removed, else NULL */
    bool added;               /* true if the delta added the column that is now in the slot */
} slot;

typedef struct touched {
    he_ids vertices, halfedges, faces;
    slot *slots;
    size_t slot_count;
    bool materials; /* true if the delta changed the list of materials */
} touched;

static void touched_clear(touched *t)
{
    he_ids_clear(&t->vertices);
    he_ids_clear(&t->halfedges);
    he_ids_clear(&t->faces);
    for (size_t i = 0; i < t->slot_count; i++) {
        he_ids_clear(&t->slots[i].rows);
    }
    he_mem_free(t->slots);
}

static void note_column(touched *t, const he_delta *delta, const he_record *r, bool undone)
{
    slot *s = &t->slots[r->row];
    bool adds = (r->column == HE_COL_COLUMN_ADDED) != undone;
    if (!adds && !s->added) {
        s->dropped = delta->objects[r->before];
    }
    s->added = adds;
}

static he_status note_record(touched *t, const he_delta *delta, const he_record *r, bool undone,
                             he_error *err)
{
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
    case HE_COL_PREV:
    case HE_COL_ORIGIN:
    case HE_COL_FACE:
        return he_ids_add(&t->halfedges, r->row, err);
    case HE_COL_VERTEX_HALFEDGE:
    case HE_COL_POSITION:
        return he_ids_add(&t->vertices, r->row, err);
    case HE_COL_FACE_HALFEDGE:
        return he_ids_add(&t->faces, r->row, err);
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
        note_column(t, delta, r, undone);
        return HE_OK;
    case HE_COL_MATERIAL:
        t->materials = true;
        return HE_OK;
    case HE_COL_PARENT:
    case HE_COL_MERGED:
    case HE_COL_POSITIONS: /* such events are stale (events.c) */
    case HE_COL_REPLACED:
        return HE_OK;
    case HE_COL_ATTRIBUTE:
        break;
    }
    return he_ids_add(&t->slots[r->column - HE_COL_ATTRIBUTE].rows, r->row, err);
}

static bool is_live(const he_mesh *mesh, he_kind domain, uint32_t row)
{
    switch (domain) {
    case HE_HALFEDGE:
        return he_mesh_is_live(mesh, HE_EDGE, row >> 1);
    case HE_MESH_KIND:
        return true;
    case HE_VERTEX:
    case HE_EDGE:
    case HE_FACE:
        return he_mesh_is_live(mesh, domain, row);
    case HE_KIND_COUNT:
        break;
    }
    return false;
}

static he_status note_all_rows(slot *s, const he_column *column, he_error *err)
{
    he_status status = HE_OK;
    for (size_t row = 0; row < column->rows && status == HE_OK; row++) {
        if (memcmp(he_column_value(column, row), column->fallback, column->row_bytes) != 0) {
            status = he_ids_add(&s->rows, (uint32_t)row, err);
        }
    }
    return status;
}

static he_status find_touched(touched *t, const he_mesh *mesh, const he_delta *delta, bool undone,
                              he_error *err)
{
    he_status status = HE_OK;
    t->slot_count = he_mesh_columns(mesh);
    t->slots = he_mem_zero(t->slot_count + 1, sizeof *t->slots);
    if (t->slots == NULL) {
        t->slot_count = 0;
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to list changes");
    }
    for (size_t i = 0; i < delta->count && status == HE_OK; i++) {
        size_t at = undone ? delta->count - 1 - i : i;
        status = note_record(t, delta, &delta->records[at], undone, err);
    }
    for (size_t i = 0; i < t->slot_count && status == HE_OK; i++) {
        const he_column *column = he_mesh_column(mesh, i);
        if (t->slots[i].added) {
            t->slots[i].rows.count = 0;
            status = note_all_rows(&t->slots[i], column, err);
        } else if (column != NULL) {
            status = he_ids_sort(&t->slots[i].rows, err);
        }
    }
    if (status == HE_OK) {
        status = he_ids_sort(&t->vertices, err);
    }
    if (status == HE_OK) {
        status = he_ids_sort(&t->halfedges, err);
    }
    return status == HE_OK ? he_ids_sort(&t->faces, err) : status;
}

/* --- writing, which stops early when the text has reached its maximum --- */

static void write_vertices(api_out *out, const he_mesh *mesh, const he_ids *rows)
{
    api_out_key(out, "vertices");
    api_out_array_begin(out);
    for (size_t i = 0; i < rows->count && !out->text->failed; i++) {
        he_vertex v = {rows->ids[i]};
        if (!he_vertex_is_live(mesh, v)) {
            continue;
        }
        he_vec3 p = he_position(mesh, v);
        api_out_array_begin(out);
        api_out_id(out, v.i);
        api_out_number(out, p.x);
        api_out_number(out, p.y);
        api_out_number(out, p.z);
        api_out_id(out, he_vertex_halfedge(mesh, v).i);
        api_out_array_end(out);
    }
    api_out_array_end(out);
}

static void write_halfedges(api_out *out, const he_mesh *mesh, const he_ids *rows)
{
    api_out_key(out, "halfedges");
    api_out_array_begin(out);
    for (size_t i = 0; i < rows->count && !out->text->failed; i++) {
        he_halfedge h = {rows->ids[i]};
        if (!he_edge_is_live(mesh, he_edge_of(h))) {
            continue;
        }
        const uint32_t row[] = {h.i, he_next(mesh, h).i, he_prev(mesh, h).i, he_origin(mesh, h).i,
                                he_face_of(mesh, h).i};
        api_out_array_begin(out);
        for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
            api_out_id(out, row[k]);
        }
        api_out_array_end(out);
    }
    api_out_array_end(out);
}

static void write_faces(api_out *out, const he_mesh *mesh, const he_ids *rows)
{
    api_out_key(out, "faces");
    api_out_array_begin(out);
    for (size_t i = 0; i < rows->count && !out->text->failed; i++) {
        he_face f = {rows->ids[i]};
        if (he_face_is_live(mesh, f)) {
            api_out_array_begin(out);
            api_out_id(out, f.i);
            api_out_id(out, he_face_halfedge(mesh, f).i);
            api_out_array_end(out);
        }
    }
    api_out_array_end(out);
}

static void write_rows(api_out *out, const he_mesh *mesh, const he_column *column,
                       const he_ids *rows)
{
    api_out_key(out, column->name);
    api_out_array_begin(out);
    for (size_t i = 0; i < rows->count && !out->text->failed; i++) {
        uint32_t row = rows->ids[i];
        if (is_live(mesh, column->domain, row)) {
            api_out_array_begin(out);
            api_out_id(out, row);
            api_write_components(out, column, he_column_value(column, row));
            api_out_array_end(out);
        }
    }
    api_out_array_end(out);
}

static bool is_written(const touched *t, const he_mesh *mesh, size_t i, he_kind domain)
{
    const he_column *column = he_mesh_column(mesh, i);
    return column != NULL && column->domain == domain && t->slots[i].rows.count > 0;
}

static void write_attributes(api_out *out, const he_mesh *mesh, const touched *t)
{
    api_out_key(out, "attributes");
    api_out_object_begin(out);
    for (he_kind domain = HE_VERTEX; domain < HE_KIND_COUNT; domain++) {
        bool open = false;
        for (size_t i = 0; i < t->slot_count; i++) {
            if (!is_written(t, mesh, i, domain)) {
                continue;
            }
            if (!open) {
                api_out_key(out, he_kind_plural(domain));
                api_out_object_begin(out);
                open = true;
            }
            write_rows(out, mesh, he_mesh_column(mesh, i), &t->slots[i].rows);
        }
        if (open) {
            api_out_object_end(out);
        }
    }
    api_out_object_end(out);
}

static void write_columns_dropped(api_out *out, const he_mesh *mesh, const touched *t)
{
    bool open = false;
    for (size_t i = 0; i < t->slot_count; i++) {
        if (t->slots[i].dropped == NULL) {
            continue;
        }
        if (!open) {
            api_out_key(out, "attributes_dropped");
            api_out_array_begin(out);
            open = true;
        }
        const api_shown_column shown = api_show_column(mesh, t->slots[i].dropped);
        api_record_write(out, &api_attribute_read_record, &shown);
    }
    if (open) {
        api_out_array_end(out);
    }
}

static void write_columns_added(api_out *out, const he_mesh *mesh, const touched *t)
{
    bool open = false;
    for (size_t i = 0; i < t->slot_count; i++) {
        if (!t->slots[i].added) {
            continue;
        }
        if (!open) {
            api_out_key(out, "attributes_added");
            api_out_array_begin(out);
            open = true;
        }
        const api_shown_column shown = api_show_column(mesh, he_mesh_column(mesh, i));
        api_record_write(out, &api_attribute_added_record, &shown);
    }
    if (open) {
        api_out_array_end(out);
    }
}

he_status api_write_values(api_out *out, const he_mesh *mesh, const he_delta *delta, bool undone,
                           he_error *err)
{
    touched t = {0};
    he_status status = find_touched(&t, mesh, delta, undone, err);
    if (status == HE_OK) {
        /* Dropped columns are written first, because an added column may have the same name. */
        write_columns_dropped(out, mesh, &t);
        write_columns_added(out, mesh, &t);
        if (t.materials) {
            api_out_key(out, "materials");
            api_write_materials(out, he_mesh_materials(mesh));
        }
        api_out_key(out, "values");
        api_out_object_begin(out);
        write_vertices(out, mesh, &t.vertices);
        write_halfedges(out, mesh, &t.halfedges);
        write_faces(out, mesh, &t.faces);
        write_attributes(out, mesh, &t);
        api_out_object_end(out);
    }
    touched_clear(&t);
    return status;
}
