#include "query/traverse.h"

#include "geometry/geometry.h"
#include "mesh/walk.h"
#include "query/idmap.h"

#include <float.h>
#include <math.h>

static he_status corrupt(he_kind kind, uint32_t id, he_error *err)
{
    return he_fail(err, HE_CORRUPT, kind, id,
                   "the links of the mesh are damaged: a walk from %s %u does not end",
                   he_kind_name(kind), id);
}

/* A vertex that the search has reached. The idmap `met` maps the id of the vertex to its index in
 * the array `nodes`. */
typedef struct node {
    double distance;
    uint32_t via; /* the last half-edge of the shortest path found so far; HE_NONE at the start */
    /* Index of the node in the heap; HE_NONE once the node is settled, which means that its
     * shortest path is known. */
    uint32_t place;
} node;

typedef struct search {
    he_idmap met;
    node *nodes;
    size_t capacity;
    /* binary heap of indices of `nodes`, the nearest first; it has room for all nodes */
    uint32_t *heap;
    uint32_t count; /* number of entries of the heap */
    uint32_t steps; /* number of half-edges visited */
} search;

static void search_clear(search *s)
{
    he_idmap_clear(&s->met);
    he_mem_free(s->nodes);
    he_mem_free(s->heap);
}

/* Returns true if node a comes before node b in the heap. Of two nodes at equal distances, the node
 * that was reached first comes first, so the result is equal on every machine. */
static bool nearer(const search *s, uint32_t a, uint32_t b)
{
    double x = s->nodes[a].distance, y = s->nodes[b].distance;
    return x < y || (x == y && a < b);
}

static void put(search *s, uint32_t place, uint32_t n)
{
    s->heap[place] = n;
    s->nodes[n].place = place;
}

static void rise(search *s, uint32_t n)
{
    uint32_t place = s->nodes[n].place;
    while (place > 0) {
        uint32_t parent = (place - 1) / 4;
        if (!nearer(s, n, s->heap[parent])) {
            break;
        }
        put(s, place, s->heap[parent]);
        place = parent;
    }
    put(s, place, n);
}

static uint32_t take_nearest(search *s)
{
    uint32_t top = s->heap[0];
    s->nodes[top].place = HE_NONE;
    uint32_t n = s->heap[--s->count];
    if (s->count == 0) {
        return top;
    }
    uint32_t place = 0;
    for (;;) {
        uint64_t child = 4u * (uint64_t)place + 1;
        if (child >= s->count) {
            break;
        }
        uint64_t last = child + 4 < s->count ? child + 4 : s->count;
        uint32_t best = (uint32_t)child;
        for (uint32_t c = best + 1; c < last; c++) {
            if (nearer(s, s->heap[c], s->heap[best])) {
                best = c;
            }
        }
        if (!nearer(s, s->heap[best], n)) {
            break;
        }
        put(s, place, s->heap[best]);
        place = best;
    }
    put(s, place, n);
    return top;
}

static he_status search_grow(search *s, he_error *err)
{
    size_t capacity = he_mem_grown(s->capacity, s->met.ids.count + 1);
    node *nodes = he_mem_array(s->nodes, capacity, sizeof *nodes);
    if (nodes != NULL) {
        s->nodes = nodes;
        uint32_t *heap = he_mem_array(s->heap, capacity, sizeof *heap);
        if (heap != NULL) {
            s->heap = heap;
            s->capacity = capacity;
            return HE_OK;
        }
    }
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for a search over %zu vertices", capacity);
}

/* Stores for `vertex` the path of length `distance` whose last half-edge is `via`, if no shorter
 * path to the vertex was found before. */
static he_status reach(search *s, uint32_t vertex, double distance, uint32_t via, he_error *err)
{
    if (s->met.ids.count >= s->capacity) {
        he_status status = search_grow(s, err);
        if (status != HE_OK) {
            return status;
        }
    }
    uint32_t n;
    bool added;
    he_status status = he_idmap_add(&s->met, vertex, &n, &added, err);
    if (status != HE_OK) {
        return status;
    }
    if (added) {
        s->nodes[n] = (node){distance, via, s->count};
        s->heap[s->count++] = n;
        rise(s, n);
    } else if (s->nodes[n].place != HE_NONE && distance < s->nodes[n].distance) {
        s->nodes[n].distance = distance;
        s->nodes[n].via = via;
        rise(s, n);
    }
    return HE_OK;
}

static bool has_ends(const he_mesh *m, uint32_t h)
{
    return m->c.origin[h] < m->c.vertices.issued && m->c.origin[h ^ 1u] < m->c.vertices.issued;
}

/* Finds the shortest path to the vertex `to` by Dijkstra's algorithm. *goal is set to the index of
 * the node of `to`, or to HE_NONE if no path leads to it. */
static he_status dijkstra(const he_mesh *m, uint32_t from, uint32_t to, he_measure by, search *s,
                          uint32_t *goal, he_error *err)
{
    const uint32_t end = 2u * m->c.edges.issued;
    *goal = HE_NONE;
    he_status status = reach(s, from, 0, HE_NONE, err);
    while (status == HE_OK && s->count > 0) {
        uint32_t n = take_nearest(s);
        uint32_t vertex = s->met.ids.ids[n];
        if (vertex == to) {
            *goal = n;
            break;
        }
        uint32_t first = m->c.vertex_halfedge[vertex], h = first;
        if (first == HE_NONE) {
            continue;
        }
        do {
            if (h >= end || s->steps++ == end || !has_ends(m, h)) {
                return corrupt(HE_VERTEX, from, err);
            }
            double length = by == HE_BY_LENGTH ? he_edge_length(m, (he_edge){h >> 1}) : 1;
            double distance = fmin(s->nodes[n].distance + length, DBL_MAX);
            status = reach(s, m->c.origin[h ^ 1u], distance, h, err);
            h = m->c.prev[h] ^ 1u;
        } while (status == HE_OK && h != first);
    }
    return status;
}

static he_status trace_back(const he_mesh *m, const search *s, uint32_t goal, he_path *out,
                            he_error *err)
{
    he_status status = HE_OK;
    uint32_t n = goal;
    for (;;) {
        status = he_ids_add(&out->vertices, s->met.ids.ids[n], err);
        uint32_t via = s->nodes[n].via;
        if (status == HE_OK && via != HE_NONE) {
            status = he_ids_add(&out->edges, via >> 1, err);
        }
        if (status != HE_OK || via == HE_NONE) {
            break;
        }
        n = he_idmap_find(&s->met, m->c.origin[via]);
        /* A path cannot have more edges than there are vertices on it; a longer path means that
         * links of the mesh are damaged. */
        if (n == HE_NONE || out->edges.count >= s->met.ids.count) {
            return corrupt(HE_HALFEDGE, via, err);
        }
    }
    he_ids_reverse(&out->vertices);
    he_ids_reverse(&out->edges);
    out->found = true;
    out->length = s->nodes[goal].distance;
    return status;
}

he_status he_traverse_shortest_path(const he_mesh *m, he_vertex from, he_vertex to, he_measure by,
                                    he_path *out, he_error *err)
{
    he_status status = he_mesh_require(m, HE_VERTEX, from.i, err);
    if (status == HE_OK) {
        status = he_mesh_require(m, HE_VERTEX, to.i, err);
    }
    if (status != HE_OK) {
        return status;
    }
    search s = {0};
    he_path path = {0};
    uint32_t goal;
    status = dijkstra(m, from.i, to.i, by, &s, &goal, err);
    if (status == HE_OK && goal != HE_NONE) {
        status = trace_back(m, &s, goal, &path, err);
    }
    path.visited = s.steps;
    search_clear(&s);
    if (status != HE_OK) {
        he_path_clear(&path);
        return status;
    }
    *out = path;
    return HE_OK;
}

void he_path_clear(he_path *path)
{
    he_ids_clear(&path->vertices);
    he_ids_clear(&path->edges);
    path->found = false;
    path->length = 0;
    path->visited = 0;
}
