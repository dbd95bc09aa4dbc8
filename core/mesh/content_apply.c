/* content_apply.c - applies the records of a delta (the log of an edit) to a content (the struct of
 * all arrays of a mesh), and issues or withdraws ids: he_content_apply, he_content_issue and
 * he_content_withdraw of content.h. */
#include "mesh/content.h"

#include "mesh/write.h"

#include <assert.h>
#include <string.h>

/* Updates the number of live elements after a link of an element has changed from `before` to
 * `after`. The links of a deleted element are HE_DEAD. */
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

static void swap_column(void **objects, he_content *c, const he_record *r)
{
    assert(r->row < c->column_count);
    he_column *other = objects[r->before];
    objects[r->before] = c->columns[r->row];
    c->columns[r->row] = other;
}

static void swap_material(void **objects, he_content *c, const he_record *r)
{
    assert(r->row < c->materials.count);
    he_material *other = objects[r->before];
    objects[r->before] = c->materials.rows[r->row];
    c->materials.rows[r->row] = other;
}

void he_content_exchange_positions(he_content *c, he_column *other)
{
    he_vec3 block[256];
    assert(other->rows <= c->vertices.issued);
    for (size_t i = 0; i < other->rows; i += sizeof block / sizeof *block) {
        const size_t left = other->rows - i, most = sizeof block / sizeof *block;
        const size_t bytes = (left < most ? left : most) * sizeof *block;
        memcpy(block, he_column_row(other, i), bytes);
        memcpy(he_column_row(other, i), &c->position[i], bytes);
        memcpy(&c->position[i], block, bytes);
    }
}

static void swap_content(void **objects, he_content *c, const he_record *r)
{
    he_content *other = objects[r->before];
    he_content here = *c;
    *c = *other;
    *other = here;
}

/* Applies one record of a delta to the mesh data `c`: changes a 32-bit word from `before` to
 * `after`, or exchanges an attribute column, a material, positions or all mesh data with the object
 * that the record names in the array `objects`. */
static void apply(void **objects, he_content *c, const he_record *r, uint32_t before,
                  uint32_t after)
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
        swap_column(objects, c, r);
        return;
    case HE_COL_MATERIAL:
        swap_material(objects, c, r);
        return;
    case HE_COL_POSITIONS:
        he_content_exchange_positions(c, objects[r->before]);
        return;
    case HE_COL_REPLACED:
        swap_content(objects, c, r);
        return;
    case HE_COL_ATTRIBUTE:
        break;
    }
    put_attribute(c, r, after);
}

void he_content_apply(he_content *c, const he_delta *delta, size_t from, size_t to, void **objects)
{
    for (size_t i = from; i < to; i++) {
        const he_record *r = &delta->records[i];
        apply(objects, c, r, r->before, r->after);
    }
    for (size_t i = from; i > to; i--) {
        const he_record *r = &delta->records[i - 1];
        apply(objects, c, r, r->after, r->before);
    }
}

he_status he_content_issue(he_content *c, const uint32_t issued[HE_KIND_COUNT], he_error *err)
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
        he_clear_vertex(c, c->vertices.issued);
    }
    for (; c->edges.issued < issued[HE_EDGE]; c->edges.issued++) {
        he_clear_edge(c, c->edges.issued);
    }
    for (; c->faces.issued < issued[HE_FACE]; c->faces.issued++) {
        he_clear_face(c, c->faces.issued);
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

void he_content_withdraw(he_content *c, const uint32_t issued[HE_KIND_COUNT])
{
    static const he_kind tables[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        he_content_rows(c, tables[i])->issued = issued[tables[i]];
    }
    for (size_t i = 0; i < c->column_count; i++) {
        he_column *column = c->columns[i];
        size_t rows = column == NULL ? 0 : he_content_issued(c, column->domain);
        if (column != NULL && column->rows > rows) {
            column->rows = rows;
        }
    }
}
