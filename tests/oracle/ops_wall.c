#include "oracle/oracle.h"

#include <assert.h>
#include <math.h>

/* --- edge_extrude --- */

uint64_t or_edge_extrude(or_mesh *o, const uint32_t *e, uint32_t count, he_vec3 by)
{
    /* `from` and `to` hold, for each vertex, the vertex before it and the one after it along the
     * hole. */
    uint32_t from[OR_VERTICES];
    uint32_t to[OR_VERTICES];
    uint32_t copy[OR_VERTICES];
    uint64_t refused = 0;
    uint32_t issued = o->vertices;
    for (uint32_t v = 0; v < issued; v++) {
        from[v] = to[v] = copy[v] = OR_NONE;
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = o->edge[e[i]].a;
        uint32_t b = o->edge[e[i]].b;
        if (o->left[a][b] != OR_NONE && o->left[b][a] != OR_NONE) {
            refused |= OR_BIT(HE_NOT_BOUNDARY);
            continue;
        }
        uint32_t begin = o->left[a][b] == OR_NONE ? a : b;
        uint32_t end = begin == a ? b : a;
        refused |= to[begin] != OR_NONE || from[end] != OR_NONE ? OR_BIT(HE_BRANCHING_CHAIN) : 0;
        to[begin] = end;
        from[end] = begin;
    }
    for (uint32_t v = 0; v < issued; v++) {
        he_vec3 at = o->vertex[v].at;
        bool finite = isfinite(at.x + by.x) && isfinite(at.y + by.y) && isfinite(at.z + by.z);
        bool moves = from[v] != OR_NONE || to[v] != OR_NONE;
        refused |= moves && !finite ? OR_BIT(HE_NOT_FINITE) : 0;
        if (from[v] != OR_NONE && to[v] != OR_NONE && or_closes_beside(o, v, from[v], to[v])) {
            refused |= OR_BIT(HE_CLOSED_FAN);
        }
    }
    if (refused != 0) {
        return refused;
    }
    for (uint32_t v = 0; v < issued; v++) {
        if (from[v] != OR_NONE || to[v] != OR_NONE) {
            he_vec3 at = o->vertex[v].at;
            copy[v] = or_add_vertex(o, (he_vec3){at.x + by.x, at.y + by.y, at.z + by.z});
        }
    }
    for (uint32_t v = 0; v < issued; v++) {
        if (to[v] != OR_NONE) {
            (void)or_add_face(o, (uint32_t[]){v, to[v], copy[to[v]], copy[v]}, 4);
        }
    }
    return 0;
}

/* --- edge_bevel --- */

static double distance(he_vec3 a, he_vec3 b)
{
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

/* Finds the neighbours of the vertex v in the fan of faces that contains its neighbour w,
 * counter-clockwise from w. Where the ring of neighbours crosses the hole, the result has v
 * itself. */
static uint32_t fan_from(const or_mesh *o, uint32_t v, uint32_t w, uint32_t out[OR_CORNERS])
{
    uint32_t n = 0;
    uint32_t x = or_turn(o, v, w);
    while (x != w && o->left[v][x] != OR_NONE) {
        assert(n < OR_CORNERS);
        out[n++] = x;
        x = or_turn(o, v, x);
    }
    if (x == w) {
        return n;
    }
    out[n++] = x;
    out[n++] = v;
    /* Goes back, clockwise, to the beginning of the fan. */
    x = w;
    while (o->left[x][v] != OR_NONE) {
        x = or_after(&o->face[o->left[x][v]], v);
    }
    while (x != w) {
        assert(n < OR_CORNERS);
        out[n++] = x;
        x = or_turn(o, v, x);
    }
    return n;
}

/* Changes the faces of one fan around the vertex v. In each of them the corner v is replaced by the
 * new vertices on the edges to the corners before and after v, if these edges are cut. */
static void cut_faces(or_mesh *o, uint32_t v, const uint32_t cut[OR_VERTICES])
{
    for (uint32_t f = 0; f < o->faces; f++) {
        or_face *face = &o->face[f];
        if (!face->alive || or_place(face, v) == OR_NONE) {
            continue;
        }
        uint32_t before = or_before(face, v);
        uint32_t after = or_after(face, v);
        if (cut[before] == OR_NONE && cut[after] == OR_NONE) {
            continue; /* belongs to another fan */
        }
        or_face was = *face;
        face->count = 0;
        for (uint32_t i = 0; i < was.count; i++) {
            assert(face->count + 2 <= OR_CORNERS);
            if (was.v[i] != v) {
                face->v[face->count++] = was.v[i];
                continue;
            }
            if (cut[before] != OR_NONE) {
                face->v[face->count++] = cut[before];
            }
            if (cut[after] != OR_NONE) {
                face->v[face->count++] = cut[after];
            }
        }
    }
}

uint64_t or_edge_bevel(or_mesh *o, uint32_t e, double width)
{
    const uint32_t ends[2] = {o->edge[e].a, o->edge[e].b};
    uint64_t refused = width > 0 ? 0 : OR_BIT(HE_BAD_VALUE);
    uint32_t f = o->left[ends[0]][ends[1]];
    uint32_t g = o->left[ends[1]][ends[0]];
    uint32_t fan[2][OR_CORNERS];
    uint32_t n[2];
    if (f == OR_NONE || g == OR_NONE) {
        return refused | OR_BIT(HE_BOUNDARY_EDGE);
    }
    bool locked = o->edge[e].locked || o->face[f].locked || o->face[g].locked;
    for (int i = 0; i < 2; i++) {
        uint32_t v = ends[i];
        n[i] = fan_from(o, v, ends[1 - i], fan[i]);
        refused |= n[i] < 2 ? OR_BIT(HE_LOW_DEGREE) : 0;
        locked = locked || (o->vertex[v].locked && !or_on_boundary(o, v));
        for (uint32_t k = 0; k < n[i]; k++) {
            uint32_t x = fan[i][k];
            if (x != v) {
                locked = locked || o->edge[o->joined[v][x]].locked;
                locked = locked || (o->left[v][x] != OR_NONE && o->face[o->left[v][x]].locked);
            }
        }
    }
    refused |= locked ? OR_BIT(HE_LOCKED_ELEMENT) : 0;
    if (refused != 0) {
        return refused;
    }
    uint32_t corners[2 * OR_CORNERS];
    uint32_t count = 0;
    for (int i = 0; i < 2; i++) {
        uint32_t v = ends[i];
        uint32_t cut[OR_VERTICES];
        for (uint32_t x = 0; x < OR_VERTICES; x++) {
            cut[x] = OR_NONE;
        }
        for (uint32_t k = 0; k < n[i]; k++) {
            uint32_t x = fan[i][k];
            if (x == v) {
                corners[count++] = v;
                continue;
            }
            he_vec3 a = o->vertex[v].at;
            he_vec3 b = o->vertex[x].at;
            double length = distance(a, b);
            double t = length > 0 ? fmin(width / length, 0.99) : 0.5;
            cut[x] = or_add_vertex(
                o, (he_vec3){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)});
            o->vertex[cut[x]].near = true;
            corners[count++] = cut[x];
            or_edge *edge = &o->edge[o->joined[v][x]];
            *(edge->a == v ? &edge->a : &edge->b) = cut[x];
        }
        cut_faces(o, v, cut);
        o->vertex[v].alive = or_on_boundary(o, v);
    }
    o->edge[e].alive = false;
    assert(count <= OR_CORNERS);
    (void)or_add_face(o, corners, count);
    return 0;
}
