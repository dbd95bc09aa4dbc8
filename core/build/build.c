#include "build/build.h"

#include "build/build_links.h"
#include "build/rest.h"
#include "build/soup_check.h"
#include "mesh/content.h"

#include <stdio.h>
#include <string.h>

void he_defect_text(const he_defect *d, char *text, size_t size)
{
    const char *title = he_status_title(d->reason);
    if (d->kind == HE_VERTEX) {
        snprintf(text, size, "vertex %u: a closed fan of faces shares the vertex with another fan",
                 d->id);
    } else if (d->other != HE_NONE) {
        snprintf(text, size, "face %u, edge %u-%u: %s", d->id, d->vertex, d->other,
                 d->reason == HE_ORIENTATION
                     ? "another face runs along the edge in the same direction"
                     : "two other faces already use the edge");
    } else if (d->vertex != HE_NONE) {
        snprintf(text, size,
                 d->reason == HE_BAD_INDEX ? "face %u, corner %u: there is no vertex %u"
                                           : "face %u, corner %u: the face uses vertex %u twice",
                 d->id, d->corner, d->vertex);
    } else {
        snprintf(text, size, "face %u: %s", d->id, title);
    }
}

he_status he_report_fail(const he_report *report, he_error *err)
{
    const he_defect *first = &report->defects[0];
    char text[HE_ERROR_TEXT];
    he_defect_text(first, text, sizeof text);
    if (report->total == 1) {
        return he_fail(err, first->reason, first->kind, first->id, "%s", text);
    }
    return he_fail(err, first->reason, first->kind, first->id, "%s (and %llu more)", text,
                   (unsigned long long)(report->total - 1));
}

/* Makes a half-edge attribute of the mesh from a corner attribute of the soup. halfedge[c] is the
 * half-edge of corner c. */
static he_status build_corners(const he_column *from, size_t halfedges, const uint32_t *halfedge,
                               size_t corners, he_column **out, he_error *err)
{
    he_column *column;
    he_status status = he_column_like(from, halfedges, &column, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t c = 0; c < from->rows && c < corners; c++) {
        memcpy(he_column_row(column, halfedge[c]), he_column_row(from, c), from->row_bytes);
    }
    *out = column;
    return HE_OK;
}

/* Makes the attributes of the mesh from those of the soup. If `take` is true, columns are moved to
 * the mesh instead of copied. Columns of corners are always copied, because half-edges have other
 * numbers than corners. Columns are moved last, because moving cannot fail. */
static he_status build_columns(he_soup *soup, bool take, const uint32_t *halfedge, he_content *k,
                               he_error *err)
{
    if (soup->column_count == 0) {
        return HE_OK;
    }
    k->columns = he_mem_zero(soup->column_count, sizeof *k->columns);
    if (k->columns == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu attributes", soup->column_count);
    }
    k->column_count = k->column_capacity = soup->column_count;
    for (size_t i = 0; i < soup->column_count; i++) {
        const he_column *column = soup->columns[i];
        he_status status = HE_OK;
        if (column->domain == HE_HALFEDGE) {
            status = build_corners(column, 2 * (size_t)k->edges.issued, halfedge,
                                   soup->corner_count, &k->columns[i], err);
        } else if (!take) {
            status = he_column_copy(column, &k->columns[i], err);
        }
        if (status != HE_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < soup->column_count; i++) {
        if (k->columns[i] == NULL) {
            k->columns[i] = soup->columns[i];
            soup->columns[i] = NULL;
        }
        size_t rows = he_content_issued(k, k->columns[i]->domain);
        if (k->columns[i]->rows > rows) {
            k->columns[i]->rows = rows;
        }
    }
    return HE_OK;
}

/* Makes the vertices of the mesh. If `take` is true, their positions, the largest part of a soup,
 * are moved to the mesh instead of copied. */
static he_status build_vertices(he_soup *soup, bool take, he_content *k, he_error *err)
{
    size_t count = soup->vertex_count;
    if (take && count > 0) {
        he_vec3 *positions = he_mem_array(soup->positions, count, sizeof *positions);
        if (positions != NULL) {
            soup->positions = positions;
            soup->vertex_capacity = count;
        }
    }
    if (!take || soup->vertex_capacity != count) {
        he_status status = he_content_reserve_vertices(k, count, err);
        if (status != HE_OK) {
            return status;
        }
        if (count > 0) {
            memcpy(k->position, soup->positions, count * sizeof *k->position);
        }
    } else {
        k->vertex_halfedge = he_mem_array(NULL, count, sizeof *k->vertex_halfedge);
        if (k->vertex_halfedge == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu vertices", count);
        }
        k->position = soup->positions;
        k->vertices.capacity = (uint32_t)count;
        soup->positions = NULL;
        soup->vertex_count = soup->vertex_capacity = 0;
    }
    k->vertices.issued = k->vertices.live = (uint32_t)count;
    return HE_OK;
}

/* Moves the positions back to the soup if build_vertices had moved them to the mesh. */
static void return_positions(he_soup *soup, he_content *k)
{
    if (soup->positions == NULL && k->position != NULL) {
        soup->positions = k->position;
        soup->vertex_count = soup->vertex_capacity = k->vertices.capacity;
        k->position = NULL;
    }
}

static he_status build_links(he_soup *soup, bool take, const he_corners *corners, he_swings *swings,
                             he_content *k, he_error *err)
{
    /* The array `spare` becomes the array `next` of the mesh. Its memory was written to before, and
     * fresh memory would be slower: the system clears each page when it is first used. */
    k->next = swings->spare;
    swings->spare = NULL;
    he_status status = he_content_reserve_edges(k, swings->edges, err);
    if (status == HE_OK) {
        status = he_content_reserve_faces(k, soup->face_count, err);
    }
    if (status == HE_OK) {
        status = build_vertices(soup, take, k, err);
    }
    if (status == HE_OK) {
        status = he_build_links(corners, swings, k, err);
    }
    return status == HE_OK ? build_columns(soup, take, swings->swing, k, err) : status;
}

/* Finds the swing of each corner, which is the next corner around its vertex (swing.h). If the soup
 * has defects, reports all of them: first invalid faces, then invalid edges and fans. */
static he_status find_swings(const he_soup *soup, he_corners *corners, he_swings *swings,
                             he_report *report, uint64_t *total, he_error *err)
{
    he_status status = he_corners_init(soup, corners, err);
    if (status == HE_OK) {
        status = he_soup_swing(corners, swings, report, total, err);
    }
    return status == HE_OK && *total > 0 ? he_soup_check_rest(soup, report, total, err) : status;
}

he_status he_build_try(const he_soup *soup, uint64_t *defects, he_error *err)
{
    uint64_t total = 0;
    he_corners corners = {0};
    he_swings swings = {0};
    he_status status = find_swings(soup, &corners, &swings, NULL, &total, err);
    he_corners_clear(&corners);
    he_swings_clear(&swings);
    if (status == HE_OK) {
        *defects = total;
    }
    return status;
}

he_status he_build(he_soup *soup, unsigned flags, he_mesh **out, he_report *report, he_error *err)
{
    uint64_t total = 0;
    he_corners corners = {0};
    he_swings swings = {0};
    he_report *own = NULL;
    he_mesh *mesh = he_mesh_new();
    he_status status = HE_OK;
    if (report == NULL) {
        own = he_mem_alloc(sizeof *own);
        report = own;
    }
    if (mesh == NULL || report == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a mesh");
        goto out;
    }
    report->total = 0;
    status = find_swings(soup, &corners, &swings, report, &total, err);
    if (status == HE_OK && total > 0) {
        status = he_report_fail(report, err);
    }
    if (status == HE_OK && swings.edges > HE_MAX_ROWS) {
        status = he_fail_plain(err, HE_IDS_EXHAUSTED,
                               "the mesh would have %zu edges, more than the %u that are possible",
                               swings.edges, HE_MAX_ROWS);
    }
    if (status == HE_OK) {
        status = he_materials_copy(&soup->materials, &mesh->c.materials, err);
    }
    if (status == HE_OK) {
        status = build_links(soup, (flags & HE_BUILD_TAKE) != 0, &corners, &swings, &mesh->c, err);
    }
    if (status == HE_OK) {
        if ((flags & HE_BUILD_TAKE) != 0) {
            he_soup_clear(soup);
        }
        *out = mesh;
        mesh = NULL;
    } else {
        return_positions(soup, &mesh->c);
    }
out:
    he_mem_free(own);
    he_corners_clear(&corners);
    he_swings_clear(&swings);
    he_mesh_free(mesh);
    return status;
}
