#include "oracle/oracle.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

or_mesh *or_new(void)
{
    or_mesh *o = malloc(sizeof *o);
    assert(o != NULL);
    memset(o->left, 0xFF, sizeof o->left);
    memset(o->joined, 0xFF, sizeof o->joined);
    o->vertices = 0;
    or_empty(o);
    return o;
}

void or_free(or_mesh *o)
{
    free(o);
}

static void forget_pairs(or_mesh *o)
{
    for (uint32_t a = 0; a < o->vertices; a++) {
        memset(o->left[a], 0xFF, o->vertices * sizeof o->left[a][0]);
        memset(o->joined[a], 0xFF, o->vertices * sizeof o->joined[a][0]);
    }
}

void or_empty(or_mesh *o)
{
    forget_pairs(o);
    o->vertices = o->edges = o->faces = o->fresh = o->cuts = 0;
    o->either = o->by_plane = o->bridging = false;
    o->may = 0;
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
    uint32_t n = 0;
    for (uint32_t x = 0; x < o->vertices; x++) {
        if ((o->left[v][x] != OR_NONE || o->left[x][v] != OR_NONE) && n < room) {
            out[n++] = x;
        }
    }
    return n;
}

uint32_t or_degree(const or_mesh *o, uint32_t v)
{
    uint32_t n = 0;
    for (uint32_t x = 0; x < o->vertices; x++) {
        n += o->left[v][x] != OR_NONE || o->left[x][v] != OR_NONE;
    }
    return n;
}

/* Open fans: each begins at a neighbour no face comes from. */
static uint32_t open_fans(const or_mesh *o, uint32_t v)
{
    uint32_t n = 0;
    for (uint32_t x = 0; x < o->vertices; x++) {
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

/* One closed fan, or any number of open ones? */
static bool fans_can_be_held(const or_mesh *o, uint32_t v)
{
    uint32_t degree = or_degree(o, v);
    uint32_t seen = 0;
    bool open = false;
    for (uint32_t x = 0; x < o->vertices; x++) {
        if (o->left[v][x] != OR_NONE && o->left[x][v] == OR_NONE) {
            open = true;
            for (uint32_t y = x; y != OR_NONE && seen <= degree; y = or_turn(o, v, y)) {
                seen++;
            }
        }
    }
    for (uint32_t x = 0; x < o->vertices && !open && degree > 0; x++) {
        if (o->left[v][x] != OR_NONE) {
            uint32_t y = x;
            do {
                y = or_turn(o, v, y);
                seen++;
            } while (y != x && y != OR_NONE && seen <= degree);
            break;
        }
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
            o->left[a][b] = f;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        if (o->edge[e].alive) {
            o->joined[o->edge[e].a][o->edge[e].b] = e;
            o->joined[o->edge[e].b][o->edge[e].a] = e;
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
