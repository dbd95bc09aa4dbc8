#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- merging vertices --- */

/* Replaces the corners of a face by the vertices into which they are merged; if two consecutive
 * corners become equal, one is removed. */
static void draw_together(or_face *f, const uint32_t *to)
{
    uint32_t first = to[f->v[0]];
    uint32_t n = 0;
    for (uint32_t i = 0; i < f->count; i++) {
        uint32_t next = i + 1 < f->count ? to[f->v[i + 1]] : first;
        if (to[f->v[i]] != next) {
            f->v[n++] = to[f->v[i]];
        }
    }
    f->count = n;
}

static bool repeats(const or_face *f)
{
    for (uint32_t i = 0; i < f->count; i++) {
        if (or_place(f, f->v[i]) != i) {
            return true;
        }
    }
    return false;
}

/* Returns why the faces cannot meet at their edges, as a set of refusals. Faces in `skip` are
 * ignored. */
static uint64_t clashes(const or_mesh *o, const bool *skip)
{
    static uint8_t uses[OR_VERTICES][OR_VERTICES];
    uint64_t refused = 0;
    for (uint32_t a = 0; a < o->vertices; a++) {
        memset(uses[a], 0, o->vertices);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t i = 0; o->face[f].alive && !skip[f] && i < o->face[f].count; i++) {
            uses[o->face[f].v[i]][o->face[f].v[(i + 1) % o->face[f].count]]++;
        }
    }
    for (uint32_t a = 0; a < o->vertices; a++) {
        for (uint32_t b = 0; b < a; b++) {
            if (uses[a][b] + uses[b][a] > 2) {
                refused |= OR_BIT(HE_NONMANIFOLD_EDGE);
            } else if (uses[a][b] > 1 || uses[b][a] > 1) {
                refused |= OR_BIT(HE_ORIENTATION);
            }
        }
    }
    return refused;
}

static uint64_t weld_faces(or_mesh *o, const uint32_t *to)
{
    bool same[OR_FACES] = {false};
    bool none[OR_FACES] = {false};
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive) {
            draw_together(&o->face[f], to);
            o->face[f].alive = o->face[f].count >= 3;
            if (o->face[f].alive && repeats(&o->face[f])) {
                return OR_BIT(HE_REPEATED_CORNER);
            }
        }
    }
    bool any = false;
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t g = 0; g < f && o->face[f].alive; g++) {
            same[f] |= o->face[g].alive && or_same_cycle(&o->face[f], &o->face[g]);
        }
        any |= same[f];
    }
    uint64_t refused = clashes(o, same);
    /* If some faces become equal and others meet wrongly, hedge may report either. */
    refused |= refused != 0 && any ? clashes(o, none) : 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        o->face[f].alive &= !same[f];
    }
    return refused;
}

/* If several edges get the same two ends, only the edge with the lowest id stays. Edges that have
 * no face left are deleted. */
static void weld_edges(or_mesh *o, const uint32_t *to)
{
    for (uint32_t e = 0; e < o->edges; e++) {
        or_edge *edge = &o->edge[e];
        edge->a = edge->alive ? to[edge->a] : 0;
        edge->b = edge->alive ? to[edge->b] : 0;
        edge->alive &= edge->a != edge->b;
        for (uint32_t k = 0; k < e && edge->alive; k++) {
            const or_edge *other = &o->edge[k];
            edge->alive &= !other->alive || ((other->a != edge->a || other->b != edge->b) &&
                                             (other->a != edge->b || other->b != edge->a));
        }
    }
    (void)or_derive(o);
    for (uint32_t e = 0; e < o->edges; e++) {
        uint32_t a = o->edge[e].a;
        uint32_t b = o->edge[e].b;
        o->edge[e].alive &= o->left[a][b] != OR_NONE || o->left[b][a] != OR_NONE;
    }
}

static bool has_faces(const or_lists *was, uint32_t v)
{
    for (uint32_t e = 0; e < was->edges; e++) {
        if (was->edge[e].alive && (was->edge[e].a == v || was->edge[e].b == v)) {
            return true;
        }
    }
    return false;
}

static void weld_vertices(or_mesh *o, const or_lists *was, const uint32_t *to, bool mean)
{
    for (uint32_t v = 0; v < o->vertices; v++) {
        he_vec3 sum = {0, 0, 0};
        double n = 0;
        bool together = true;
        for (uint32_t x = 0; x < o->vertices; x++) {
            if (was->vertex[x].alive && to[x] == v) {
                he_vec3 p = was->vertex[x].at;
                sum = (he_vec3){sum.x + p.x, sum.y + p.y, sum.z + p.z};
                together &= or_same_point(p, was->vertex[v].at);
                n++;
            }
        }
        if (mean && n > 1 && !together) {
            o->vertex[v].at = (he_vec3){sum.x / n, sum.y / n, sum.z / n};
            o->vertex[v].near = true;
        }
        o->vertex[v].alive &= to[v] == v;
        if (n == 1 && has_faces(was, v) && or_degree(o, v) == 0) {
            o->vertex[v].alive = false;
        }
    }
}

static uint64_t locked_by_weld(const or_mesh *o, const or_lists *was, const uint32_t *to)
{
    bool locked = false;
    for (uint32_t v = 0; v < o->vertices; v++) {
        const or_vertex *old = &was->vertex[v];
        locked |= old->alive && old->locked &&
                  (!o->vertex[v].alive || !or_same_point(old->at, o->vertex[v].at));
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const or_edge *old = &was->edge[e];
        locked |= old->alive && old->locked &&
                  (!o->edge[e].alive || to[old->a] != old->a || to[old->b] != old->b);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *old = was->face[f];
        bool changed = !o->face[f].alive;
        for (uint32_t i = 0; i < old->count; i++) {
            changed |= old->alive && to[old->v[i]] != old->v[i];
        }
        locked |= old->alive && old->locked && changed;
    }
    return locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
}

uint64_t or_weld(or_mesh *o, const uint32_t to[OR_VERTICES], bool mean)
{
    or_lists *was = or_save(o);
    uint64_t refused = weld_faces(o, to);
    if (refused == 0) {
        weld_edges(o, to);
        refused = or_derive(o);
    }
    if (refused == 0) {
        weld_vertices(o, was, to, mean);
        refused = locked_by_weld(o, was, to);
    }
    if (refused != 0) {
        or_restore(o, was);
    } else {
        or_forget(was);
    }
    return refused;
}

bool or_weld_near(const or_mesh *o, double tolerance, uint32_t to[OR_VERTICES])
{
    bool clear = true;
    for (uint32_t v = 0; v < OR_VERTICES; v++) {
        to[v] = v;
        for (uint32_t x = 0; v < o->vertices && o->vertex[v].alive && x < v && to[v] == v; x++) {
            he_vec3 p = o->vertex[v].at;
            he_vec3 q = o->vertex[x].at;
            double d = sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) +
                            (p.z - q.z) * (p.z - q.z));
            if (o->vertex[x].alive && to[x] == x) {
                clear &= or_same_point(p, q) || fabs(d - tolerance) > 1e-9;
                to[v] = d <= tolerance ? x : v;
            }
        }
    }
    return clear;
}

/* --- separating bow-ties --- */

uint64_t or_check_separate(const or_mesh *o, uint32_t v, const uint32_t *starts, uint32_t count)
{
    bool locked = false;
    assert(count + 1 == or_fans(o, v) || (count == 0 && or_fans(o, v) < 2));
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t x = starts[i]; x != OR_NONE; x = or_turn(o, v, x)) {
            uint32_t f = o->left[v][x];
            locked |= o->edge[o->joined[v][x]].locked || (f != OR_NONE && o->face[f].locked);
        }
    }
    return locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
}

void or_separate(or_mesh *o, uint32_t v, const uint32_t *starts, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t u = or_add_vertex(o, o->vertex[v].at);
        for (uint32_t x = starts[i]; x != OR_NONE;) {
            or_edge *e = &o->edge[o->joined[v][x]];
            uint32_t f = o->left[v][x];
            *(e->a == v ? &e->a : &e->b) = u;
            x = or_turn(o, v, x);
            if (f != OR_NONE) {
                o->face[f].v[or_place(&o->face[f], v)] = u;
            }
        }
    }
    (void)or_derive(o);
}

uint64_t or_delete_isolated(or_mesh *o)
{
    bool gone[OR_VERTICES] = {false};
    for (uint32_t v = 0; v < o->vertices; v++) {
        gone[v] = o->vertex[v].alive && or_degree(o, v) == 0;
        if (gone[v] && o->vertex[v].locked) {
            return OR_BIT(HE_LOCKED_ELEMENT);
        }
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        o->vertex[v].alive &= !gone[v];
    }
    return 0;
}
