#include "oracle/oracle.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

static he_vec3 between(he_vec3 a, he_vec3 b, double t)
{
    return (he_vec3){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

static uint32_t left_of(const or_mesh *o, uint32_t a, uint32_t b)
{
    return o->left[a][b];
}

/* Inserts the vertex w as a corner of the face, between the corner a and the next corner. */
static void insert_after(or_face *f, uint32_t a, uint32_t w)
{
    uint32_t i = or_place(f, a) + 1;
    assert(f->count < OR_CORNERS);
    memmove(&f->v[i + 1], &f->v[i], (f->count - i) * sizeof f->v[0]);
    f->v[i] = w;
    f->count++;
}

static void remove_corner(or_face *f, uint32_t v)
{
    uint32_t i = or_place(f, v);
    memmove(&f->v[i], &f->v[i + 1], (f->count - i - 1) * sizeof f->v[0]);
    f->count--;
}

/* Splits the edge e by a new vertex at the fraction t of its length; the part that keeps the id has
 * the origin of half-edge 2e. Returns the new vertex. */
static uint32_t cut_edge(or_mesh *o, uint32_t e, double t)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t w = or_add_vertex(o, between(o->vertex[a].at, o->vertex[b].at, t));
    o->vertex[w].near = true;
    if (left_of(o, a, b) != OR_NONE) {
        insert_after(&o->face[left_of(o, a, b)], a, w);
    }
    if (left_of(o, b, a) != OR_NONE) {
        insert_after(&o->face[left_of(o, b, a)], b, w);
    }
    o->edge[e].b = w;
    return w;
}

uint64_t or_edge_bisect(or_mesh *o, uint32_t e, double t)
{
    (void)cut_edge(o, e, t);
    return 0;
}

/* Returns whether the edge or a face beside it is locked. */
static bool locked_at(const or_mesh *o, uint32_t e)
{
    uint32_t f = left_of(o, o->edge[e].a, o->edge[e].b);
    uint32_t g = left_of(o, o->edge[e].b, o->edge[e].a);
    return o->edge[e].locked || (f != OR_NONE && o->face[f].locked) ||
           (g != OR_NONE && o->face[g].locked);
}

uint64_t or_edge_join(or_mesh *o, uint32_t v)
{
    uint32_t ends[2];
    if (or_degree(o, v) != 2) {
        return OR_BIT(HE_WRONG_DEGREE);
    }
    (void)or_neighbours(o, v, ends, 2);
    uint64_t refused = 0;
    if (o->joined[ends[0]][ends[1]] != OR_NONE) {
        refused |= OR_BIT(HE_DOUBLED_EDGE);
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && or_place(&o->face[f], v) != OR_NONE && o->face[f].count == 3) {
            refused |= OR_BIT(HE_TRIANGLE_SIDE);
        }
    }
    if (o->vertex[v].locked || locked_at(o, o->joined[v][ends[0]]) ||
        locked_at(o, o->joined[v][ends[1]])) {
        refused |= OR_BIT(HE_LOCKED_ELEMENT);
    }
    if (refused != 0) {
        return refused;
    }
    o->either = true;
    o->joining[0] = o->joined[v][ends[0]];
    o->joining[1] = o->joined[v][ends[1]];
    for (uint32_t f = 0; f < o->faces; f++) {
        if (o->face[f].alive && or_place(&o->face[f], v) != OR_NONE) {
            remove_corner(&o->face[f], v);
        }
    }
    o->vertex[v].alive = false;
    return 0;
}

/* Returns the corner after b in the face left of the side a->b. If that side is split, the new
 * diagonal leads from the new vertex to this corner. */
static uint32_t corner_beyond(const or_mesh *o, uint32_t a, uint32_t b)
{
    uint32_t f = left_of(o, a, b);
    return f == OR_NONE ? OR_NONE : or_after(&o->face[f], b);
}

/* Cuts the triangle `corner` = w, b, c off the face a, w, b, c, ... The part that has the side
 * `keeper` keeps the id of the face. */
static void cut_corner(or_mesh *o, uint32_t f, const uint32_t corner[3], uint32_t keeper)
{
    or_face rest = o->face[f];
    remove_corner(&rest, corner[1]);
    if (keeper == corner[1]) {
        memcpy(o->face[f].v, corner, 3 * sizeof *corner);
        o->face[f].count = 3;
        (void)or_add_face(o, rest.v, rest.count);
    } else {
        o->face[f] = rest;
        (void)or_add_face(o, corner, 3);
    }
}

uint64_t or_edge_split(or_mesh *o, uint32_t e, double t)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t f = left_of(o, a, b);
    uint32_t g = left_of(o, b, a);
    uint32_t c = corner_beyond(o, a, b);
    uint32_t d = corner_beyond(o, b, a);
    if (c == d) {
        return OR_BIT(HE_DOUBLED_EDGE);
    }
    uint32_t w = cut_edge(o, e, t);
    if (f != OR_NONE) {
        cut_corner(o, f, (const uint32_t[3]){w, b, c}, a);
    }
    if (g != OR_NONE) {
        cut_corner(o, g, (const uint32_t[3]){w, a, d}, a);
    }
    return 0;
}

uint64_t or_edge_flip(or_mesh *o, uint32_t e)
{
    uint32_t a = o->edge[e].a;
    uint32_t b = o->edge[e].b;
    uint32_t f = left_of(o, a, b);
    uint32_t g = left_of(o, b, a);
    if (f == OR_NONE || g == OR_NONE) {
        return OR_BIT(HE_BOUNDARY_EDGE);
    }
    uint32_t c = or_after(&o->face[f], b);
    uint32_t d = or_after(&o->face[g], a);
    uint64_t refused = 0;
    if (c == d) {
        refused |= OR_BIT(HE_SAME_ENDS);
    } else if (o->joined[c][d] != OR_NONE) {
        refused |= OR_BIT(HE_DOUBLED_EDGE);
    }
    for (int side = 0; side < 2; side++) {
        uint32_t end = side == 0 ? a : b;
        if (or_degree(o, end) - 1 < (or_on_boundary(o, end) ? 2u : 3u)) {
            refused |= OR_BIT(HE_LOW_DEGREE);
        }
    }
    if (or_place(&o->face[f], d) != OR_NONE || or_place(&o->face[g], c) != OR_NONE) {
        refused |= OR_BIT(HE_REPEATED_CORNER) | OR_BIT(HE_SHARED_BOUNDARY);
    }
    refused |= locked_at(o, e) ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
    refused |= o->edge[e].feature ? OR_BIT(HE_FEATURE_EDGE) : 0;
    if (refused != 0) {
        return refused;
    }
    /* The face f: a, b, c, ... becomes a, d, c, ...   The face g: b, a, d, ... becomes b, c,
     * d, ... */
    o->face[f].v[or_place(&o->face[f], b)] = d;
    o->face[g].v[or_place(&o->face[g], a)] = c;
    o->edge[e].a = d;
    o->edge[e].b = c;
    return 0;
}

/* Returns whether the component is a tetrahedron: besides the two triangles u,v,c and v,u,d at the
 * edge from u to v there are only the triangles u,c,d and v,d,c. */
static bool is_tetrahedron(const or_mesh *o, uint32_t u, uint32_t v, uint32_t c, uint32_t d)
{
    uint32_t f = left_of(o, u, c);
    uint32_t g = left_of(o, v, d);
    return or_degree(o, u) == 3 && or_degree(o, v) == 3 && f != OR_NONE && g != OR_NONE &&
           o->face[f].count == 3 && or_after(&o->face[f], c) == d && o->face[g].count == 3 &&
           or_after(&o->face[g], d) == c;
}

static uint64_t link_condition(const or_mesh *o, uint32_t u, uint32_t v)
{
    uint32_t f = left_of(o, u, v);
    uint32_t g = left_of(o, v, u);
    uint32_t c = f != OR_NONE && o->face[f].count == 3 ? or_after(&o->face[f], v) : OR_NONE;
    uint32_t d = g != OR_NONE && o->face[g].count == 3 ? or_after(&o->face[g], u) : OR_NONE;
    bool holds = c == OR_NONE || c != d;
    for (uint32_t x = 0; x < o->vertices; x++) {
        if (o->joined[u][x] != OR_NONE && o->joined[v][x] != OR_NONE && x != c && x != d) {
            holds = false;
        }
    }
    if (or_on_boundary(o, u) && or_on_boundary(o, v) && f != OR_NONE && g != OR_NONE) {
        holds = false;
    }
    if (c != OR_NONE && left_of(o, c, v) == OR_NONE && left_of(o, u, c) == OR_NONE) {
        holds = false;
    }
    if (d != OR_NONE && left_of(o, d, u) == OR_NONE && left_of(o, v, d) == OR_NONE) {
        holds = false;
    }
    for (uint32_t i = 0; i < o->faces; i++) {
        if (o->face[i].alive && i != f && i != g && or_place(&o->face[i], u) != OR_NONE &&
            or_place(&o->face[i], v) != OR_NONE) {
            holds = false;
        }
    }
    if (c != OR_NONE && d != OR_NONE && c != d && is_tetrahedron(o, u, v, c, d)) {
        holds = false;
    }
    return holds ? 0 : OR_BIT(HE_LINK_CONDITION);
}

static uint32_t features_at(const or_mesh *o, uint32_t v)
{
    uint32_t n = 0;
    for (uint32_t e = 0; e < o->edges; e++) {
        n += o->edge[e].alive && o->edge[e].feature && (o->edge[e].a == v || o->edge[e].b == v);
    }
    return n;
}

/* Returns which locks and feature edges forbid merging the vertex u into the vertex v. */
static uint64_t marks_about(const or_mesh *o, uint32_t u, uint32_t v, bool moves)
{
    uint64_t refused = 0;
    bool locked = o->vertex[u].locked || (moves && o->vertex[v].locked);
    for (uint32_t e = 0; e < o->edges; e++) {
        locked |= o->edge[e].alive && (o->edge[e].a == u || o->edge[e].b == u) && locked_at(o, e);
    }
    refused |= locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;

    bool along = o->edge[o->joined[u][v]].feature;
    bool spoilt = features_at(o, u) != (along ? 2u : 0u);
    for (uint32_t x = 0; x < o->vertices; x++) {
        bool triangle =
            x != u && x != v && o->joined[u][x] != OR_NONE && o->joined[v][x] != OR_NONE;
        spoilt |= triangle && o->edge[o->joined[u][x]].feature;
    }
    spoilt |= moves && features_at(o, v) > 0 && !(along && features_at(o, v) == 2);
    return refused | (spoilt ? OR_BIT(HE_FEATURE_EDGE) : 0);
}

/* Returns whether the point at the fraction t of the way between the vertices u and v differs from
 * v, no matter how its coordinates are rounded. */
static bool surely_off(double u, double v, double t)
{
    double most = 8 * DBL_EPSILON * fmax(fabs(u), fabs(v)) + 8 * DBL_TRUE_MIN;
    return (1 - t) * fabs(u - v) > most;
}

static bool surely_moves(he_vec3 u, he_vec3 v, double t)
{
    return surely_off(u.x, v.x, t) || surely_off(u.y, v.y, t) || surely_off(u.z, v.z, t);
}

uint64_t or_check_collapse(const or_mesh *o, const or_collapse *c, uint64_t *doubt)
{
    he_vec3 from = o->vertex[c->u].at;
    he_vec3 at = o->vertex[c->v].at;
    bool apart = !or_same_point(from, at) || o->vertex[c->v].near;
    bool can_move = c->to != NULL ? !or_same_point(*c->to, at) : c->t != 1 && apart;
    bool moves = can_move && (c->to != NULL || surely_moves(from, at, c->t));
    uint64_t refused = link_condition(o, c->u, c->v) | marks_about(o, c->u, c->v, moves);
    *doubt |= marks_about(o, c->u, c->v, can_move) & ~refused;
    return refused;
}

uint64_t or_edge_collapse(or_mesh *o, const or_collapse *c)
{
    uint64_t doubt = 0;
    uint64_t refused = or_check_collapse(o, c, &doubt);
    if (refused != 0) {
        return refused | doubt;
    }
    if (doubt != 0) {
        or_doubt(o, or_save(o), doubt);
    }
    or_draw_together(o, c);
    return 0;
}

void or_draw_together(or_mesh *o, const or_collapse *c)
{
    const uint32_t u = c->u, v = c->v;
    const he_vec3 *to = c->to;
    he_vec3 from = o->vertex[u].at;
    he_vec3 at = o->vertex[v].at;
    o->edge[o->joined[u][v]].alive = false;
    for (uint32_t i = 0; i < o->faces; i++) {
        or_face *face = &o->face[i];
        if (!face->alive || or_place(face, u) == OR_NONE) {
            continue;
        }
        if (or_place(face, v) == OR_NONE) {
            face->v[or_place(face, u)] = v;
        } else if (face->count > 3) {
            remove_corner(face, u);
        } else {
            face->alive = false;
        }
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        or_edge *edge = &o->edge[e];
        if (edge->alive && (edge->a == u || edge->b == u)) {
            uint32_t other = edge->a == u ? edge->b : edge->a;
            if (o->joined[v][other] != OR_NONE) {
                edge->alive =
                    false; /* an edge connects the vertex v with this neighbour of u already */
            } else {
                *(edge->a == u ? &edge->a : &edge->b) = v;
            }
        }
    }
    o->vertex[u].alive = false;
    o->vertex[v].near = to == NULL && (o->vertex[v].near || !or_same_point(from, at));
    o->vertex[v].at = to != NULL ? *to : between(from, at, c->t);
}
