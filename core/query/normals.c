#include "mesh/walk.h"
#include "query/geometry.h"
#include "query/ring.h"

#include <stdlib.h>

/* Areas differ beyond what a double spans only in meshes nobody draws; this keeps their faces from
 * vanishing where there are no larger ones. */
static double area_weight(const he_ring *r, int exponent, int unit)
{
    return fmax(ldexp(0.5 * he_vec3_length(r->vector), 2 * exponent - unit), DBL_MIN);
}

/* The binary exponent of the largest area about a vertex, from which the weights are taken. */
static int area_unit(const he_mesh *m, he_vertex v)
{
    int unit = INT32_MIN;
    uint32_t first = m->c.vertex_halfedge[v.i], h = first, budget = he_ring_budget(m);
    do {
        he_vec3 normal;
        int exponent, own;
        if (m->c.face[h] < m->c.faces.issued) {
            he_ring r = he_ring_of_face(m, (he_face){m->c.face[h]}, &exponent);
            if (he_ring_normal(&r, &normal)) {
                frexp(he_vec3_length(r.vector), &own);
                unit = own + 2 * exponent > unit ? own + 2 * exponent : unit;
            }
        }
        h = m->c.prev[h] ^ 1u;
    } while (h != first && h < he_ring_budget(m) && budget-- > 0);
    return unit;
}

bool he_vertex_normal(const he_mesh *m, he_vertex v, he_weight weight, he_vec3 *out)
{
    he_vec3 sum = {0, 0, 0};
    uint32_t first = m->c.vertex_halfedge[v.i], h = first, budget = he_ring_budget(m);
    if (first == HE_NONE) {
        return he_vec3_normalise(sum, out);
    }
    int unit = weight == HE_WEIGHT_AREA ? area_unit(m, v) : 0;
    do {
        he_vec3 normal;
        int exponent;
        if (m->c.face[h] < m->c.faces.issued) {
            he_ring r = he_ring_of_face(m, (he_face){m->c.face[h]}, &exponent);
            if (he_ring_normal(&r, &normal)) {
                double w = 1;
                switch (weight) {
                case HE_WEIGHT_AREA:
                    w = area_weight(&r, exponent, unit);
                    break;
                case HE_WEIGHT_ANGLE:
                    w = he_corner_angle(m, (he_halfedge){h});
                    break;
                case HE_WEIGHT_UNIFORM:
                    break;
                }
                sum = he_vec3_add(sum, he_vec3_scale(normal, w));
            }
        }
        h = m->c.prev[h] ^ 1u;
    } while (h != first && h < he_ring_budget(m) && budget-- > 0);
    return he_vec3_normalise(sum, out);
}

/* A triangle of ordinary size. Most faces of most meshes are, and whole-mesh loops treat those
 * without a call or a square root more than needed. */
typedef struct triangle {
    uint32_t a, b, c; /* corners from the stored half-edge on */
    he_vec3 u, v;     /* a to b, a to c */
    he_vec3 vector;   /* u x v: twice the area vector */
    double square;    /* its length squared */
} triangle;

/* False where the face has other than three corners, is degenerate, or has coordinates whose
 * products would overflow or vanish, and where links are broken: the general way decides those. */
static inline bool plain_triangle(const he_mesh *m, uint32_t h, triangle *out)
{
    const uint32_t end = 2u * m->c.edges.issued, vertices = m->c.vertices.issued;
    if (h >= end) {
        return false;
    }
    uint32_t i = m->c.next[h];
    uint32_t j = i < end ? m->c.next[i] : HE_NONE;
    if (j >= end || m->c.next[j] != h) {
        return false;
    }
    /* Targets share a cache line with the origins; the third half-edge is only looked at. */
    triangle t = {.a = m->c.origin[h], .b = m->c.origin[h ^ 1u], .c = m->c.origin[i ^ 1u]};
    if (t.a >= vertices || t.b >= vertices || t.c >= vertices) {
        return false;
    }
    he_vec3 p = m->c.position[t.a];
    t.u = he_vec3_sub(m->c.position[t.b], p);
    t.v = he_vec3_sub(m->c.position[t.c], p);
    t.vector = he_vec3_cross(t.u, t.v);
    t.square = he_vec3_dot(t.vector, t.vector);
    double reach = he_vec3_dot(t.u, t.u) * he_vec3_dot(t.v, t.v);
    *out = t;
    return reach > HE_LEAST_PRODUCT && reach < HE_MOST_PRODUCT &&
           t.square > HE_RING_NOISE * 3 * reach;
}

/* Ask for what the triangles some way ahead will need: their links first, and nearer by what those
 * lead to. Where ids are in no order every access misses the caches, and this overlaps the misses.
 */
static inline void look_ahead(const he_mesh *m, uint32_t f)
{
    enum { LINKS = 24, CORNERS = 12 };
    const uint32_t end = 2u * m->c.edges.issued;
    if (m->c.faces.issued - f <= LINKS) {
        return;
    }
    uint32_t far = m->c.face_halfedge[f + LINKS], near = m->c.face_halfedge[f + CORNERS];
    if (far < end) {
        __builtin_prefetch(&m->c.next[far]);
        __builtin_prefetch(&m->c.origin[far]);
    }
    if (near < end && m->c.next[near] < end) {
        __builtin_prefetch(&m->c.next[m->c.next[near]]);
        __builtin_prefetch(&m->c.origin[m->c.next[near]]);
        __builtin_prefetch(&m->c.position[m->c.origin[near]]);
        __builtin_prefetch(&m->c.position[m->c.origin[near ^ 1u]]);
    }
}

he_status he_face_normals(const he_mesh *m, he_vec3 *out, he_error *err)
{
    uint32_t budget = he_ring_budget(m);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        look_ahead(m, f);
        uint32_t h = m->c.face_halfedge[f];
        triangle t;
        if (plain_triangle(m, h, &t)) {
            out[f] = he_vec3_scale(t.vector, 1 / sqrt(t.square));
            continue;
        }
        if (h == HE_DEAD) {
            out[f] = (he_vec3){0, 0, 0};
            continue;
        }
        int exponent;
        he_ring r = he_ring_measure(m, h, &budget, &exponent);
        if (r.degree == 0) {
            return he_ring_corrupt(f, err);
        }
        he_ring_normal(&r, &out[f]);
    }
    return HE_OK;
}

static void add_to(he_vec3 *sum, he_vec3 normal, double weight)
{
    *sum = he_vec3_add(*sum, he_vec3_scale(normal, weight));
}

/* Add a triangle's share to its corners. `half` is half the unit of area, 0 where a double cannot
 * hold it; false when the share would vanish in that unit. */
static bool share_triangle(const triangle *t, he_weight weight, double half, he_vec3 *out)
{
    if (weight == HE_WEIGHT_AREA) {
        he_vec3 share = he_vec3_scale(t->vector, half);
        if (!(he_vec3_extent(share) > HE_LEAST_PRODUCT)) {
            return false;
        }
        out[t->a] = he_vec3_add(out[t->a], share);
        out[t->b] = he_vec3_add(out[t->b], share);
        out[t->c] = he_vec3_add(out[t->c], share);
        return true;
    }
    double root = sqrt(t->square), at_a = 1, at_b = 1, at_c = 1;
    if (weight == HE_WEIGHT_ANGLE) {
        /* At each corner the cross product of its two sides is as long as `vector`. */
        he_vec3 w = he_vec3_sub(t->v, t->u);
        at_a = atan2(root, he_vec3_dot(t->u, t->v));
        at_b = atan2(root, -he_vec3_dot(t->u, w));
        at_c = atan2(root, he_vec3_dot(t->v, w));
    }
    he_vec3 normal = he_vec3_scale(t->vector, 1 / root);
    add_to(&out[t->a], normal, at_a);
    add_to(&out[t->b], normal, at_b);
    add_to(&out[t->c], normal, at_c);
    return true;
}

he_status he_vertex_normals(const he_mesh *m, he_weight weight, he_vec3 *out, he_error *err)
{
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        out[v] = (he_vec3){0, 0, 0};
    }
    he_box box;
    he_mesh_box(m, &box);
    int unit = 2 * he_exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    double half = abs(unit) < 1000 ? ldexp(0.5, -unit) : 0;
    uint32_t budget = he_ring_budget(m);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        uint32_t first = m->c.face_halfedge[f], h = first;
        triangle t;
        if (plain_triangle(m, first, &t) && share_triangle(&t, weight, half, out)) {
            continue;
        }
        if (first == HE_DEAD) {
            continue;
        }
        int exponent;
        he_vec3 normal;
        he_ring r = he_ring_measure(m, first, &budget, &exponent);
        if (r.degree == 0) {
            return he_ring_corrupt(f, err);
        }
        if (!he_ring_normal(&r, &normal)) {
            continue;
        }
        if (weight == HE_WEIGHT_AREA) {
            normal = he_vec3_scale(normal, area_weight(&r, exponent, unit));
        }
        do {
            double w = weight == HE_WEIGHT_ANGLE ? he_corner_angle(m, (he_halfedge){h}) : 1;
            add_to(&out[m->c.origin[h]], normal, w);
            h = m->c.next[h];
        } while (h != first);
    }
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        he_vec3_normalise(out[v], &out[v]);
    }
    return HE_OK;
}
