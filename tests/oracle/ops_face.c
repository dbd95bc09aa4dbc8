#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>
#include <string.h>

uint64_t or_face_add(or_mesh *o, const uint32_t *v, uint32_t count)
{
    uint64_t refused = 0;
    if (count < 3) {
        refused |= OR_BIT(HE_TOO_FEW_CORNERS);
    }
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            if (v[i] == v[k]) {
                refused |= OR_BIT(HE_REPEATED_CORNER);
            }
        }
        if (!or_on_boundary(o, v[i])) {
            refused |= OR_BIT(HE_INTERIOR_VERTEX);
        }
        uint32_t b = v[(i + 1) % count];
        if (o->left[v[i]][b] != OR_NONE) {
            refused |= OR_BIT(o->left[b][v[i]] == OR_NONE ? HE_ORIENTATION : HE_NONMANIFOLD_EDGE);
        }
    }
    if (refused != 0) {
        return refused;
    }
    (void)or_add_face(o, v, count);
    refused = or_derive(o);
    if (refused != 0) {
        or_remove_last_face(o);
        (void)or_derive(o);
    }
    return refused;
}

uint64_t or_face_split(or_mesh *o, uint32_t f, uint32_t from, uint32_t to)
{
    or_face *face = &o->face[f];
    uint32_t i = or_place(face, from);
    uint32_t k = or_place(face, to);
    uint64_t refused = 0;
    if (i == OR_NONE || k == OR_NONE) {
        refused |= OR_BIT(HE_NOT_A_CORNER);
    }
    if (from == to) {
        refused |= OR_BIT(HE_SAME_CORNER);
    }
    if (refused != 0) {
        return refused;
    }
    if (or_after(face, from) == to || or_after(face, to) == from) {
        return OR_BIT(HE_ADJACENT_CORNERS);
    }
    if (o->joined[from][to] != OR_NONE) {
        return OR_BIT(HE_DOUBLED_EDGE);
    }
    /* When a diagonal splits the face, the part on the left of from->to keeps the old id: its
     * corners run from `to` on, back to `from`. */
    or_face old = {.alive = true};
    or_face new = {.alive = true};
    for (uint32_t s = k;; s = (s + 1) % face->count) {
        old.v[old.count++] = face->v[s];
        if (s == i) {
            break;
        }
    }
    for (uint32_t s = i;; s = (s + 1) % face->count) {
        new.v[new.count++] = face->v[s];
        if (s == k) {
            break;
        }
    }
    *face = old;
    (void)or_add_face(o, new.v, new.count);
    return 0;
}

uint64_t or_face_join(or_mesh *o, uint32_t e)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t f = o->left[a][b];
    uint32_t g = o->left[b][a];
    if (f == OR_NONE || g == OR_NONE) {
        return OR_BIT(HE_BOUNDARY_EDGE);
    }
    or_face *keeps = &o->face[f];
    or_face *goes = &o->face[g];
    uint32_t shared = 0;
    for (uint32_t i = 0; i < keeps->count; i++) {
        shared += or_place(goes, keeps->v[i]) != OR_NONE;
    }
    if (shared > 2) {
        return OR_BIT(HE_SHARED_BOUNDARY) | OR_BIT(HE_REPEATED_CORNER);
    }
    if (o->edge[e].locked || keeps->locked || goes->locked) {
        return OR_BIT(HE_LOCKED_ELEMENT);
    }
    or_face joined = {.alive = true};
    uint32_t start = or_place(keeps, b);
    for (uint32_t i = 0; i < keeps->count; i++) {
        joined.v[joined.count++] = keeps->v[(start + i) % keeps->count];
    }
    /* The face `keeps` becomes the joined face. Where it has the side from vertex a to vertex b,
     * the corners of the face `goes` that follow a, without a and b, are inserted. */
    start = or_place(goes, a);
    for (uint32_t i = 1; i + 1 < goes->count; i++) {
        assert(joined.count < OR_CORNERS);
        joined.v[joined.count++] = goes->v[(start + i) % goes->count];
    }
    *keeps = joined;
    goes->alive = false;
    o->edge[e].alive = false;
    return 0;
}

/* Adds a vertex whose position is unknown, somewhere in the bounding box of some corners. */
static uint32_t add_inside(or_mesh *o, const uint32_t *v, uint32_t count)
{
    uint32_t w = or_add_vertex(o, (he_vec3){0, 0, 0});
    or_vertex *vertex = &o->vertex[w];
    vertex->inside = true;
    vertex->low = vertex->high = o->vertex[v[0]].at;
    for (uint32_t i = 1; i < count; i++) {
        he_vec3 p = o->vertex[v[i]].at;
        vertex->low =
            (he_vec3){fmin(vertex->low.x, p.x), fmin(vertex->low.y, p.y), fmin(vertex->low.z, p.z)};
        vertex->high = (he_vec3){fmax(vertex->high.x, p.x), fmax(vertex->high.y, p.y),
                                 fmax(vertex->high.z, p.z)};
    }
    return w;
}

uint64_t or_face_poke(or_mesh *o, uint32_t f, uint32_t start, const he_vec3 *at)
{
    or_face was = o->face[f];
    uint32_t w = at != NULL ? or_add_vertex(o, *at) : add_inside(o, was.v, was.count);
    for (uint32_t i = 0; i < was.count; i++) {
        const uint32_t corner[3] = {was.v[i], was.v[(i + 1) % was.count], w};
        if (was.v[i] == start) {
            memcpy(o->face[f].v, corner, sizeof corner);
            o->face[f].count = 3;
        } else {
            (void)or_add_face(o, corner, 3);
        }
    }
    return 0;
}

static bool is_side(const or_face *f, uint32_t a, uint32_t b)
{
    return or_after(f, a) == b || or_after(f, b) == a;
}

/* Returns whether the face f can have a diagonal that would double an edge: its two ends are
 * connected by an edge already, or by a possible diagonal of the face g. */
static bool can_double(const or_mesh *o, const or_face *f, const or_face *g)
{
    for (uint32_t i = 0; i < f->count; i++) {
        for (uint32_t k = 0; k < i && (g == NULL || or_place(g, f->v[i]) != OR_NONE); k++) {
            uint32_t a = f->v[i];
            uint32_t b = f->v[k];
            bool taken = g == NULL ? o->joined[a][b] != OR_NONE
                                   : or_place(g, b) != OR_NONE && !is_side(g, a, b);
            if (taken && !is_side(f, a, b)) {
                return true;
            }
        }
    }
    return false;
}

/* Notes that a face was cut into triangles. hedge chooses the diagonals, and whether it refuses
 * because a diagonal would double an edge. */
static void cut_up(or_mesh *o, uint32_t id, const or_face *was, uint32_t start)
{
    assert(o->cuts < OR_LIST);
    bool double_edge = can_double(o, was, NULL);
    for (uint32_t i = 0; i < o->cuts; i++) {
        double_edge = double_edge || can_double(o, was, &o->cut[i].was);
    }
    o->may |= double_edge ? OR_BIT(HE_DOUBLED_EDGE) : 0;
    o->cut[o->cuts].id = id;
    o->cut[o->cuts].was = *was;
    o->cut[o->cuts].start = start;
    o->cuts++;
}

uint64_t or_face_triangulate(or_mesh *o, const uint32_t *f, const uint32_t *start, uint32_t count)
{
    uint64_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < i; k++) {
            refused |= f[i] == f[k] ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
        }
    }
    for (uint32_t i = 0; i < count && refused == 0; i++) {
        cut_up(o, f[i], &o->face[f[i]], start[i]);
    }
    return refused;
}

uint64_t or_hole_fill(or_mesh *o, const uint32_t *loop, uint32_t count, or_fill method)
{
    or_face hole = {.alive = true, .count = count};
    assert(count <= OR_CORNERS);
    memcpy(hole.v, loop, count * sizeof *loop);
    for (uint32_t i = 0; i < count; i++) {
        if (or_place(&hole, loop[i]) != i) {
            return OR_BIT(HE_REPEATED_CORNER);
        }
    }
    switch (method) {
    case OR_POLYGON:
        (void)or_add_face(o, loop, count);
        break;
    case OR_FAN: {
        uint32_t w = add_inside(o, loop, count);
        for (uint32_t i = 0; i < count; i++) {
            (void)or_add_face(o, (uint32_t[]){loop[i], loop[(i + 1) % count], w}, 3);
        }
        break;
    }
    case OR_TRIANGULATE:
        cut_up(o, OR_NONE, &hole, OR_NONE);
        break;
    }
    return 0;
}
