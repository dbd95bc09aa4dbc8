#include "remesh/net.h"

#include <string.h>

static he_status no_memory(const he_net *n, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for %u triangles", n->live_triangles);
}

/* Enlarges an array. Returns false if memory is out; the array is then as it was. */
static bool enlarge(void *array, size_t count, size_t size)
{
    void *block;
    memcpy(&block, array, sizeof block);
    block = he_mem_array(block, count, size);
    if (block == NULL) {
        return false;
    }
    memcpy(array, &block, sizeof block);
    return true;
}

static bool more_triangles(he_net *n)
{
    size_t room = he_mem_grown(n->triangle_room, (size_t)n->triangle_count + 2);
    if (!enlarge(&n->triangles, room, sizeof *n->triangles) ||
        !enlarge(&n->ids, room, sizeof *n->ids)) {
        return false;
    }
    n->triangle_room = (uint32_t)room;
    return true;
}

static bool more_vertices(he_net *n)
{
    size_t room = he_mem_grown(n->vertex_room, (size_t)n->vertex_count + 1);
    if (!enlarge(&n->vertices, room, sizeof *n->vertices) ||
        !enlarge(&n->corner, room, sizeof *n->corner) ||
        !enlarge(&n->ground, room, sizeof *n->ground) ||
        !enlarge(&n->vertex_id, room, sizeof *n->vertex_id) ||
        (n->arc != NULL && !enlarge(&n->arc, room, sizeof *n->arc))) {
        return false;
    }
    n->vertex_room = (uint32_t)room;
    return true;
}

static bool more_edges(he_net *n)
{
    size_t room = he_mem_grown(n->edge_room, (size_t)n->edge_count + 3);
    if (!enlarge(&n->edge_parent, room, sizeof *n->edge_parent) ||
        (n->line != NULL && !enlarge(&n->line, n->first_edge + room, sizeof *n->line))) {
        return false;
    }
    n->edge_room = (uint32_t)room;
    return true;
}

he_status he_net_reserve_more(he_net *n, he_error *err)
{
    if (n->live_triangles + 2 > n->most_triangles) {
        return he_fail_plain(err, HE_LIMIT, "there would be more than %u triangles",
                             n->most_triangles);
    }
    if ((n->triangle_count + 2 > n->triangle_room && !more_triangles(n)) ||
        (n->vertex_count == n->vertex_room && !more_vertices(n)) ||
        (n->edge_count + 3 > n->edge_room && !more_edges(n))) {
        return no_memory(n, err);
    }
    return HE_OK;
}

uint32_t he_net_new_vertex(he_net *n, he_vec3 place)
{
    uint32_t v = n->vertex_count++;
    n->vertices[v] =
        (he_net_vertex){.p = place, .ideal = 6, .flags = HE_NET_MOVED | HE_NET_RESTLESS};
    n->vertex_id[v] = HE_NONE;
    n->live_vertices++;
    return v;
}

uint32_t he_net_new_edge(he_net *n, uint32_t parent)
{
    uint32_t e = n->spare_edge;
    if (e == HE_NONE) {
        e = n->first_edge + n->edge_count++;
    } else {
        n->spare_edge = n->edge_parent[e - n->first_edge];
    }
    n->edge_parent[e - n->first_edge] = parent;
    if (n->line != NULL) {
        n->line[e] = HE_NONE;
    }
    return 2 * e;
}

void he_net_delete_edge(he_net *n, uint32_t edge)
{
    if (edge >= n->first_edge) {
        n->edge_parent[edge - n->first_edge] = n->spare_edge;
        n->spare_edge = edge;
    }
}

/* --- order --- */

/* The new places of triangles and vertices. */
typedef struct order {
    uint32_t *triangle;  /* the triangles in their new order */
    uint32_t *to;        /* the new number of each triangle */
    uint32_t *vertex_to; /* the new number of each vertex */
    uint32_t triangles, vertices;
} order;

static void find(const he_net *n, order *o, uint32_t t)
{
    o->to[t] = o->triangles;
    o->triangle[o->triangles++] = t;
    for (unsigned i = 0; i < 3; i++) {
        uint32_t v = n->triangles[t].v[i];
        if (o->vertex_to[v] == HE_NONE) {
            o->vertex_to[v] = o->vertices++;
        }
    }
}

static void search(const he_net *n, order *o)
{
    uint32_t handled = 0;
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        if (he_net_is_gone(n, t) || o->to[t] != HE_NONE) {
            continue;
        }
        find(n, o, t);
        for (; handled < o->triangles; handled++) {
            const he_net_triangle *of = &n->triangles[o->triangle[handled]];
            for (unsigned i = 0; i < 3; i++) {
                if (of->twin[i] != HE_NONE && o->to[of->twin[i] >> 2] == HE_NONE) {
                    find(n, o, of->twin[i] >> 2);
                }
            }
        }
    }
}

static uint32_t corner_to(const order *o, uint32_t c)
{
    return c == HE_NONE || o->to[c >> 2] == HE_NONE ? HE_NONE : 4 * o->to[c >> 2] + (c & 3);
}

static void write_triangles(const he_net *n, const order *o, he_net_triangle *to)
{
    for (uint32_t i = 0; i < o->triangles; i++) {
        const he_net_triangle *from = &n->triangles[o->triangle[i]];
        to[i] = *from;
        for (unsigned k = 0; k < 3; k++) {
            to[i].v[k] = o->vertex_to[from->v[k]];
            to[i].twin[k] = corner_to(o, from->twin[k]);
        }
    }
}

static void write_ids(const he_net *n, const order *o, he_net_ids *to)
{
    for (uint32_t i = 0; i < o->triangles; i++) {
        to[i] = n->ids[o->triangle[i]];
    }
}

static void write_vertices(const he_net *n, const order *o, he_net *to)
{
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        uint32_t w = o->vertex_to[v];
        if (w == HE_NONE) {
            continue;
        }
        to->vertices[w] = n->vertices[v];
        to->corner[w] = corner_to(o, n->corner[v]);
        to->ground[w] = n->ground[v];
        to->vertex_id[w] = n->vertex_id[v];
        if (n->arc != NULL) {
            to->arc[w] = n->arc[v];
        }
    }
}

/* Allocates what he_net_tidy needs. Fresh pages are expensive, so the old triangles' memory becomes
 * that of the ids, and if the vertices fit into the old ids' memory, they get that; otherwise
 * `to->vertices` is allocated. */
static bool make_room(const he_net *n, order *o, he_net *to)
{
    const size_t fits = n->triangle_room * sizeof *n->ids / sizeof *n->vertices;
    const bool is_reused = fits > n->live_vertices && fits < UINT32_MAX;
    to->vertex_room = is_reused ? (uint32_t)fits : n->vertex_room;
    o->triangle = he_mem_array(NULL, n->live_triangles, sizeof *o->triangle);
    o->to = he_mem_array(NULL, n->triangle_count, sizeof *o->to);
    o->vertex_to = he_mem_array(NULL, n->vertex_count, sizeof *o->vertex_to);
    to->triangles = he_mem_array(NULL, n->triangle_room, sizeof *to->triangles);
    to->ids = NULL;
    to->vertices = is_reused ? NULL : he_mem_array(NULL, to->vertex_room, sizeof *to->vertices);
    to->corner = he_mem_array(NULL, to->vertex_room, sizeof *to->corner);
    to->ground = he_mem_array(NULL, to->vertex_room, sizeof *to->ground);
    to->vertex_id = he_mem_array(NULL, to->vertex_room, sizeof *to->vertex_id);
    to->arc = n->arc == NULL ? NULL : he_mem_array(NULL, to->vertex_room, sizeof *to->arc);
    return o->triangle != NULL && o->to != NULL && o->vertex_to != NULL && to->triangles != NULL &&
           (is_reused || to->vertices != NULL) && to->corner != NULL && to->ground != NULL &&
           to->vertex_id != NULL && (n->arc == NULL || to->arc != NULL);
}

static void free_elements(he_net *n)
{
    he_mem_free(n->triangles);
    he_mem_free(n->ids);
    he_mem_free(n->vertices);
    he_mem_free(n->corner);
    he_mem_free(n->ground);
    he_mem_free(n->vertex_id);
    he_mem_free(n->arc);
}

/* Writes the elements in their new order. Each array is read for the last time before its memory is
 * given to the next one. */
static void rewrite(he_net *n, const order *o, he_net *to)
{
    _Static_assert(sizeof(he_net_ids) <= sizeof(he_net_triangle), "ids fit where triangles were");
    write_triangles(n, o, to->triangles);
    to->ids = (he_net_ids *)(void *)n->triangles;
    n->triangles = NULL;
    write_ids(n, o, to->ids);
    if (to->vertices == NULL) {
        to->vertices = (he_net_vertex *)(void *)n->ids;
        n->ids = NULL;
    }
    write_vertices(n, o, to);
}

he_status he_net_tidy(he_net *n, he_error *err)
{
    order o = {.triangle = NULL};
    he_net to = *n;
    he_status status = HE_OK;
    if (n->live_triangles == 0) {
        return HE_OK;
    }
    if (!make_room(n, &o, &to)) {
        free_elements(&to);
        status = no_memory(n, err);
        goto out;
    }
    memset(o.to, 0xFF, n->triangle_count * sizeof *o.to);
    memset(o.vertex_to, 0xFF, n->vertex_count * sizeof *o.vertex_to);
    search(n, &o);
    rewrite(n, &o, &to);
    to.triangle_count = o.triangles;
    to.vertex_count = to.live_vertices = o.vertices;
    for (uint32_t i = 0; i < n->lines.count; i++) {
        uint32_t *end = n->lines.line[i].end;
        end[0] = o.vertex_to[end[0]];
        end[1] = o.vertex_to[end[1]];
    }
    free_elements(n);
    *n = to;
out:
    he_mem_free(o.triangle);
    he_mem_free(o.to);
    he_mem_free(o.vertex_to);
    return status;
}

void he_net_clear(he_net *n)
{
    free_elements(n);
    he_mem_free(n->line);
    he_mem_free(n->edge_parent);
    he_mem_free(n->lines.line);
    he_mem_free(n->lines.point);
    he_mem_free(n->lines.arc);
    he_mem_free(n->lines.ground);
    *n = (he_net){.triangles = NULL};
}
