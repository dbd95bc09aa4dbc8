#include "oracle/oracle.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

or_mesh *or_new(void)
{
    or_mesh *o = malloc(sizeof *o);
    assert(o != NULL);
    memset(o->left, 0xFF, sizeof o->left);
    memset(o->joined, 0xFF, sizeof o->joined);
    o->known_vertices = o->known_edges = 0;
    o->before = NULL;
    or_empty(o);
    return o;
}

void or_free(or_mesh *o)
{
    or_forget(o->before);
    free(o);
}

static void forget_pairs(or_mesh *o)
{
    for (uint32_t a = 0; a < o->known_vertices; a++) {
        for (uint32_t i = 0; i < o->degree[a]; i++) {
            uint32_t b = o->around[a][i];
            o->left[a][b] = o->left[b][a] = OR_NONE;
        }
        o->degree[a] = 0;
    }
    for (uint32_t e = 0; e < o->known_edges; e++) {
        uint32_t a = o->pair[e][0];
        uint32_t b = o->pair[e][1];
        o->joined[a][b] = o->joined[b][a] = OR_NONE;
    }
    o->known_vertices = o->known_edges = 0;
}

static bool beside(const or_mesh *o, uint32_t a, uint32_t b)
{
    return o->left[a][b] != OR_NONE || o->left[b][a] != OR_NONE;
}

static void add_around(or_mesh *o, uint32_t a, uint32_t b)
{
    for (; o->known_vertices <= a; o->known_vertices++) {
        o->degree[o->known_vertices] = 0;
    }
    o->around[a][o->degree[a]++] = b;
}

static void remove_around(or_mesh *o, uint32_t a, uint32_t b)
{
    uint32_t i = 0;
    while (o->around[a][i] != b) {
        i++;
    }
    o->around[a][i] = o->around[a][--o->degree[a]];
}

void or_set_left(or_mesh *o, uint32_t a, uint32_t b, uint32_t f)
{
    bool was = beside(o, a, b);
    o->left[a][b] = f;
    bool is = beside(o, a, b);
    if (!was && is) {
        add_around(o, a, b);
        add_around(o, b, a);
    } else if (was && !is) {
        remove_around(o, a, b);
        remove_around(o, b, a);
    }
}

void or_set_joined(or_mesh *o, uint32_t e)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    for (; o->known_edges <= e; o->known_edges++) {
        o->pair[o->known_edges][0] = o->pair[o->known_edges][1] = a;
    }
    o->pair[e][0] = a;
    o->pair[e][1] = b;
    o->joined[a][b] = o->joined[b][a] = e;
}

void or_empty(or_mesh *o)
{
    forget_pairs(o);
    or_forget(o->before);
    o->before = NULL;
    o->vertices = o->edges = o->faces = o->fresh = o->cuts = 0;
    o->either = o->by_plane = o->bridging = false;
    o->may = 0;
}

static or_face *copy_face(const or_face *f)
{
    size_t size = offsetof(or_face, v) + f->count * sizeof f->v[0];
    or_face *copy = malloc(size);
    assert(copy != NULL);
    memcpy(copy, f, size);
    return copy;
}

or_lists *or_save(const or_mesh *o)
{
    or_lists *lists = malloc(sizeof *lists);
    assert(lists != NULL && o->cuts == 0 && o->fresh == 0 && o->may == 0);
    lists->vertices = o->vertices;
    lists->edges = o->edges;
    lists->faces = o->faces;
    lists->vertex = malloc((o->vertices + 1) * sizeof *lists->vertex);
    lists->edge = malloc((o->edges + 1) * sizeof *lists->edge);
    lists->face = malloc((o->faces + 1) * sizeof *lists->face);
    assert(lists->vertex != NULL && lists->edge != NULL && lists->face != NULL);
    memcpy(lists->vertex, o->vertex, o->vertices * sizeof *lists->vertex);
    memcpy(lists->edge, o->edge, o->edges * sizeof *lists->edge);
    for (uint32_t f = 0; f < o->faces; f++) {
        lists->face[f] = copy_face(&o->face[f]);
    }
    return lists;
}

void or_forget(or_lists *lists)
{
    if (lists == NULL) {
        return;
    }
    for (uint32_t f = 0; f < lists->faces; f++) {
        free(lists->face[f]);
    }
    free(lists->face);
    free(lists->edge);
    free(lists->vertex);
    free(lists);
}

void or_doubt(or_mesh *o, or_lists *before, uint64_t may)
{
    assert(o->before == NULL);
    o->before = before;
    o->may |= may;
}

void or_restore(or_mesh *o, or_lists *lists)
{
    or_decline(o);
    o->fresh = 0;
    o->vertices = lists->vertices;
    o->edges = lists->edges;
    o->faces = lists->faces;
    memcpy(o->vertex, lists->vertex, o->vertices * sizeof *lists->vertex);
    memcpy(o->edge, lists->edge, o->edges * sizeof *lists->edge);
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *was = lists->face[f];
        memcpy(&o->face[f], was, offsetof(or_face, v) + was->count * sizeof was->v[0]);
    }
    uint64_t wrong = or_derive(o);
    assert(wrong == 0);
    (void)wrong;
    or_forget(lists);
}

uint32_t or_add_vertex(or_mesh *o, he_vec3 at)
{
    assert(o->vertices < OR_VERTICES);
    o->vertex[o->vertices] = (or_vertex){.alive = true, .at = at};
    return o->vertices++;
}

uint32_t or_add_face(or_mesh *o, const uint32_t *v, uint32_t count)
{
    assert(o->faces + o->fresh < OR_FACES && count <= OR_CORNERS);
    uint32_t f = o->faces + o->fresh;
    o->face[f].alive = true;
    o->face[f].locked = false;
    o->face[f].count = count;
    memcpy(o->face[f].v, v, count * sizeof *v);
    o->fresh++;
    return f;
}

void or_remove_last_face(or_mesh *o)
{
    assert(o->fresh > 0);
    o->fresh--;
}

uint32_t or_live_vertices(const or_mesh *o)
{
    uint32_t n = 0;
    for (uint32_t v = 0; v < o->vertices; v++) {
        n += o->vertex[v].alive;
    }
    return n;
}

uint32_t or_live_edges(const or_mesh *o)
{
    uint32_t n = 0;
    for (uint32_t e = 0; e < o->edges; e++) {
        n += o->edge[e].alive;
    }
    return n;
}

uint32_t or_live_faces(const or_mesh *o)
{
    uint32_t n = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        n += o->face[f].alive;
    }
    return n;
}

bool or_same_point(he_vec3 a, he_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

uint32_t or_place(const or_face *f, uint32_t v)
{
    for (uint32_t i = 0; i < f->count; i++) {
        if (f->v[i] == v) {
            return i;
        }
    }
    return OR_NONE;
}

uint32_t or_after(const or_face *f, uint32_t v)
{
    return f->v[(or_place(f, v) + 1) % f->count];
}

uint32_t or_before(const or_face *f, uint32_t v)
{
    return f->v[(or_place(f, v) + f->count - 1) % f->count];
}

uint32_t or_neighbours(const or_mesh *o, uint32_t v, uint32_t *out, uint32_t room)
{
    uint32_t n = or_degree(o, v);
    n = n < room ? n : room;
    memcpy(out, o->around[v], n * sizeof *out);
    return n;
}

uint32_t or_degree(const or_mesh *o, uint32_t v)
{
    return v < o->known_vertices ? o->degree[v] : 0;
}

/* Returns the number of open fans of faces around the vertex v: each has a first neighbour, which
 * no face precedes. */
static uint32_t open_fans(const or_mesh *o, uint32_t v)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < or_degree(o, v); i++) {
        uint32_t x = o->around[v][i];
        n += o->left[v][x] != OR_NONE && o->left[x][v] == OR_NONE;
    }
    return n;
}

bool or_on_boundary(const or_mesh *o, uint32_t v)
{
    return or_degree(o, v) == 0 || open_fans(o, v) > 0;
}

uint32_t or_fans(const or_mesh *o, uint32_t v)
{
    uint32_t n = open_fans(o, v);
    return n > 0 ? n : or_degree(o, v) > 0;
}

uint32_t or_turn(const or_mesh *o, uint32_t v, uint32_t x)
{
    uint32_t f = o->left[v][x];
    return f == OR_NONE ? OR_NONE : or_before(&o->face[f], v);
}

bool or_closes_beside(const or_mesh *o, uint32_t v, uint32_t x, uint32_t y)
{
    while (o->left[v][x] != OR_NONE) {
        x = or_turn(o, v, x);
    }
    return x == y && or_fans(o, v) > 1;
}

/* Returns whether a mesh can have the faces around the vertex v: they must be one closed fan, or
 * any number of open fans. */
static bool fans_can_be_held(const or_mesh *o, uint32_t v)
{
    uint32_t degree = or_degree(o, v);
    uint32_t seen = 0;
    bool open = false;
    for (uint32_t i = 0; i < degree; i++) {
        uint32_t x = o->around[v][i];
        if (o->left[v][x] != OR_NONE && o->left[x][v] == OR_NONE) {
            open = true;
            for (uint32_t y = x; y != OR_NONE && seen <= degree; y = or_turn(o, v, y)) {
                seen++;
            }
        }
    }
    if (!open && degree > 0) {
        uint32_t x = o->around[v][0];
        do {
            x = or_turn(o, v, x);
            seen++;
        } while (x != o->around[v][0] && x != OR_NONE && seen <= degree);
    }
    return seen == degree;
}

uint64_t or_derive(or_mesh *o)
{
    uint64_t wrong = 0;
    forget_pairs(o);
    for (uint32_t f = 0; f < o->faces + o->fresh; f++) {
        const or_face *face = &o->face[f];
        if (!face->alive) {
            continue;
        }
        if (face->count < 3) {
            wrong |= OR_BIT(HE_TOO_FEW_CORNERS);
        }
        for (uint32_t i = 0; i < face->count; i++) {
            uint32_t a = face->v[i];
            uint32_t b = face->v[(i + 1) % face->count];
            if (or_place(face, a) != i) {
                wrong |= OR_BIT(HE_REPEATED_CORNER);
            }
            if (o->left[a][b] != OR_NONE) {
                wrong |= OR_BIT(HE_ORIENTATION);
            }
            or_set_left(o, a, b, f);
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        if (o->edge[e].alive) {
            or_set_joined(o, e);
        }
    }
    for (uint32_t v = 0; v < o->vertices && wrong == 0; v++) {
        if (o->vertex[v].alive && !fans_can_be_held(o, v)) {
            wrong |= OR_BIT(HE_CLOSED_FAN);
        }
    }
    return wrong;
}

bool or_same_cycle(const or_face *f, const or_face *g)
{
    if (f->count != g->count || f->count == 0) {
        return f->count == g->count;
    }
    uint32_t shift = or_place(g, f->v[0]);
    for (uint32_t i = 0; shift != OR_NONE && i < f->count; i++) {
        if (f->v[i] != g->v[(shift + i) % g->count]) {
            return false;
        }
    }
    return shift != OR_NONE;
}

uint64_t or_require(const or_mesh *o, he_kind kind, uint32_t id)
{
    bool issued = false;
    bool alive = false;
    switch (kind) {
    case HE_VERTEX:
        issued = id < o->vertices;
        alive = issued && o->vertex[id].alive;
        break;
    case HE_HALFEDGE:
        issued = id / 2 < o->edges;
        alive = issued && o->edge[id / 2].alive;
        break;
    case HE_EDGE:
        issued = id < o->edges;
        alive = issued && o->edge[id].alive;
        break;
    case HE_FACE:
        issued = id < o->faces;
        alive = issued && o->face[id].alive;
        break;
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return alive ? 0 : OR_BIT(issued ? HE_DELETED_ELEMENT : HE_NO_SUCH_ELEMENT);
}
