#include "mesh/write.h"

#include "mesh/content.h"

/* Returns the number of 32-bit words that one value of an attribute column takes. The last word may
 * be filled only partly. */
static size_t row_words(const he_column *column)
{
    return (column->row_bytes + 3u) / 4u;
}

static uint32_t word_of(const void *row, size_t row_bytes, size_t word)
{
    uint32_t value = 0;
    size_t rest = row_bytes - 4 * word;
    memcpy(&value, (const unsigned char *)row + 4 * word, rest < 4 ? rest : 4);
    return value;
}

static size_t column_words(const he_mesh *m, he_kind domain)
{
    size_t words = 0;
    for (size_t i = 0; i < m->c.column_count; i++) {
        if (m->c.columns[i] != NULL && m->c.columns[i]->domain == domain) {
            words += row_words(m->c.columns[i]);
        }
    }
    return words;
}

static size_t records_needed(const he_mesh *m, const he_reservation *need)
{
    size_t vertex = column_words(m, HE_VERTEX), face = column_words(m, HE_FACE);
    size_t edge = column_words(m, HE_EDGE) + 2 * column_words(m, HE_HALFEDGE);
    size_t any = vertex + edge + face + column_words(m, HE_MESH_KIND);
    size_t vertices = need->vertices + need->deleted_vertices;
    size_t edges = need->edges + need->deleted_edges;
    size_t faces = need->faces + need->deleted_faces;
    return vertices * (HE_VERTEX_RECORDS + vertex) + edges * (HE_EDGE_RECORDS + edge) +
           faces * (HE_FACE_RECORDS + face) + need->links + need->positions * HE_POSITION_RECORDS +
           need->attributes * any + need->lineage;
}

static he_status reserve_column(he_column *column, size_t issued, size_t extra, he_error *err)
{
    he_status status = he_column_reserve(column, issued + extra, err);
    return status != HE_OK || column->rows >= issued
               ? status
               : he_column_extend(column, issued - column->rows, err);
}

static he_status reserve_columns(he_mesh *m, const he_reservation *need, he_error *err)
{
    const size_t extra[HE_KIND_COUNT] = {
        [HE_VERTEX] = need->vertices,
        [HE_HALFEDGE] = 2 * (size_t)need->edges,
        [HE_EDGE] = need->edges,
        [HE_FACE] = need->faces,
    };
    for (size_t i = 0; i < m->c.column_count; i++) {
        he_column *column = m->c.columns[i];
        if (column != NULL) {
            he_status status = reserve_column(column, he_content_issued(&m->c, column->domain),
                                              extra[column->domain], err);
            if (status != HE_OK) {
                return status;
            }
        }
    }
    return HE_OK;
}

static he_status check_ids(he_kind kind, uint32_t issued, uint32_t extra, he_error *err)
{
    if (extra <= HE_MAX_ROWS - issued) {
        return HE_OK;
    }
    return he_fail_plain(
        err, HE_IDS_EXHAUSTED,
        "%u more %s do not fit: %u of %u ids are used; compact the mesh to free some", extra,
        he_kind_plural(kind), issued, HE_MAX_ROWS);
}

he_status he_reserve_more(he_mesh *m, const he_reservation *need, he_error *err)
{
    he_content *c = &m->c;
    he_status status = check_ids(HE_VERTEX, c->vertices.issued, need->vertices, err);
    if (status == HE_OK) {
        status = check_ids(HE_EDGE, c->edges.issued, need->edges, err);
    }
    if (status == HE_OK) {
        status = check_ids(HE_FACE, c->faces.issued, need->faces, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_vertices(c, (size_t)c->vertices.issued + need->vertices, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_edges(c, (size_t)c->edges.issued + need->edges, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(c, (size_t)c->faces.issued + need->faces, err);
    }
    if (status == HE_OK && c->column_count > 0) {
        status = reserve_columns(m, need, err);
    }
    if (status == HE_OK && m->delta != NULL) {
        status = he_delta_reserve(m->delta, records_needed(m, need), 0, err);
    }
    return status;
}

he_status he_reserve_values(he_mesh *m, size_t slot, size_t rows, he_error *err)
{
    he_column *column = m->c.columns[slot];
    he_status status = reserve_column(column, he_content_issued(&m->c, column->domain), 0, err);
    if (status == HE_OK && m->delta != NULL) {
        status = he_delta_reserve(m->delta, rows * row_words(column), 0, err);
    }
    return status;
}

/* Records the change of each 32-bit word in which the new value of an element differs from the
 * stored value. */
static void record_row(he_mesh *m, uint32_t column, uint32_t row, const void *stored,
                       const void *value, size_t row_bytes)
{
    for (size_t w = 0; 4 * w < row_bytes; w++) {
        uint32_t before = word_of(stored, row_bytes, w), after = word_of(value, row_bytes, w);
        if (before != after) {
            he_record_word(m, column, (uint32_t)w, row, before, after);
        }
    }
}

void he_record_position(he_mesh *m, he_vertex v, he_vec3 position)
{
    record_row(m, HE_COL_POSITION, v.i, &m->c.position[v.i], &position, sizeof position);
}

void he_set_attribute(he_mesh *m, size_t slot, uint32_t row, const void *value)
{
    he_column *column = m->c.columns[slot];
    assert(row < column->rows);
    unsigned char *stored = he_column_row(column, row);
    record_row(m, HE_COL_ATTRIBUTE + (uint32_t)slot, row, stored, value, column->row_bytes);
    memcpy(stored, value, column->row_bytes);
}

void he_issue_values(he_mesh *m)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        he_column *column = m->c.columns[i];
        size_t rows = column == NULL ? 0 : he_content_issued(&m->c, column->domain);
        for (; column != NULL && column->rows < rows; column->rows++) {
            assert(rows <= column->capacity);
            memcpy(he_column_row(column, column->rows), column->fallback, column->row_bytes);
        }
    }
}

static void reset_attributes(he_mesh *m, he_kind domain, uint32_t row)
{
    for (size_t i = 0; i < m->c.column_count; i++) {
        const he_column *column = m->c.columns[i];
        if (column != NULL && column->domain == domain) {
            he_set_attribute(m, i, row, column->fallback);
        }
    }
}

void he_delete_vertex(he_mesh *m, he_vertex v)
{
    he_set_vertex_halfedge(m, v, (he_halfedge){HE_DEAD});
    he_set_position(m, v, (he_vec3){0, 0, 0});
    reset_attributes(m, HE_VERTEX, v.i);
    m->c.vertices.live--;
}

void he_delete_edge(he_mesh *m, he_edge e)
{
    const he_halfedge dead = {HE_DEAD};
    for (unsigned side = 0; side < 2; side++) {
        he_halfedge h = he_edge_halfedge(e, side);
        he_set_halfedge(m, h, dead, dead, (he_vertex){HE_DEAD}, (he_face){HE_DEAD});
        reset_attributes(m, HE_HALFEDGE, h.i);
    }
    reset_attributes(m, HE_EDGE, e.i);
    m->c.edges.live--;
}

void he_delete_face(he_mesh *m, he_face f)
{
    he_set_face_halfedge(m, f, (he_halfedge){HE_DEAD});
    reset_attributes(m, HE_FACE, f.i);
    m->c.faces.live--;
}

/* Returns the index of the first free slot (entry) in the array of attribute columns, or the index
 * after the last slot. */
static size_t free_slot(const he_content *c)
{
    size_t slot = 0;
    while (slot < c->column_count && c->columns[slot] != NULL) {
        slot++;
    }
    return slot;
}

static he_status slot_for_column(he_mesh *m, he_error *err)
{
    he_content *c = &m->c;
    if (free_slot(c) == c->column_capacity) {
        size_t capacity = he_mem_grown(c->column_capacity, c->column_count + 1);
        he_column **columns = he_mem_array(c->columns, capacity, sizeof(he_column *));
        if (columns == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for another attribute");
        }
        c->columns = columns;
        c->column_capacity = capacity;
    }
    return m->delta == NULL ? HE_OK : he_delta_reserve(m->delta, 1, 1, err);
}

/* Records in the delta that an attribute column, a material, all positions or all data of the mesh
 * were added, removed or replaced. `object` is what was taken out of the mesh, which the delta then
 * owns; NULL if nothing was taken out. */
static void record_object(he_mesh *m, uint32_t column, uint32_t row, uint32_t after, void *object)
{
    he_delta *d = m->delta;
    he_record_word(m, column, 0, row, (uint32_t)d->object_count, after);
    d->objects[d->object_count++] = object;
}

he_status he_mesh_add_column(he_mesh *m, he_column *takes, he_error *err)
{
    if (he_mesh_find_column(m, takes->domain, takes->name) != NULL) {
        return he_fail_plain(err, HE_BAD_VALUE, "%s already have an attribute %s",
                             he_kind_plural(takes->domain), takes->name);
    }
    he_status status = slot_for_column(m, err);
    if (status != HE_OK) {
        return status;
    }
    size_t slot = free_slot(&m->c);
    m->c.column_count += slot == m->c.column_count;
    m->c.columns[slot] = takes;
    if (m->delta != NULL) {
        record_object(m, HE_COL_COLUMN_ADDED, (uint32_t)slot, 0, NULL);
    }
    return HE_OK;
}

he_status he_mesh_drop_column(he_mesh *m, size_t slot, he_error *err)
{
    if (m->delta == NULL) {
        he_column_free(m->c.columns[slot]);
        m->c.columns[slot] = NULL;
        return HE_OK;
    }
    he_status status = he_delta_reserve(m->delta, 1, 1, err);
    if (status == HE_OK) {
        record_object(m, HE_COL_COLUMN_DROPPED, (uint32_t)slot, 0, m->c.columns[slot]);
        m->c.columns[slot] = NULL;
    }
    return status;
}

he_status he_mesh_put_material(he_mesh *m, size_t slot, he_material *takes, he_error *err)
{
    he_materials *table = &m->c.materials;
    assert(slot <= table->count);
    he_status status = he_materials_reserve(table, slot + 1, err);
    if (status == HE_OK && m->delta != NULL) {
        status = he_delta_reserve(m->delta, 1, 1, err);
    }
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    if (slot == table->count) {
        table->rows[table->count++] = NULL;
    }
    he_material *before = table->rows[slot];
    table->rows[slot] = takes;
    if (m->delta == NULL) {
        he_material_release(before);
    } else {
        record_object(m, HE_COL_MATERIAL, (uint32_t)slot, before == NULL ? 0 : before->mark,
                      before);
    }
    return HE_OK;
}

he_status he_exchange_positions(he_mesh *m, he_column *takes, he_error *err)
{
    const uint32_t rows = m->c.vertices.issued;
    assert(takes->row_bytes == sizeof *m->c.position && takes->rows == rows);
    he_status status = m->delta == NULL ? HE_OK : he_delta_reserve(m->delta, 1, 1, err);
    if (status != HE_OK) {
        return status;
    }
    /* Nothing below can fail. */
    he_content_exchange_positions(&m->c, takes);
    if (m->delta == NULL) {
        he_column_free(takes);
    } else {
        record_object(m, HE_COL_POSITIONS, rows, 0, takes);
    }
    return HE_OK;
}

he_status he_mesh_replace(he_mesh *m, he_mesh *takes, he_replacing how, he_error *err)
{
    if (m->delta == NULL) {
        he_content_clear(&m->c);
        m->c = takes->c;
        he_mem_free(takes);
        return HE_OK;
    }
    he_content *before = he_mem_alloc(sizeof *before);
    if (before == NULL || he_delta_reserve(m->delta, 1, 1, NULL) != HE_OK) {
        he_mem_free(before);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to replace the mesh");
    }
    *before = m->c;
    m->c = takes->c;
    he_mem_free(takes);
    record_object(m, HE_COL_REPLACED, how == HE_RENUMBERS, 0, before);
    return HE_OK;
}

he_status he_edit_begin(he_mesh *m, he_bracket *out, he_error *err)
{
    he_bracket bracket = {0};
    if (m->delta == NULL) {
        bracket.own = he_delta_new();
        if (bracket.own == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to record the edit");
        }
        he_mesh_record(m, bracket.own);
    }
    bracket.mark = he_delta_mark(m);
    *out = bracket;
    return HE_OK;
}

he_status he_edit_end(he_mesh *m, he_bracket *bracket, he_status status)
{
    if (status != HE_OK && !(status == HE_CANCELLED && m->expendable)) {
        he_delta_rollback(m, bracket->mark);
    }
    if (bracket->own != NULL) {
        he_mesh_record(m, NULL);
        he_delta_free(bracket->own);
        bracket->own = NULL;
    }
    return status;
}
