#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>

/* Finds the neighbours of the vertex v, counter-clockwise from `start`; the faces around v must
 * form one closed fan. */
static uint32_t ring_of(const or_mesh *o, uint32_t v, uint32_t start, uint32_t ring[OR_VERTICES])
{
    uint32_t n = 0;
    for (uint32_t x = start; n == 0 || x != start; x = or_turn(o, v, x)) {
        assert(n < OR_VERTICES);
        ring[n++] = x;
    }
    return n;
}

/* Returns whether the vertex v, or an edge or face around it, is locked, as a set of refusals. */
static uint64_t locked_about(const or_mesh *o, uint32_t v)
{
    bool locked = o->vertex[v].locked;
    for (uint32_t x = 0; x < o->vertices; x++) {
        uint32_t f = o->left[v][x];
        locked |= o->joined[v][x] != OR_NONE && o->edge[o->joined[v][x]].locked;
        locked |= f != OR_NONE && o->face[f].locked;
    }
    return locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
}

uint64_t or_vertex_dissolve(or_mesh *o, uint32_t v, uint32_t start)
{
    if (or_on_boundary(o, v)) {
        return OR_BIT(HE_BOUNDARY_VERTEX);
    }
    uint32_t ring[OR_VERTICES];
    uint32_t n = ring_of(o, v, start, ring);
    or_face whole = o->face[o->left[v][start]];
    whole.count = 0;
    for (uint32_t i = 0; i < n; i++) {
        const or_face *f = &o->face[o->left[v][ring[i]]];
        for (uint32_t x = ring[i]; x != or_before(f, v); x = or_after(f, x)) {
            assert(whole.count < OR_CORNERS);
            whole.v[whole.count++] = x;
        }
    }
    uint64_t refused = locked_about(o, v);
    refused |= whole.count < 3 ? OR_BIT(HE_TOO_FEW_CORNERS) : 0;
    for (uint32_t i = 0; i < whole.count; i++) {
        refused |= or_place(&whole, whole.v[i]) != i ? OR_BIT(HE_REPEATED_CORNER) : 0;
    }
    if (refused != 0) {
        return refused;
    }
    for (uint32_t i = 0; i < n; i++) {
        o->face[o->left[v][ring[i]]].alive = false;
        o->edge[o->joined[v][ring[i]]].alive = false;
    }
    o->face[o->left[v][start]] = whole;
    o->vertex[v].alive = false;
    return 0;
}

static bool holds(const uint32_t *list, uint32_t count, uint32_t x)
{
    for (uint32_t i = 0; i < count; i++) {
        if (list[i] == x) {
            return true;
        }
    }
    return false;
}

/* Inserts the vertex w as a corner of a face in front of the corner with the index i. */
static void insert_at(or_face *f, uint32_t i, uint32_t w)
{
    assert(f->count < OR_CORNERS);
    for (uint32_t k = f->count++; k > i; k--) {
        f->v[k] = f->v[k - 1];
    }
    f->v[i] = w;
}

uint64_t or_vertex_split_corners(or_mesh *o, uint32_t v, const uint32_t *moved, uint32_t count)
{
    uint32_t sides = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        sides += face->alive && or_place(face, v) != OR_NONE &&
                 holds(moved, count, or_before(face, v)) != holds(moved, count, or_after(face, v));
    }
    if (sides == 0) {
        return OR_BIT(HE_NO_FACE);
    }
    uint32_t u = or_add_vertex(o, o->vertex[v].at);
    for (uint32_t f = 0; f < o->faces; f++) {
        or_face *face = &o->face[f];
        if (!face->alive || or_place(face, v) == OR_NONE) {
            continue;
        }
        uint32_t at = or_place(face, v);
        bool in = holds(moved, count, or_before(face, v));
        bool out = holds(moved, count, or_after(face, v));
        if (in && out) {
            face->v[at] = u;
        } else if (in || out) {
            insert_at(face, in ? at : at + 1, u);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        or_edge *e = &o->edge[o->joined[v][moved[i]]];
        *(e->a == v ? &e->a : &e->b) = u;
    }
    return 0;
}

uint64_t or_vertex_bevel(or_mesh *o, uint32_t v, uint32_t start, double width)
{
    uint64_t refused = locked_about(o, v);
    refused |= or_on_boundary(o, v) ? OR_BIT(HE_BOUNDARY_VERTEX) : 0;
    refused |= or_degree(o, v) < 3 ? OR_BIT(HE_LOW_DEGREE) : 0;
    if (refused != 0) {
        return refused;
    }
    uint32_t ring[OR_VERTICES];
    uint32_t cut[OR_VERTICES];
    uint32_t n = ring_of(o, v, start, ring);
    he_vec3 p = o->vertex[v].at;
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 q = o->vertex[ring[i]].at;
        double length =
            sqrt((q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y) + (q.z - p.z) * (q.z - p.z));
        double t = length > 0 ? fmin(width / length, 0.99) : 0.5;
        cut[i] = i == 0 ? v : or_add_vertex(o, p);
        or_vertex *w = &o->vertex[cut[i]];
        w->at = (he_vec3){p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
        w->near = true;
    }
    for (uint32_t i = 0; i < n; i++) {
        or_face *f = &o->face[o->left[v][ring[i]]];
        or_edge *e = &o->edge[o->joined[v][ring[i]]];
        uint32_t at = or_place(f, v);
        f->v[at] = cut[i];
        insert_at(f, at, cut[(i + 1) % n]);
        *(e->a == v ? &e->a : &e->b) = cut[i];
    }
    (void)or_add_face(o, cut, n);
    return 0;
}
