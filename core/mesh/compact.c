#include "mesh/compact.h"

#include "mesh/content.h"
#include "mesh/write.h"

void he_maps_clear(he_maps *maps)
{
    he_mem_free(maps->vertex);
    he_mem_free(maps->edge);
    he_mem_free(maps->face);
    *maps = (he_maps){0};
}

/* Number the live rows of one table. */
static uint32_t *map_rows(const he_mesh *m, he_kind kind)
{
    uint32_t issued = he_mesh_issued(m, kind), fresh = 0;
    uint32_t *map = he_mem_array(NULL, issued, sizeof *map);
    for (uint32_t i = 0; map != NULL && i < issued; i++) {
        map[i] = he_mesh_is_live(m, kind, i) ? fresh++ : HE_NONE;
    }
    return map;
}

static uint32_t map_halfedge(const he_maps *maps, uint32_t h)
{
    return h == HE_NONE ? HE_NONE : 2 * maps->edge[h >> 1] + (h & 1);
}

static he_status move_links(const he_content *from, const he_maps *maps, he_content *to,
                            he_watch *watch, he_error *err)
{
    he_status status = he_watch_phase(watch, "moving vertices", 0.2, err);
    for (uint32_t v = 0; v < from->vertices.issued && status == HE_OK; v++) {
        status = he_watch_at(watch, v, from->vertices.issued, err);
        if (maps->vertex[v] != HE_NONE) {
            to->position[maps->vertex[v]] = from->position[v];
            to->vertex_halfedge[maps->vertex[v]] = map_halfedge(maps, from->vertex_halfedge[v]);
        }
    }
    if (status == HE_OK) {
        status = he_watch_phase(watch, "moving edges", 0.8, err);
    }
    for (uint32_t h = 0; h < 2 * from->edges.issued && status == HE_OK; h++) {
        status = he_watch_at(watch, h, 2 * (uint64_t)from->edges.issued, err);
        if (maps->edge[h >> 1] != HE_NONE) {
            uint32_t fresh = map_halfedge(maps, h), face = from->face[h];
            to->next[fresh] = map_halfedge(maps, from->next[h]);
            to->prev[fresh] = map_halfedge(maps, from->prev[h]);
            to->origin[fresh] = maps->vertex[from->origin[h]];
            to->face[fresh] = face == HE_NONE ? HE_NONE : maps->face[face];
        }
    }
    for (uint32_t f = 0; f < from->faces.issued && status == HE_OK; f++) {
        if (maps->face[f] != HE_NONE) {
            to->face_halfedge[maps->face[f]] = map_halfedge(maps, from->face_halfedge[f]);
        }
    }
    return status;
}

static uint32_t map_row(const he_maps *maps, he_kind domain, size_t row)
{
    switch (domain) {
    case HE_VERTEX:
        return maps->vertex[row];
    case HE_HALFEDGE:
        return maps->edge[row >> 1] == HE_NONE ? HE_NONE : map_halfedge(maps, (uint32_t)row);
    case HE_EDGE:
        return maps->edge[row];
    case HE_FACE:
        return maps->face[row];
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return (uint32_t)row;
}

static he_status move_column(const he_column *from, const he_maps *maps, size_t rows,
                             he_column **out, he_error *err)
{
    he_column *to;
    he_status status = he_column_like(from, rows, &to, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t row = 0; row < from->rows; row++) {
        uint32_t fresh = map_row(maps, from->domain, row);
        if (fresh != HE_NONE) {
            memcpy(he_column_row(to, fresh), he_column_row(from, row), from->row_bytes);
        }
    }
    *out = to;
    return HE_OK;
}

static he_status move_columns(const he_content *from, const he_maps *maps, he_content *to,
                              he_error *err)
{
    if (from->column_count == 0) {
        return HE_OK;
    }
    to->columns = he_mem_zero(from->column_count, sizeof *to->columns);
    if (to->columns == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the attributes");
    }
    to->column_capacity = from->column_count;
    he_status status = HE_OK;
    for (size_t i = 0; i < from->column_count && status == HE_OK; i++) {
        const he_column *column = from->columns[i];
        if (column != NULL) {
            size_t rows = he_content_issued(to, column->domain);
            status = move_column(column, maps, rows, &to->columns[to->column_count], err);
            to->column_count += status == HE_OK;
        }
    }
    return status;
}

he_status he_compact(he_mesh *mesh, he_maps *out, he_error *err)
{
    const he_content *from = &mesh->c;
    he_maps maps = {.vertex = map_rows(mesh, HE_VERTEX),
                    .edge = map_rows(mesh, HE_EDGE),
                    .face = map_rows(mesh, HE_FACE),
                    .vertices = from->vertices.issued,
                    .edges = from->edges.issued,
                    .faces = from->faces.issued};
    he_mesh *fresh = he_mesh_new();
    he_status status = HE_OK;
    if (maps.vertex == NULL || maps.edge == NULL || maps.face == NULL || fresh == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to compact the mesh");
        goto out;
    }
    he_content *to = &fresh->c;
    status = he_content_reserve_vertices(to, from->vertices.live, err);
    if (status == HE_OK) {
        status = he_content_reserve_edges(to, from->edges.live, err);
    }
    if (status == HE_OK) {
        status = he_content_reserve_faces(to, from->faces.live, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    to->vertices.issued = to->vertices.live = from->vertices.live;
    to->edges.issued = to->edges.live = from->edges.live;
    to->faces.issued = to->faces.live = from->faces.live;
    to->boundary_halfedges = from->boundary_halfedges;
    status = move_links(from, &maps, to, mesh->watch, err);
    if (status == HE_OK) {
        status = he_watch_phase(mesh->watch, "moving attributes", 1, err);
    }
    if (status == HE_OK) {
        status = move_columns(from, &maps, to, err);
    }
    if (status == HE_OK) {
        status = he_mesh_replace(mesh, fresh, HE_RENUMBERS, err);
    }
    if (status == HE_OK) {
        fresh = NULL;
        if (out != NULL) {
            *out = maps;
            maps = (he_maps){0};
        }
    }
out:
    he_maps_clear(&maps);
    he_mesh_free(fresh);
    return status;
}
