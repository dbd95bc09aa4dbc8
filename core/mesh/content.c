#include "mesh/content.h"

#include <assert.h>
#include <string.h>

static he_status no_memory(const char *what, size_t rows, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu %s", rows, what);
}

/* Resizes an array to `rows` entries of `size` bytes. `column` is the address of the pointer to the
 * array. If memory is out, the array stays as it is, and the function returns false. */
static bool resize(void *column, size_t rows, size_t size)
{
    void *block;
    memcpy(&block, column, sizeof block);
    block = he_mem_array(block, rows, size);
    if (block == NULL) {
        return false;
    }
    memcpy(column, &block, sizeof block);
    return true;
}

/* Returns the capacity to which the arrays of one kind of element grow so that `rows` elements fit.
 * The first allocation is exact, so a mesh that was just built has no spare memory; he_rows_grown
 * decides the size of later allocations. */
static size_t grown(const he_rows *table, size_t rows)
{
    size_t capacity = table->issued == 0 ? rows : he_rows_grown(table->capacity, rows);
    return capacity > HE_MAX_ROWS ? HE_MAX_ROWS : capacity;
}

he_status he_content_reserve_vertices(he_content *c, size_t rows, he_error *err)
{
    if (rows <= c->vertices.capacity) {
        return HE_OK;
    }
    size_t capacity = grown(&c->vertices, rows);
    if (!resize(&c->position, capacity, sizeof *c->position) ||
        !resize(&c->vertex_halfedge, capacity, sizeof(uint32_t))) {
        return no_memory("vertices", rows, err);
    }
    c->vertices.capacity = (uint32_t)capacity;
    return HE_OK;
}

he_status he_content_reserve_edges(he_content *c, size_t rows, he_error *err)
{
    if (rows <= c->edges.capacity) {
        return HE_OK;
    }
    size_t capacity = grown(&c->edges, rows);
    if (!resize(&c->next, 2 * capacity, sizeof(uint32_t)) ||
        !resize(&c->prev, 2 * capacity, sizeof(uint32_t)) ||
        !resize(&c->origin, 2 * capacity, sizeof(uint32_t)) ||
        !resize(&c->face, 2 * capacity, sizeof(uint32_t))) {
        return no_memory("edges", rows, err);
    }
    c->edges.capacity = (uint32_t)capacity;
    return HE_OK;
}

he_status he_content_reserve_faces(he_content *c, size_t rows, he_error *err)
{
    if (rows <= c->faces.capacity) {
        return HE_OK;
    }
    size_t capacity = grown(&c->faces, rows);
    if (!resize(&c->face_halfedge, capacity, sizeof(uint32_t))) {
        return no_memory("faces", rows, err);
    }
    c->faces.capacity = (uint32_t)capacity;
    return HE_OK;
}

void he_content_clear(he_content *c)
{
    he_mem_free(c->position);
    he_mem_free(c->vertex_halfedge);
    he_mem_free(c->next);
    he_mem_free(c->prev);
    he_mem_free(c->origin);
    he_mem_free(c->face);
    he_mem_free(c->face_halfedge);
    for (size_t i = 0; i < c->column_count; i++) {
        he_column_free(c->columns[i]);
    }
    he_mem_free(c->columns);
    he_materials_clear(&c->materials);
    *c = (he_content){0};
}

/* The number of bytes that are copied between two reports of progress. It is small, so that a copy
 * can be cancelled quickly. */
enum { COPY_BLOCK = 1 << 20 };

/* The progress of copying the arrays of a mesh one after another. */
typedef struct copying {
    he_progress *progress;
    size_t done, bytes; /* number of bytes copied so far, and of all arrays together */
} copying;

static he_status copy_rows(copying *c, void *to, const void *from, size_t rows, size_t size,
                           he_error *err)
{
    he_status status = HE_OK;
    assert(rows == 0 || (to != NULL && from != NULL));
    for (size_t at = 0, left = rows * size; left > 0 && status == HE_OK;) {
        size_t part = left < COPY_BLOCK ? left : COPY_BLOCK;
        memcpy((char *)to + at, (const char *)from + at, part);
        at += part;
        left -= part;
        c->done += part;
        status = he_progress_step(c->progress, c->done, c->bytes, err);
    }
    return status;
}

static he_status copy_links(const he_content *from, he_progress *progress, he_content *to,
                            he_error *err)
{
    size_t v = from->vertices.issued, h = 2 * (size_t)from->edges.issued, f = from->faces.issued;
    size_t word = sizeof(uint32_t);
    copying c = {progress, 0, v * (sizeof *to->position + word) + 4 * h * word + f * word};
    const struct {
        void *to;
        const void *from;
        size_t rows, size;
    } parts[] = {
        {to->position, from->position, v, sizeof *to->position},
        {to->vertex_halfedge, from->vertex_halfedge, v, word},
        {to->next, from->next, h, word},
        {to->prev, from->prev, h, word},
        {to->origin, from->origin, h, word},
        {to->face, from->face, h, word},
        {to->face_halfedge, from->face_halfedge, f, word},
    };
    he_status status = he_progress_phase(progress, "copying", 1, err);
    for (size_t i = 0; i < sizeof parts / sizeof *parts && status == HE_OK; i++) {
        status = copy_rows(&c, parts[i].to, parts[i].from, parts[i].rows, parts[i].size, err);
    }
    return status;
}

static he_status copy_columns(const he_content *from, he_content *to, he_error *err)
{
    if (from->column_count == 0) {
        return HE_OK;
    }
    to->columns = he_mem_zero(from->column_count, sizeof *to->columns);
    if (to->columns == NULL) {
        return no_memory("attributes", from->column_count, err);
    }
    to->column_count = to->column_capacity = from->column_count;
    for (size_t i = 0; i < from->column_count; i++) {
        if (from->columns[i] != NULL) {
            he_status status = he_column_copy(from->columns[i], &to->columns[i], err);
            if (status != HE_OK) {
                return status;
            }
        }
    }
    return HE_OK;
}

he_status he_content_copy(const he_content *from, he_progress *progress, he_content *out,
                          he_error *err)
{
    he_content to = {0};
    size_t v = from->vertices.issued, h = 2 * (size_t)from->edges.issued, f = from->faces.issued;
    he_status status = he_content_reserve_vertices(&to, v, err);
    if (status == HE_OK) {
        status = he_content_reserve_edges(&to, h / 2, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(&to, f, err);
    }
    if (status == HE_OK) {
        status = copy_columns(from, &to, err);
    }
    if (status == HE_OK) {
        status = he_materials_copy(&from->materials, &to.materials, err);
    }
    if (status == HE_OK) {
        status = copy_links(from, progress, &to, err);
    }
    if (status != HE_OK) {
        he_content_clear(&to);
        return status;
    }
    to.vertices.issued = from->vertices.issued;
    to.vertices.live = from->vertices.live;
    to.edges.issued = from->edges.issued;
    to.edges.live = from->edges.live;
    to.faces.issued = from->faces.issued;
    to.faces.live = from->faces.live;
    to.boundary_halfedges = from->boundary_halfedges;
    *out = to;
    return HE_OK;
}

size_t he_content_bytes(const he_content *c)
{
    size_t bytes = c->vertices.capacity * (sizeof *c->position + sizeof(uint32_t)) +
                   c->edges.capacity * (size_t)8 * sizeof(uint32_t) +
                   c->faces.capacity * sizeof(uint32_t) + c->column_capacity * sizeof *c->columns +
                   he_materials_bytes(&c->materials);
    for (size_t i = 0; i < c->column_count; i++) {
        if (c->columns[i] != NULL) {
            bytes += he_column_bytes(c->columns[i]);
        }
    }
    return bytes;
}

size_t he_content_rows_bytes(const he_content *c)
{
    size_t bytes = c->vertices.issued * (sizeof *c->position + sizeof(uint32_t)) +
                   c->edges.issued * (size_t)8 * sizeof(uint32_t) +
                   c->faces.issued * sizeof(uint32_t) + c->column_count * sizeof *c->columns +
                   he_materials_bytes(&c->materials) -
                   (c->materials.capacity - c->materials.count) * sizeof *c->materials.rows;
    for (size_t i = 0; i < c->column_count; i++) {
        if (c->columns[i] != NULL) {
            bytes += he_column_rows_bytes(c->columns[i]);
        }
    }
    return bytes;
}

he_rows *he_content_rows(he_content *c, he_kind kind)
{
    switch (kind) {
    case HE_VERTEX:
        return &c->vertices;
    case HE_HALFEDGE:
    case HE_EDGE:
        return &c->edges;
    case HE_FACE:
        return &c->faces;
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return NULL;
}

size_t he_content_issued(const he_content *c, he_kind domain)
{
    switch (domain) {
    case HE_VERTEX:
        return c->vertices.issued;
    case HE_HALFEDGE:
        return 2 * (size_t)c->edges.issued;
    case HE_EDGE:
        return c->edges.issued;
    case HE_FACE:
        return c->faces.issued;
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 1;
}
