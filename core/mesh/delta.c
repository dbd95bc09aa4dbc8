#include "mesh/delta.h"

#include "mesh/content.h"

#include <string.h>

he_delta *he_delta_new(void)
{
    return he_mem_zero(1, sizeof(he_delta));
}

/* Objects from `from` on are what the mesh does not hold at this moment. */
static void free_objects(he_delta *d, size_t from)
{
    for (size_t i = 0; i < d->count; i++) {
        const he_record *r = &d->records[i];
        bool column = r->column == HE_COL_COLUMN_ADDED || r->column == HE_COL_COLUMN_DROPPED;
        if ((!column && r->column != HE_COL_REPLACED) || r->before < from) {
            continue;
        }
        if (column) {
            he_column_free(d->objects[r->before]);
        } else {
            he_content *content = d->objects[r->before];
            he_content_clear(content);
            he_mem_free(content);
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
        sizeof *d + d->capacity * sizeof *d->records + d->object_capacity * sizeof *d->objects;
    if (d->object_count == 0) {
        return bytes;
    }
    for (size_t i = 0; i < d->count; i++) {
        const he_record *r = &d->records[i];
        if (r->column == HE_COL_REPLACED) {
            bytes += he_content_bytes(d->objects[r->before]);
        } else if ((r->column == HE_COL_COLUMN_ADDED || r->column == HE_COL_COLUMN_DROPPED) &&
                   d->objects[r->before] != NULL) {
            bytes += he_column_bytes(d->objects[r->before]);
        }
    }
    return bytes;
}

void he_delta_trim(he_delta *d)
{
    if (d->count < d->capacity) {
        void *records = he_mem_array(d->records, d->count, sizeof *d->records);
        if (records != NULL) {
            d->records = records;
            d->capacity = d->count;
        }
    }
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

/* Live rows are counted by the words that turn from dead to alive and back. */
static void put_liveness(he_rows *table, uint32_t before, uint32_t after)
{
    table->live += (uint32_t)(before == HE_DEAD) - (uint32_t)(after == HE_DEAD);
}

static void put_row_word(unsigned char *row, size_t row_bytes, size_t word, uint32_t value)
{
    size_t rest = row_bytes - 4 * word;
    memcpy(row + 4 * word, &value, rest < 4 ? rest : 4);
}

static void put_attribute(he_content *c, const he_record *r, uint32_t value)
{
    he_column *column = c->columns[r->column - HE_COL_ATTRIBUTE];
    put_row_word(he_column_row(column, r->row), column->row_bytes, r->word, value);
}

static void swap_column(he_delta *d, he_content *c, const he_record *r)
{
    he_column *other = d->objects[r->before];
    d->objects[r->before] = c->columns[r->row];
    c->columns[r->row] = other;
}

static void swap_content(he_delta *d, he_content *c, const he_record *r)
{
    he_content *other = d->objects[r->before];
    he_content here = *c;
    *c = *other;
    *other = here;
}

/* Bring one record's place from `before` to `after`. */
static void apply(he_delta *d, he_content *c, const he_record *r, uint32_t before, uint32_t after)
{
    switch ((he_col)r->column) {
    case HE_COL_NEXT:
        if ((r->row & 1u) == 0) {
            put_liveness(&c->edges, before, after);
        }
        c->next[r->row] = after;
        return;
    case HE_COL_PREV:
        c->prev[r->row] = after;
        return;
    case HE_COL_ORIGIN:
        c->origin[r->row] = after;
        return;
    case HE_COL_FACE:
        c->boundary_halfedges += (uint32_t)(after == HE_NONE) - (uint32_t)(before == HE_NONE);
        c->face[r->row] = after;
        return;
    case HE_COL_VERTEX_HALFEDGE:
        put_liveness(&c->vertices, before, after);
        c->vertex_halfedge[r->row] = after;
        return;
    case HE_COL_FACE_HALFEDGE:
        put_liveness(&c->faces, before, after);
        c->face_halfedge[r->row] = after;
        return;
    case HE_COL_POSITION:
        put_row_word((unsigned char *)&c->position[r->row], sizeof(he_vec3), r->word, after);
        return;
    case HE_COL_PARENT:
    case HE_COL_MERGED:
        return;
    case HE_COL_COLUMN_ADDED:
    case HE_COL_COLUMN_DROPPED:
        swap_column(d, c, r);
        return;
    case HE_COL_REPLACED:
        swap_content(d, c, r);
        return;
    case HE_COL_ATTRIBUTE:
        break;
    }
    put_attribute(c, r, after);
}

static void undo_to(he_delta *d, he_mesh *mesh, size_t to)
{
    for (size_t i = d->count; i > to; i--) {
        const he_record *r = &d->records[i - 1];
        apply(d, &mesh->c, r, r->after, r->before);
    }
}

void he_delta_undo(he_delta *delta, he_mesh *mesh)
{
    undo_to(delta, mesh, 0);
}

void he_delta_redo(he_delta *delta, he_mesh *mesh)
{
    for (size_t i = 0; i < delta->count; i++) {
        const he_record *r = &delta->records[i];
        apply(delta, &mesh->c, r, r->before, r->after);
    }
}

/* Issue dead rows up to the marks. */
static he_status issue_to(he_content *c, const uint32_t issued[HE_KIND_COUNT], he_error *err)
{
    he_status status = he_content_reserve_vertices(c, issued[HE_VERTEX], err);
    if (status == HE_OK) {
        status = he_content_reserve_edges(c, issued[HE_EDGE], err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(c, issued[HE_FACE], err);
    }
    if (status != HE_OK) {
        return status;
    }
    for (; c->vertices.issued < issued[HE_VERTEX]; c->vertices.issued++) {
        he_content_clear_vertex(c, c->vertices.issued);
    }
    for (; c->edges.issued < issued[HE_EDGE]; c->edges.issued++) {
        he_content_clear_edge(c, c->edges.issued);
    }
    for (; c->faces.issued < issued[HE_FACE]; c->faces.issued++) {
        he_content_clear_face(c, c->faces.issued);
    }
    for (size_t i = 0; i < c->column_count && status == HE_OK; i++) {
        he_column *column = c->columns[i];
        size_t rows = column == NULL ? 0 : he_content_issued(c, column->domain);
        if (column != NULL && column->rows < rows) {
            status = he_column_extend(column, rows - column->rows, err);
        }
    }
    return status;
}

he_status he_delta_replay(const he_delta *delta, he_mesh *copy,
                          const uint32_t issued[HE_KIND_COUNT], bool undo, he_error *err)
{
    if (delta->object_count > 0) {
        return he_fail_plain(err, HE_UNSUPPORTED, "the delta changes more than rows");
    }
    he_status status = issue_to(&copy->c, issued, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t i = 0; i < delta->count; i++) {
        const he_record *r = &delta->records[undo ? delta->count - 1 - i : i];
        uint32_t before = undo ? r->after : r->before, after = undo ? r->before : r->after;
        apply(NULL, &copy->c, r, before, after);
    }
    return HE_OK;
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
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        he_content_rows(&mesh->c, tables[i])->issued = to.issued[tables[i]];
    }
    for (size_t i = 0; i < mesh->c.column_count; i++) {
        he_column *column = mesh->c.columns[i];
        size_t rows = column == NULL ? 0 : he_content_issued(&mesh->c, column->domain);
        if (column != NULL && column->rows > rows) {
            column->rows = rows;
        }
    }
}
