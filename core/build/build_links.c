#include "build/build_links.h"

#include "base/parallel.h"
#include "build/soup_check.h"

/* The data of the passes over corners, edges and vertices that write the links of the mesh. A pass
 * writes array entries in the order of their index and reads entries of other arrays in any order:
 * if ids are in no spatial order, a random read takes a third of the time of a random write. Until
 * the links of half-edge h are written, next[h] is the corner of h. */
typedef struct linking {
    const he_soup *soup;
    const he_corners *corners;
    he_content *c;
    /* the swing of each corner (next corner around its vertex, swing.h); overwritten by
     * name_halfedges with the half-edge of each corner */
    uint32_t *swing;
    uint32_t *first; /* first corner of each vertex */
    uint32_t lanes;
    /* Two numbers in turn for each lane, which is a range of faces that one thread handles
     * (parallel.h): first the number of its edges, then the id of its next edge. */
    uint32_t edges[HE_MOST_LANES];
} linking;

/* --- numbers of edges ------------------------------------------------------------------------- */

/* Returns true if a corner is the first corner along its edge. Its mate is the corner in the
 * adjacent face along this edge. Edges are numbered in the order of their first corners. */
static inline bool is_first(uint32_t corner, uint32_t mate)
{
    return mate == HE_NONE || mate > corner;
}

static he_status count_edges(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    linking *l = context;
    uint32_t count = 0;
    (void)err;
    for (size_t f = from; f < to; f++) {
        uint32_t first = l->soup->starts[f], end = he_soup_end(l->soup, f);
        count += is_first(end - 1, l->swing[first]);
        for (uint32_t c = first; c + 1 < end; c++) {
            count += is_first(c, l->swing[c + 1]);
        }
    }
    l->edges[lane] += count;
    return HE_OK;
}

static he_status number_edges(void *context, uint32_t lane, size_t from, size_t to, he_error *err)
{
    linking *l = context;
    uint32_t *corner_of = l->c->next, e = l->edges[lane];
    (void)err;
    for (size_t f = from; f < to; f++) {
        uint32_t first = l->soup->starts[f], end = he_soup_end(l->soup, f);
        for (uint32_t c = first; c < end; c++) {
            uint32_t mate = l->swing[c + 1 < end ? c + 1 : first];
            if (is_first(c, mate)) {
                corner_of[2 * e] = c;
                corner_of[2 * e + 1] = mate;
                e++;
            }
        }
    }
    l->edges[lane] = e;
    return HE_OK;
}

/* Replaces the number of edges of each lane (range of faces) by the id of the lane's first edge. */
static void place_edges(linking *l)
{
    uint32_t at = 0;
    for (uint32_t lane = 0; lane < l->lanes; lane++) {
        uint32_t count = l->edges[lane];
        l->edges[lane] = at;
        at += count;
    }
}

/* --- links ------------------------------------------------------------------------------------ */

static he_status name_halfedges(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const linking *l = context;
    const uint32_t *corner_of = l->c->next;
    (void)part;
    (void)err;
    for (size_t h = 2 * from; h < 2 * to; h++) {
        if (corner_of[h] != HE_NONE) {
            l->swing[corner_of[h]] = (uint32_t)h;
        }
    }
    return HE_OK;
}

static inline void link_halfedges(const linking *l, size_t from, size_t to, uint32_t degree)
{
    enum { AHEAD = 24 };
    he_content *k = l->c;
    const uint32_t *halfedge = l->swing, *corners = l->soup->corners;
    const size_t ahead = to - from > AHEAD ? to - AHEAD : from;
    for (size_t e = from; e < to; e++) {
        size_t h = 2 * e;
        uint32_t c = k->next[h], mate = k->next[h + 1];
        if (e < ahead && k->next[h + 2 * AHEAD + 1] != HE_NONE) {
            __builtin_prefetch(&halfedge[k->next[h + 2 * AHEAD + 1]]);
        }
        he_corner at = he_corner_find(l->corners, c, degree);
        k->next[h] = halfedge[at.next];
        k->prev[h] = halfedge[at.prev];
        k->origin[h] = corners[c];
        k->origin[h + 1] = corners[at.next];
        k->face[h] = at.face;
        if (mate != HE_NONE) {
            at = he_corner_find(l->corners, mate, degree);
            k->next[h + 1] = halfedge[at.next];
            k->prev[h + 1] = halfedge[at.prev];
            k->face[h + 1] = at.face;
        } else {
            k->next[h + 1] = k->prev[h + 1] = k->face[h + 1] = HE_NONE;
        }
    }
}

static he_status link_range(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const linking *l = context;
    (void)part;
    (void)err;
    switch (l->corners->degree) {
    case 3:
        link_halfedges(l, from, to, 3);
        break;
    case 4:
        link_halfedges(l, from, to, 4);
        break;
    default:
        link_halfedges(l, from, to, 0);
        break;
    }
    return HE_OK;
}

static he_status link_vertices(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const linking *l = context;
    (void)part;
    (void)err;
    for (size_t v = from; v < to; v++) {
        uint32_t c = l->first[v];
        l->c->vertex_halfedge[v] = c == HE_NONE ? HE_NONE : l->swing[c];
    }
    return HE_OK;
}

static he_status link_faces(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const linking *l = context;
    (void)part;
    (void)err;
    for (size_t f = from; f < to; f++) {
        l->c->face_halfedge[f] = l->swing[l->soup->starts[f]];
    }
    return HE_OK;
}

/* --- holes ------------------------------------------------------------------------------------ */

/* Lists the ids of the `count` boundary half-edges. A boundary half-edge always has an odd id,
 * because half-edge 2e is in the face in which edge e first appeared. */
static void list_holes(const he_content *k, uint32_t count, uint32_t *holes)
{
    for (uint32_t h = 1; count > 0; h += 2) {
        if (k->face[h] == HE_NONE) {
            *holes++ = h;
            count--;
        }
    }
}

/* Stores each boundary half-edge as the half-edge vertex_halfedge[v] of its origin v. If several
 * boundary half-edges leave one vertex, they form a linked list: the first is vertex_halfedge[v],
 * and prev[h] is the one after h. */
static void chain_holes(he_content *k, uint32_t count, const uint32_t *holes)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t h = holes[i], *stored = &k->vertex_halfedge[k->origin[h]];
        k->prev[h] = k->face[*stored] == HE_NONE ? *stored : HE_NONE;
        *stored = h;
    }
}

/* Links the boundary half-edges at a bow-tie, a vertex with several fans of faces. The boundary
 * half-edges that leave the vertex, one for each fan, form a linked list: the first is `head`, and
 * prev[h] is the one after h. The fans follow one another counter-clockwise in the order of this
 * list. Within each fan, the inner loop goes from the outgoing boundary half-edge clockwise to the
 * incoming boundary half-edge. */
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

static void link_holes(he_content *k, uint32_t count, const uint32_t *holes)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t h = holes[i], out = k->vertex_halfedge[k->origin[h ^ 1]];
        if (k->prev[out] == HE_NONE) {
            k->next[h] = out;
        }
        if (k->prev[h] != HE_NONE && k->vertex_halfedge[k->origin[h]] == h) {
            link_bowtie(k, h);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        k->prev[k->next[holes[i]]] = holes[i];
    }
}

static he_status find_holes(he_content *k, he_error *err)
{
    uint32_t count = k->boundary_halfedges;
    uint32_t *holes = he_mem_array(NULL, count, sizeof *holes);
    if (holes == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %u boundary half-edges", count);
    }
    list_holes(k, count, holes);
    chain_holes(k, count, holes);
    link_holes(k, count, holes);
    he_mem_free(holes);
    return HE_OK;
}

/* --- all together ----------------------------------------------------------------------------- */

static he_status number_all(linking *l, he_error *err)
{
    he_progress *progress = l->soup->limits.progress;
    he_status status = he_progress_phase(progress, "numbering", 0.65, err);
    if (status == HE_OK && l->lanes > 1) {
        status = he_run_lanes(progress, l->lanes, l->soup->face_count, count_edges, l, err);
        place_edges(l);
    }
    if (status == HE_OK) {
        status = he_progress_phase(progress, "numbering", 0.75, err);
    }
    return status == HE_OK
               ? he_run_lanes(progress, l->lanes, l->soup->face_count, number_edges, l, err)
               : status;
}

static he_status link_all(linking *l, size_t edges, he_error *err)
{
    const struct {
        he_range work;
        size_t count;
        double to;
    } passes[] = {{name_halfedges, edges, 0.82},
                  {link_range, edges, 0.92},
                  {link_vertices, l->c->vertices.issued, 0.96},
                  {link_faces, l->soup->face_count, 1}};
    he_progress *progress = l->soup->limits.progress;
    he_status status = HE_OK;
    for (size_t i = 0; i < sizeof passes / sizeof *passes && status == HE_OK; i++) {
        status = he_progress_phase(progress, "linking", passes[i].to, err);
        if (status == HE_OK) {
            status = he_run_ranges(progress, passes[i].count, passes[i].work, l, err);
        }
    }
    return status;
}

he_status he_build_links(const he_corners *corners, he_swings *swings, he_content *c, he_error *err)
{
    const he_soup *soup = corners->soup;
    linking l = {.soup = soup,
                 .corners = corners,
                 .c = c,
                 .swing = swings->swing,
                 .first = swings->first,
                 .lanes = he_lanes(soup->limits.progress, soup->face_count)};
    he_status status = number_all(&l, err);
    if (status == HE_OK) {
        status = link_all(&l, swings->edges, err);
    }
    if (status == HE_OK) {
        c->edges.issued = c->edges.live = (uint32_t)swings->edges;
        c->faces.issued = c->faces.live = (uint32_t)soup->face_count;
        c->boundary_halfedges = 2 * c->edges.issued - (uint32_t)soup->corner_count;
        if (c->boundary_halfedges > 0) {
            status = find_holes(c, err);
        }
    }
    return status;
}
