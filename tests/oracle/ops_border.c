#include "oracle/oracle.h"

#include <assert.h>

uint64_t or_edge_delete(or_mesh *o, const uint32_t *e, uint32_t count, bool keep_isolated)
{
    uint32_t faces[2 * OR_LIST];
    uint32_t n = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        bool beside = false;
        for (uint32_t i = 0; i < count && o->face[f].alive; i++) {
            uint32_t a = o->edge[e[i]].a;
            uint32_t b = o->edge[e[i]].b;
            beside = beside || o->left[a][b] == f || o->left[b][a] == f;
        }
        if (beside) {
            faces[n++] = f;
        }
    }
    return or_face_delete(o, faces, n, keep_isolated);
}

/* --- edge_cut: cut edges divide the fans of faces around a vertex into parts --- */

/* A part of a fan of faces around a vertex v; the part gets a new vertex in place of v. */
typedef struct part {
    uint32_t v, start; /* the half-edge where the part begins */
    bool face[OR_FACES];
} part;

enum { PARTS = 40, AROUND = OR_CORNERS };

/* The faces around one vertex. Faces with equal numbers in `fan` are in one fan; faces with equal
 * numbers in `part` are not separated by cut edges. */
typedef struct around {
    uint32_t count, face[AROUND], fan[AROUND], part[AROUND];
} around;

static uint32_t index_of(const around *a, uint32_t f)
{
    uint32_t i = 0;
    while (i < a->count && a->face[i] != f) {
        i++;
    }
    return i;
}

static void unite(const around *a, uint32_t *number, uint32_t i, uint32_t k)
{
    uint32_t from = number[i];
    uint32_t to = number[k];
    for (uint32_t j = 0; j < a->count; j++) {
        number[j] = number[j] == from ? to : number[j];
    }
}

static around look_around(const or_mesh *o, uint32_t v, const bool cut[])
{
    around a = {.count = 0};
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && or_place(&o->face[f], v) != OR_NONE) {
            assert(a.count < AROUND);
            a.fan[a.count] = a.part[a.count] = a.count;
            a.face[a.count++] = f;
        }
    }
    for (uint32_t x = 0; x < o->vertices; x++) {
        if (o->left[v][x] != OR_NONE && o->left[x][v] != OR_NONE) {
            uint32_t i = index_of(&a, o->left[v][x]);
            uint32_t k = index_of(&a, o->left[x][v]);
            unite(&a, a.fan, i, k);
            if (!cut[o->joined[v][x]]) {
                unite(&a, a.part, i, k);
            }
        }
    }
    return a;
}

/* Returns which part of the fan of face i keeps the vertex v: the part with the face on the left of
 * the lowest cut edge (seen in the direction of half-edge 2e). */
static uint32_t part_that_stays(const or_mesh *o, const around *a, uint32_t i, uint32_t v,
                                const bool cut[])
{
    for (uint32_t e = 0; e < o->edges; e++) {
        if (cut[e] && (o->edge[e].a == v || o->edge[e].b == v)) {
            uint32_t k = index_of(a, o->left[o->edge[e].a][o->edge[e].b]);
            if (a->fan[k] == a->fan[i]) {
                return a->part[k];
            }
        }
    }
    return a->part[i];
}

static void add_parts(const or_mesh *o, uint32_t v, const bool cut[], part *parts, uint32_t *count)
{
    around a = look_around(o, v, cut);
    for (uint32_t x = 0; x < o->vertices; x++) {
        uint32_t f = o->left[v][x];
        if (f == OR_NONE || (o->left[x][v] != OR_NONE && !cut[o->joined[v][x]])) {
            continue;
        }
        uint32_t i = index_of(&a, f);
        if (a.part[i] == part_that_stays(o, &a, i, v, cut)) {
            continue;
        }
        assert(*count < PARTS);
        part *made = &parts[(*count)++];
        *made = (part){.v = v};
        made->start = 2 * o->joined[v][x] + (o->edge[o->joined[v][x]].a != v);
        for (uint32_t k = 0; k < a.count; k++) {
            made->face[a.face[k]] = a.part[k] == a.part[i];
        }
    }
}

/* Returns whether the edge e gets the new vertex of the part `p`. A cut edge becomes two edges; the
 * old one belongs to the part with the face on the left of half-edge 2e. */
static bool goes_along(const or_mesh *o, const part *p, uint32_t e, const bool cut[])
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t f = o->left[a][b];
    uint32_t g = o->left[b][a];
    return o->edge[e].alive && (a == p->v || b == p->v) &&
           ((f != OR_NONE && p->face[f]) || (!cut[e] && g != OR_NONE && p->face[g]));
}

static bool holds_together(const or_mesh *o, uint32_t v, uint32_t e, const bool cut[])
{
    around a = look_around(o, v, cut);
    uint32_t i = index_of(&a, o->left[o->edge[e].a][o->edge[e].b]);
    uint32_t k = index_of(&a, o->left[o->edge[e].b][o->edge[e].a]);
    return a.part[i] == a.part[k];
}

uint64_t or_edge_cut(or_mesh *o, const uint32_t *e, uint32_t count)
{
    static part parts[PARTS];
    bool cut[OR_EDGES] = {false};
    uint32_t n = 0;
    uint64_t refused = 0;
    for (uint32_t i = 0; i < count; i++) {
        const or_edge *edge = &o->edge[e[i]];
        cut[e[i]] = true;
        if (o->left[edge->a][edge->b] == OR_NONE || o->left[edge->b][edge->a] == OR_NONE) {
            refused |= OR_BIT(HE_BOUNDARY_EDGE);
        }
    }
    if (refused != 0) {
        return refused;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (holds_together(o, o->edge[e[i]].a, e[i], cut) &&
            holds_together(o, o->edge[e[i]].b, e[i], cut)) {
            refused |= OR_BIT(HE_DOUBLED_EDGE);
        }
    }
    for (uint32_t v = 0; v < o->vertices; v++) {
        bool end = false;
        for (uint32_t i = 0; i < count; i++) {
            end = end || o->edge[e[i]].a == v || o->edge[e[i]].b == v;
        }
        if (end) {
            add_parts(o, v, cut, parts, &n);
        }
    }
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t f = 0; f < o->faces; f++) {
            refused |= parts[i].face[f] && o->face[f].locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
        }
        for (uint32_t k = 0; k < o->edges; k++) {
            bool locked = goes_along(o, &parts[i], k, cut) && o->edge[k].locked;
            refused |= locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
        }
    }
    if (refused != 0) {
        return refused;
    }
    or_edge edges[OR_EDGES];
    for (uint32_t k = 0; k < o->edges; k++) {
        edges[k] = o->edge[k];
    }
    /* The parts get their vertices in the order of their lowest half-edge. */
    for (uint32_t done = 0; done < n; done++) {
        part *next = NULL;
        for (uint32_t i = 0; i < n; i++) {
            if (parts[i].start != OR_NONE && (next == NULL || parts[i].start < next->start)) {
                next = &parts[i];
            }
        }
        assert(next != NULL);
        uint32_t w = or_add_vertex(o, o->vertex[next->v].at);
        for (uint32_t k = 0; k < o->edges; k++) {
            if (goes_along(o, next, k, cut)) {
                *(o->edge[k].a == next->v ? &edges[k].a : &edges[k].b) = w;
            }
        }
        for (uint32_t f = 0; f < o->faces; f++) {
            if (next->face[f]) {
                o->face[f].v[or_place(&o->face[f], next->v)] = w;
            }
        }
        next->start = OR_NONE;
    }
    for (uint32_t k = 0; k < o->edges; k++) {
        o->edge[k] = edges[k];
    }
    return 0;
}

/* --- edge_weld --- */

static uint32_t became(uint32_t v, const uint32_t goes[2], const uint32_t stays[2])
{
    return v == goes[0] ? stays[0] : v == goes[1] ? stays[1] : v;
}

static bool is_beside(const or_mesh *o, uint32_t e, uint32_t v)
{
    return o->edge[e].a == v || o->edge[e].b == v;
}

/* Returns whether a vertex that is merged into another one, or an edge or face at it, is locked. */
static bool locked_at_end(const or_mesh *o, uint32_t goes, uint32_t stays, or_keep keep)
{
    bool moves = keep != OR_A && !or_same_point(o->vertex[goes].at, o->vertex[stays].at);
    bool locked = o->vertex[goes].locked || (moves && o->vertex[stays].locked);
    for (uint32_t e = 0; e < o->edges; e++) {
        locked = locked || (o->edge[e].alive && is_beside(o, e, goes) && o->edge[e].locked);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        locked = locked ||
                 (o->face[f].alive && or_place(&o->face[f], goes) != OR_NONE && o->face[f].locked);
    }
    return goes != stays && locked;
}

uint64_t or_edge_weld(or_mesh *o, uint32_t ea, uint32_t eb, or_keep keep)
{
    uint32_t stays[2] = {o->edge[ea].a, o->edge[ea].b};
    uint32_t goes[2] = {o->edge[eb].b, o->edge[eb].a};
    uint64_t refused = ea == eb ? OR_BIT(HE_REPEATED_ELEMENT) : 0;
    bool forward = o->left[stays[0]][stays[1]] != OR_NONE;
    bool backward = o->left[goes[1]][goes[0]] != OR_NONE;
    if ((forward && o->left[stays[1]][stays[0]] != OR_NONE) ||
        (backward && o->left[goes[0]][goes[1]] != OR_NONE)) {
        refused |= OR_BIT(HE_NOT_BOUNDARY);
    }
    if (refused != 0) {
        return refused;
    }
    /* The faces of the two edges must run along the joined edge in opposite directions. If they do
     * not, the two ends of one edge are exchanged. */
    if (forward != backward) {
        uint32_t swap = goes[0];
        goes[0] = goes[1];
        goes[1] = swap;
    }
    if (stays[0] == goes[1] || stays[1] == goes[0]) {
        return OR_BIT(HE_REPEATED_CORNER);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        for (int i = 0; i < 2 && o->face[f].alive; i++) {
            if (stays[i] != goes[i] && or_place(&o->face[f], stays[i]) != OR_NONE &&
                or_place(&o->face[f], goes[i]) != OR_NONE) {
                refused |= OR_BIT(HE_REPEATED_CORNER);
            }
        }
    }
    or_edge after[OR_EDGES];
    for (uint32_t e = 0; e < o->edges; e++) {
        after[e] = o->edge[e];
        after[e].a = became(o->edge[e].a, goes, stays);
        after[e].b = became(o->edge[e].b, goes, stays);
        for (uint32_t k = 0; k < e && after[e].alive; k++) {
            const or_edge *x = &after[e];
            const or_edge *y = &after[k];
            bool both = (e == ea && k == eb) || (e == eb && k == ea);
            if (y->alive && !both &&
                ((x->a == y->a && x->b == y->b) || (x->a == y->b && x->b == y->a))) {
                refused |= OR_BIT(HE_DOUBLED_EDGE);
            }
        }
    }
    for (int i = 0; i < 2; i++) {
        uint32_t x = stays[1 - i];
        uint32_t y = goes[1 - i];
        bool starts = o->left[stays[i]][x] != OR_NONE;
        if (stays[i] == goes[i] && or_closes_beside(o, stays[i], starts ? x : y, starts ? y : x)) {
            refused |= OR_BIT(HE_CLOSED_FAN);
        }
        refused |= locked_at_end(o, goes[i], stays[i], keep) ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
    }
    if (refused != 0) {
        return refused;
    }
    o->edge[eb].alive = false;
    for (uint32_t e = 0; e < o->edges; e++) {
        o->edge[e].a = became(o->edge[e].a, goes, stays);
        o->edge[e].b = became(o->edge[e].b, goes, stays);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        for (uint32_t i = 0; i < o->face[f].count; i++) {
            o->face[f].v[i] = became(o->face[f].v[i], goes, stays);
        }
    }
    for (int i = 0; i < 2; i++) {
        or_vertex *v = &o->vertex[stays[i]];
        or_vertex *w = &o->vertex[goes[i]];
        if (v != w) {
            v->at = keep == OR_A   ? v->at
                    : keep == OR_B ? w->at
                                   : (he_vec3){v->at.x / 2 + w->at.x / 2, v->at.y / 2 + w->at.y / 2,
                                               v->at.z / 2 + w->at.z / 2};
            v->near = true;
            w->alive = false;
        }
    }
    return 0;
}
