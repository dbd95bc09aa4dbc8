#include "mesh/build.h"

#include "mesh/content.h"
#include "mesh/pair.h"
#include "mesh/walk.h"

#include <stdio.h>
#include <string.h>

void he_defect_text(const he_defect *d, char *text, size_t size)
{
    const char *title = he_status_title(d->reason);
    if (d->kind == HE_VERTEX) {
        snprintf(text, size, "vertex %u: a closed fan shares it with another fan", d->id);
    } else if (d->other != HE_NONE) {
        snprintf(text, size, "face %u, edge %u-%u: %s", d->id, d->vertex, d->other,
                 d->reason == HE_ORIENTATION ? "another face runs along it in the same direction"
                                             : "two other faces already have it");
    } else if (d->vertex != HE_NONE) {
        snprintf(text, size, "face %u, corner %u: %s vertex %u", d->id, d->corner,
                 d->reason == HE_BAD_INDEX ? "there is no" : "it visits twice the", d->vertex);
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

/* What the making of links needs besides the mesh. */
typedef struct builder {
    const he_soup *soup;
    he_content *c;
    uint32_t *halfedge; /* of each corner; the mate of those not yet assigned */
    uint64_t *assigned; /* a bit a corner */
    uint32_t *degree;   /* half-edges that leave each vertex */
    uint32_t boundary_count;
} builder;

/* Corner c, from a to b, gets its half-edge; with a new edge when its mate has none yet. */
static uint32_t assign(builder *b, uint32_t c, uint32_t from, uint32_t to)
{
    if (he_bits_get(b->assigned, c)) {
        return b->halfedge[c];
    }
    he_content *k = b->c;
    uint32_t mate = b->halfedge[c], h = 2 * k->edges.issued++;
    b->halfedge[c] = h;
    k->origin[h] = from;
    k->origin[h + 1] = to;
    if (mate != HE_NONE) {
        b->halfedge[mate] = h + 1;
        he_bits_set(b->assigned, mate);
    } else {
        /* Nobody has the other side. Holes are linked when all faces are: until then prev chains
         * the boundary half-edges that leave one vertex. */
        uint32_t stored = k->vertex_halfedge[to];
        bool chained = stored != HE_NONE && (stored & 1) != 0 && k->face[stored] == HE_NONE;
        k->face[h + 1] = HE_NONE;
        k->prev[h + 1] = chained ? stored : HE_NONE;
        k->vertex_halfedge[to] = h + 1;
        b->degree[to]++;
        b->boundary_count++;
    }
    return h;
}

static he_status make_faces(builder *b, he_error *err)
{
    const he_soup *soup = b->soup;
    he_content *k = b->c;
    he_status status = he_watch_phase(soup->limits.watch, "linking", 0.85, err);
    for (size_t f = 0; f < soup->face_count && status == HE_OK; f++) {
        status = he_watch_at(soup->limits.watch, f, soup->face_count, err);
        uint32_t first = soup->starts[f], end = he_soup_end(soup, f);
        uint32_t start = assign(b, first, soup->corners[first], soup->corners[first + 1]);
        uint32_t before = start;
        for (uint32_t c = first; c < end; c++) {
            uint32_t v = soup->corners[c];
            uint32_t h =
                c == first ? start : assign(b, c, v, soup->corners[c + 1 < end ? c + 1 : first]);
            k->face[h] = (uint32_t)f;
            k->next[before] = h;
            k->prev[h] = before;
            before = h;
            b->degree[v]++;
            if (k->vertex_halfedge[v] == HE_NONE) {
                k->vertex_halfedge[v] = h;
            }
        }
        k->next[before] = start;
        k->prev[start] = before;
        k->face_halfedge[f] = start;
    }
    return status;
}

/* At a bow-tie, whose outgoing boundary half-edges are chained by prev from `head`: let each fan be
 * followed, counter-clockwise, by the next one of the chain. Turning clockwise inside a fan from
 * its outgoing boundary half-edge leads to its incoming one. */
static void link_bowtie(he_content *k, uint32_t head)
{
    uint32_t out = head;
    do {
        uint32_t following = k->prev[out] != HE_NONE ? k->prev[out] : head, h = following;
        do {
            h = k->next[h ^ 1];
        } while (k->face[h ^ 1] != HE_NONE);
        k->next[h ^ 1] = out;
        out = following;
    } while (out != head);
}

static void link_holes(builder *b)
{
    he_content *k = b->c;
    uint32_t halfedges = 2 * k->edges.issued;
    for (uint32_t h = 1; h < halfedges; h += 2) {
        if (k->face[h] != HE_NONE) {
            continue;
        }
        uint32_t out = k->vertex_halfedge[k->origin[h ^ 1]];
        if (k->prev[out] == HE_NONE) {
            k->next[h] = out;
        }
        if (k->prev[h] != HE_NONE && k->vertex_halfedge[k->origin[h]] == h) {
            link_bowtie(k, h);
        }
    }
    for (uint32_t h = 1; h < halfedges; h += 2) {
        if (k->face[h] == HE_NONE) {
            k->prev[k->next[h]] = h;
        }
    }
}

/* Turning about a vertex must meet all that leaves it: I9. */
static he_status check_fans(const builder *b, he_report *report, uint64_t *total, he_error *err)
{
    const he_content *k = b->c;
    he_watch *watch = b->soup->limits.watch;
    he_status status = he_watch_phase(watch, "turning", 1, err);
    for (uint32_t v = 0; v < k->vertices.issued && status == HE_OK; v++) {
        uint32_t first = k->vertex_halfedge[v], degree = b->degree[v];
        status = he_watch_at(watch, v, k->vertices.issued, err);
        if (degree == 0) {
            continue;
        }
        uint32_t h = first;
        do {
            degree--;
            h = k->prev[h] ^ 1;
        } while (h != first);
        if (degree != 0) {
            he_report_add(report, total,
                          (he_defect){HE_CLOSED_FAN, HE_VERTEX, v, HE_NONE, HE_NONE, HE_NONE});
        }
    }
    return status;
}

/* Corner rows of a soup column become half-edge rows. */
static he_status build_corners(const he_column *from, const builder *b, he_column **out,
                               he_error *err)
{
    he_column *column;
    he_status status = he_column_like(from, 2 * (size_t)b->c->edges.issued, &column, err);
    if (status != HE_OK) {
        return status;
    }
    for (size_t c = 0; c < from->rows && c < b->soup->corner_count; c++) {
        memcpy(he_column_row(column, b->halfedge[c]), he_column_row(from, c), from->row_bytes);
    }
    *out = column;
    return HE_OK;
}

/* The columns whose rows keep their numbers are moved where they may be, which cannot fail, and so
 * comes last. */
static he_status build_columns(const builder *b, he_soup *soup, bool take, he_error *err)
{
    he_content *k = b->c;
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
            status = build_corners(column, b, &k->columns[i], err);
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

/* Positions are moved when the soup may be emptied: they are the largest part of it. */
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
    for (size_t v = 0; v < count; v++) {
        k->vertex_halfedge[v] = HE_NONE;
    }
    return HE_OK;
}

/* Give back positions that build_vertices took. */
static void return_positions(he_soup *soup, he_content *k)
{
    if (soup->positions == NULL && k->position != NULL) {
        soup->positions = k->position;
        soup->vertex_count = soup->vertex_capacity = k->vertices.capacity;
        k->position = NULL;
    }
}

static he_status build_links(he_soup *soup, unsigned flags, he_content *k, size_t edges,
                             uint32_t *mate, he_report *report, uint64_t *total, he_error *err)
{
    size_t vertices = soup->vertex_count;
    builder b = {.soup = soup, .c = k, .halfedge = mate};
    he_status status = he_content_reserve_edges(k, edges, err);
    if (status == HE_OK) {
        status = he_content_reserve_faces(k, soup->face_count, err);
    }
    if (status == HE_OK) {
        status = build_vertices(soup, (flags & HE_BUILD_TAKE) != 0, k, err);
    }
    if (status != HE_OK) {
        return status;
    }
    b.assigned = he_bits_new(soup->corner_count);
    b.degree = he_mem_zero(vertices, sizeof *b.degree);
    if (b.assigned == NULL || b.degree == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory to link %zu edges", edges);
        goto out;
    }
    status = make_faces(&b, err);
    if (status != HE_OK) {
        goto out;
    }
    link_holes(&b);
    k->edges.live = k->edges.issued;
    k->faces.issued = k->faces.live = (uint32_t)soup->face_count;
    k->boundary_halfedges = b.boundary_count;
    status = check_fans(&b, report, total, err);
    if (status == HE_OK && *total > 0) {
        status = he_report_fail(report, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    status = build_columns(&b, soup, (flags & HE_BUILD_TAKE) != 0, err);
out:
    he_mem_free(b.assigned);
    he_mem_free(b.degree);
    return status;
}

he_status he_build(he_soup *soup, unsigned flags, he_mesh **out, he_report *report, he_error *err)
{
    uint64_t total = 0;
    uint32_t *mate = NULL;
    size_t edges = 0;
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
    status = he_watch_phase(soup->limits.watch, "checking", 0.05, err);
    if (status == HE_OK) {
        status = he_soup_check_faces(soup, report, &total, err);
    }
    if (status == HE_OK && total > 0) {
        status = he_report_fail(report, err);
    }
    if (status != HE_OK) {
        goto out;
    }
    mate = he_mem_array(NULL, soup->corner_count, sizeof *mate);
    if (mate == NULL) {
        status = he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu corners", soup->corner_count);
        goto out;
    }
    status = he_watch_phase(soup->limits.watch, "pairing", 0.5, err);
    if (status == HE_OK) {
        status = he_soup_pair(soup, mate, &edges, report, &total, err);
    }
    if (status == HE_OK && total > 0) {
        status = he_report_fail(report, err);
    }
    if (status == HE_OK && edges > HE_MAX_ROWS) {
        status =
            he_fail_plain(err, HE_IDS_EXHAUSTED, "%zu edges are more than %u", edges, HE_MAX_ROWS);
    }
    if (status == HE_OK) {
        status = build_links(soup, flags, &mesh->c, edges, mate, report, &total, err);
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
    he_mem_free(mate);
    he_mesh_free(mesh);
    return status;
}
