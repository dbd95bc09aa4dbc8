#include "oracle/oracle.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

/* The state of one step of subdivision. Old vertices are moved last, since everything else is
 * computed from their old positions. */
typedef struct refining {
    or_mesh *o;
    or_scheme scheme;
    uint32_t vertices, faces;  /* numbers of vertices and faces before the step of subdivision */
    uint32_t middle[OR_EDGES]; /* the id of the new vertex on each edge */
    /* The id of the new vertex in each face; OR_NONE if the face gets none. */
    uint32_t centre[OR_FACES];
    he_vec3 mean[OR_FACES];
    he_vec3 moved[OR_VERTICES];
} refining;

static he_vec3 scaled(double t, he_vec3 p)
{
    return (he_vec3){t * p.x, t * p.y, t * p.z};
}

static he_vec3 sum(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static bool is_sharp(const or_mesh *o, uint32_t a, uint32_t b)
{
    return o->left[a][b] == OR_NONE || o->left[b][a] == OR_NONE || o->edge[o->joined[a][b]].feature;
}

static uint32_t faces_at(const or_mesh *o, uint32_t v)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < or_degree(o, v); i++) {
        count += o->left[v][o->around[v][i]] != OR_NONE;
    }
    return count;
}

/* Returns whether another triangle has the same three vertices. */
static bool is_pillow(const or_mesh *o, const or_face *f)
{
    uint32_t beside = o->left[f->v[1]][f->v[0]];
    return f->count == 3 && beside != OR_NONE && o->face[beside].count == 3 &&
           o->left[f->v[2]][f->v[1]] == beside;
}

static uint64_t check(const or_mesh *o, or_scheme scheme)
{
    bool triangles = scheme == OR_LOOP || scheme == OR_SQRT3;
    uint64_t refused = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        const or_face *face = &o->face[f];
        if (!face->alive) {
            continue;
        }
        refused |= triangles && face->count != 3 ? OR_BIT(HE_NOT_TRIANGLE) : 0;
        refused |= scheme != OR_CATMULL_CLARK && is_pillow(o, face) ? OR_BIT(HE_DOUBLED_EDGE) : 0;
    }
    for (uint32_t e = 0; e < o->edges && scheme == OR_SQRT3; e++) {
        const or_edge *edge = &o->edge[e];
        if (edge->alive && !is_sharp(o, edge->a, edge->b)) {
            bool locked = edge->locked || o->face[o->left[edge->a][edge->b]].locked ||
                          o->face[o->left[edge->b][edge->a]].locked;
            refused |= locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
        }
    }
    return refused;
}

static uint32_t add_near(or_mesh *o, he_vec3 at)
{
    uint32_t v = or_add_vertex(o, at);
    o->vertex[v].near = true;
    return v;
}

static void find_means(refining *r)
{
    for (uint32_t f = 0; f < r->faces; f++) {
        const or_face *face = &r->o->face[f];
        r->mean[f] = (he_vec3){0, 0, 0};
        for (uint32_t i = 0; i < face->count && face->alive; i++) {
            r->mean[f] = sum(r->mean[f], scaled(1.0 / face->count, r->o->vertex[face->v[i]].at));
        }
    }
}

static he_vec3 on_edge(const refining *r, uint32_t a, uint32_t b)
{
    const or_mesh *o = r->o;
    he_vec3 ends = sum(o->vertex[a].at, o->vertex[b].at);
    if (r->scheme == OR_LINEAR || is_sharp(o, a, b)) {
        return scaled(0.5, ends);
    }
    uint32_t f = o->left[a][b];
    uint32_t g = o->left[b][a];
    if (r->scheme == OR_CATMULL_CLARK) {
        return scaled(0.25, sum(ends, sum(r->mean[f], r->mean[g])));
    }
    he_vec3 across =
        sum(o->vertex[or_before(&o->face[f], a)].at, o->vertex[or_before(&o->face[g], b)].at);
    return sum(scaled(0.375, ends), scaled(0.125, across));
}

static he_vec3 smooth(const refining *r, uint32_t v)
{
    const or_mesh *o = r->o;
    double n = or_degree(o, v);
    double c = 0.375 + 0.25 * cos(2 * PI / n);
    double share = r->scheme == OR_LOOP ? 0.625 - c * c : (4 - 2 * cos(2 * PI / n)) / 9;
    he_vec3 ring = {0, 0, 0};
    he_vec3 means = {0, 0, 0};
    for (uint32_t i = 0; i < or_degree(o, v); i++) {
        uint32_t x = o->around[v][i];
        ring = sum(ring, scaled(1 / n, o->vertex[x].at));
        means = sum(means, scaled(1 / n, r->mean[o->left[v][x]]));
    }
    if (r->scheme == OR_CATMULL_CLARK) {
        he_vec3 middles = scaled(0.5, sum(o->vertex[v].at, ring));
        return scaled(1 / n, sum(sum(means, scaled(2, middles)), scaled(n - 3, o->vertex[v].at)));
    }
    return sum(scaled(1 - share, o->vertex[v].at), scaled(share, ring));
}

static he_vec3 new_place(const refining *r, uint32_t v)
{
    const or_mesh *o = r->o;
    uint32_t sharp = 0;
    he_vec3 beside = {0, 0, 0};
    if (r->scheme == OR_LINEAR || o->vertex[v].locked || or_degree(o, v) == 0 ||
        (or_on_boundary(o, v) && faces_at(o, v) == 1)) {
        return o->vertex[v].at;
    }
    for (uint32_t i = 0; i < or_degree(o, v); i++) {
        uint32_t x = o->around[v][i];
        if (is_sharp(o, v, x)) {
            sharp++;
            beside = sum(beside, o->vertex[x].at);
        }
    }
    if (sharp < 2) {
        return smooth(r, v);
    }
    if (sharp > 2 || r->scheme == OR_SQRT3) {
        return o->vertex[v].at;
    }
    return sum(scaled(0.75, o->vertex[v].at), scaled(0.125, beside));
}

static void put(or_mesh *o, uint32_t f, const uint32_t *v, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        o->face[f].v[i] = v[i];
    }
    o->face[f].count = count;
}

/* Replaces face f by its parts; the part at the corner `start` is the first. */
static void refine_face(refining *r, uint32_t f, uint32_t start)
{
    or_mesh *o = r->o;
    or_face was = o->face[f];
    uint32_t inner[3];
    uint32_t place = or_place(&was, start);
    for (uint32_t i = 0; i < was.count; i++) {
        uint32_t v = was.v[(place + i) % was.count];
        uint32_t after = or_after(&was, v);
        uint32_t before = or_before(&was, v);
        uint32_t m = r->middle[o->joined[v][after]];
        uint32_t l = r->middle[o->joined[before][v]];
        uint32_t c = r->centre[f];
        uint32_t part[4] = {v, m, c == OR_NONE ? l : c, l};
        uint32_t count = c == OR_NONE ? 3 : 4;
        if (r->scheme == OR_SQRT3) {
            part[1] = is_sharp(o, v, after) ? after : r->centre[o->left[after][v]];
            count = 3;
        } else if (c == OR_NONE) {
            inner[i] = m;
        }
        if (i == 0) {
            put(o, f, part, count);
        } else {
            (void)or_add_face(o, part, count);
        }
    }
    if (r->centre[f] == OR_NONE) {
        (void)or_add_face(o, inner, 3);
    }
}

static void refine_edges(refining *r)
{
    or_mesh *o = r->o;
    for (uint32_t e = 0; e < o->edges; e++) {
        or_edge *edge = &o->edge[e];
        if (!edge->alive) {
            continue;
        }
        if (r->scheme != OR_SQRT3) {
            edge->b = r->middle[e];
        } else if (!is_sharp(o, edge->a, edge->b)) {
            uint32_t f = o->left[edge->a][edge->b];
            edge->a = r->centre[o->left[edge->b][edge->a]];
            edge->b = r->centre[f];
        }
    }
}

uint64_t or_subdivide(or_mesh *o, or_scheme scheme, const uint32_t *start)
{
    static refining r;
    uint64_t refused = check(o, scheme);
    if (refused != 0) {
        return refused;
    }
    r.o = o;
    r.scheme = scheme;
    r.vertices = o->vertices;
    r.faces = o->faces;
    find_means(&r);
    for (uint32_t v = 0; v < r.vertices; v++) {
        r.moved[v] = o->vertex[v].alive ? new_place(&r, v) : o->vertex[v].at;
    }
    for (uint32_t e = 0; e < o->edges && scheme != OR_SQRT3; e++) {
        if (o->edge[e].alive) {
            r.middle[e] = add_near(o, on_edge(&r, o->edge[e].a, o->edge[e].b));
        }
    }
    for (uint32_t f = 0; f < r.faces; f++) {
        bool has = scheme == OR_CATMULL_CLARK || scheme == OR_SQRT3 ||
                   (scheme == OR_LINEAR && o->face[f].count != 3);
        r.centre[f] = has && o->face[f].alive ? add_near(o, r.mean[f]) : OR_NONE;
    }
    for (uint32_t f = 0; f < r.faces; f++) {
        if (o->face[f].alive) {
            refine_face(&r, f, start[f]);
        }
    }
    refine_edges(&r);
    for (uint32_t v = 0; v < r.vertices; v++) {
        o->vertex[v].at = r.moved[v];
        o->vertex[v].near = o->vertex[v].alive;
    }
    return 0;
}
