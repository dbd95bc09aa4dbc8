#include "mesh/mesh.h"

#include "mesh/content.h"
#include "mesh/long_faces.h"
#include "mesh/walk.h"

#include <assert.h>
#include <string.h>

he_mesh *he_mesh_new(void)
{
    return he_mem_zero(1, sizeof(he_mesh));
}

void he_mesh_free(he_mesh *mesh)
{
    if (mesh != NULL) {
        he_content_clear(&mesh->c);
        he_long_faces_clear(mesh);
        he_mem_free(mesh);
    }
}

void he_mesh_set_progress(he_mesh *mesh, he_progress *progress)
{
    mesh->progress = progress;
}

void he_mesh_expend(he_mesh *mesh)
{
    mesh->expendable = true;
}

he_status he_mesh_copy(const he_mesh *mesh, he_mesh **out, he_error *err)
{
    return he_mesh_copy_with_progress(mesh, NULL, out, err);
}

he_status he_mesh_copy_with_progress(const he_mesh *mesh, he_progress *progress, he_mesh **out,
                                     he_error *err)
{
    he_mesh *copy = he_mesh_new();
    if (copy == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to copy the mesh");
    }
    he_status status = he_content_copy(&mesh->c, progress, &copy->c, err);
    if (status != HE_OK) {
        he_mesh_free(copy);
        return status;
    }
    copy->progress = progress;
    *out = copy;
    return HE_OK;
}

size_t he_mesh_bytes(const he_mesh *mesh)
{
    return sizeof *mesh + he_content_bytes(&mesh->c);
}

uint32_t he_mesh_vertices(const he_mesh *mesh)
{
    return mesh->c.vertices.live;
}

uint32_t he_mesh_edges(const he_mesh *mesh)
{
    return mesh->c.edges.live;
}

uint32_t he_mesh_faces(const he_mesh *mesh)
{
    return mesh->c.faces.live;
}

uint32_t he_mesh_boundary_halfedges(const he_mesh *mesh)
{
    return mesh->c.boundary_halfedges;
}

uint32_t he_mesh_count(const he_mesh *mesh, he_kind kind)
{
    switch (kind) {
    case HE_VERTEX:
        return mesh->c.vertices.live;
    case HE_HALFEDGE:
        return 2 * mesh->c.edges.live;
    case HE_EDGE:
        return mesh->c.edges.live;
    case HE_FACE:
        return mesh->c.faces.live;
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return 1;
}

uint32_t he_mesh_issued(const he_mesh *mesh, he_kind kind)
{
    return (uint32_t)he_content_issued(&mesh->c, kind);
}

bool he_mesh_is_live(const he_mesh *mesh, he_kind kind, uint32_t id)
{
    switch (kind) {
    case HE_VERTEX:
        return he_vertex_is_live(mesh, (he_vertex){id});
    case HE_HALFEDGE:
        return he_edge_is_live(mesh, (he_edge){id >> 1});
    case HE_EDGE:
        return he_edge_is_live(mesh, (he_edge){id});
    case HE_FACE:
        return he_face_is_live(mesh, (he_face){id});
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return id == 0;
}

uint32_t he_mesh_next_live(const he_mesh *mesh, he_kind kind, uint64_t from)
{
    uint32_t issued = he_mesh_issued(mesh, kind);
    for (uint64_t id = from; id < issued; id++) {
        if (he_mesh_is_live(mesh, kind, (uint32_t)id)) {
            return (uint32_t)id;
        }
    }
    return HE_NONE;
}

he_status he_mesh_require(const he_mesh *mesh, he_kind kind, uint32_t id, he_error *err)
{
    if (he_mesh_is_live(mesh, kind, id)) {
        return HE_OK;
    }
    uint32_t issued = he_mesh_issued(mesh, kind);
    if (id < issued) {
        return he_fail(err, HE_DELETED_ELEMENT, kind, id, "%s %u was deleted", he_kind_name(kind),
                       id);
    }
    return he_fail(err, HE_NO_SUCH_ELEMENT, kind, id,
                   "there is no %s %u: the mesh has given out %u ids so far", he_kind_name(kind),
                   id, issued);
}

size_t he_mesh_columns(const he_mesh *mesh)
{
    return mesh->c.column_count;
}

const he_column *he_mesh_column(const he_mesh *mesh, size_t i)
{
    return mesh->c.columns[i];
}

const he_column *he_mesh_find_column(const he_mesh *mesh, he_kind domain, const char *name)
{
    for (size_t i = 0; i < mesh->c.column_count; i++) {
        const he_column *column = mesh->c.columns[i];
        if (column != NULL && column->domain == domain && strcmp(column->name, name) == 0) {
            return column;
        }
    }
    return NULL;
}

void he_mesh_position_column(const he_mesh *mesh, he_column *out)
{
    *out = (he_column){.name = "position",
                       .domain = HE_VERTEX,
                       .type = HE_DOUBLE,
                       .rule = HE_INTERPOLATE,
                       .components = 3,
                       .row_bytes = sizeof(he_vec3),
                       .data = (unsigned char *)mesh->c.position,
                       .rows = mesh->c.vertices.issued,
                       .capacity = mesh->c.vertices.issued};
}

size_t he_mesh_column_slot(const he_mesh *mesh, const he_column *column)
{
    size_t slot = 0;
    while (mesh->c.columns[slot] != column) {
        slot++;
        assert(slot < mesh->c.column_count);
    }
    return slot;
}

const he_materials *he_mesh_materials(const he_mesh *mesh)
{
    return &mesh->c.materials;
}

/* Returns true if two attribute columns have equal names, types, rules, defaults and labels, and
 * equal values in every row. A row that only one of the columns stores must have the
 * default value. */
static bool columns_equal(const he_column *a, const he_column *b)
{
    if (a == NULL || b == NULL) {
        return a == b;
    }
    if (!he_column_same_kind(a, b)) {
        return false;
    }
    size_t rows = a->rows > b->rows ? a->rows : b->rows;
    for (size_t i = 0; i < rows; i++) {
        if (memcmp(he_column_value(a, i), he_column_value(b, i), a->row_bytes) != 0) {
            return false;
        }
    }
    return true;
}

static const he_column *slot(const he_content *c, size_t i)
{
    return i < c->column_count ? c->columns[i] : NULL;
}

static bool same(const void *a, const void *b, size_t rows, size_t size)
{
    return rows == 0 || memcmp(a, b, rows * size) == 0;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

bool he_mesh_equal_live(const he_mesh *first, const he_mesh *second)
{
    const he_content *a = &first->c, *b = &second->c;
    if (a->vertices.live != b->vertices.live || a->edges.live != b->edges.live ||
        a->faces.live != b->faces.live || a->boundary_halfedges != b->boundary_halfedges) {
        return false;
    }
    size_t v = smaller(a->vertices.issued, b->vertices.issued);
    size_t h = 2 * smaller(a->edges.issued, b->edges.issued);
    size_t f = smaller(a->faces.issued, b->faces.issued);
    if (!same(a->position, b->position, v, sizeof *a->position) ||
        !same(a->vertex_halfedge, b->vertex_halfedge, v, sizeof(uint32_t)) ||
        !same(a->next, b->next, h, sizeof(uint32_t)) ||
        !same(a->prev, b->prev, h, sizeof(uint32_t)) ||
        !same(a->origin, b->origin, h, sizeof(uint32_t)) ||
        !same(a->face, b->face, h, sizeof(uint32_t)) ||
        !same(a->face_halfedge, b->face_halfedge, f, sizeof(uint32_t))) {
        return false;
    }
    /* The meshes have equally many live elements, and all elements whose ids both meshes have
     * issued are equal. So an element whose id only one of the meshes has issued is deleted. */
    size_t columns = a->column_count > b->column_count ? a->column_count : b->column_count;
    for (size_t i = 0; i < columns; i++) {
        if (!columns_equal(slot(a, i), slot(b, i))) {
            return false;
        }
    }
    return he_materials_equal(&a->materials, &b->materials);
}

bool he_mesh_equal(const he_mesh *a, const he_mesh *b)
{
    return a->c.vertices.issued == b->c.vertices.issued && a->c.edges.issued == b->c.edges.issued &&
           a->c.faces.issued == b->c.faces.issued && he_mesh_equal_live(a, b);
}
