#include "base/parallel.h"
#include "geometry/geometry.h"
#include "geometry/ring.h"
#include "mesh/walk.h"

#include <stdlib.h>

/* Returns the weight that HE_WEIGHT_AREA gives to a face: the face's area, divided by 2^unit, but
 * at least DBL_MIN. The lower limit matters only in extreme meshes, where the ratio of the areas of
 * two faces at a vertex exceeds the range of a double: the weight of the smaller face would become
 * 0. */
static double area_weight(const he_ring *r, int exponent, int unit)
{
    return fmax(ldexp(0.5 * he_vec3_length(r->vector), 2 * exponent - unit), DBL_MIN);
}

/* Returns the binary exponent of twice the largest area of a face around a vertex. The weights of
 * the faces are taken relative to it (`unit` of area_weight). */
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

/* A triangular face of ordinary size. Most faces of most meshes are such triangles. Loops over all
 * faces of a mesh compute such a triangle without a call and with few square roots, and call the
 * general function he_ring_measure for all other faces. */
typedef struct triangle {
    /* ids of the corners' vertices; `a` is the origin of the face's stored half-edge */
    uint32_t a, b, c;
    he_vec3 u, v;   /* vectors from a to b and from a to c */
    he_vec3 vector; /* u x v: twice the area vector */
    double square;  /* squared length of `vector` */
} triangle;

/* Returns true if a triangle is not degenerate, and products of its coordinates neither overflow
 * nor underflow. `square` is the squared length of twice the triangle's area vector; `reach` is the
 * product of the squared lengths of two sides. */
static inline bool is_plain(double square, double reach)
{
    return (reach > HE_LEAST_PRODUCT) & (reach < HE_MOST_PRODUCT) &
           (square > HE_RING_NOISE * 3 * reach);
}

/* Computes the triangle to the left of half-edge h. Returns false if the face has not three
 * corners, is degenerate, has coordinates whose products would overflow or underflow, or if links
 * are broken. The caller then calls the general function he_ring_measure. */
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
    /* The targets of the half-edges h and i are read as the origins of their twins, because the
     * origins of a half-edge and its twin are in one cache line. The third half-edge, j, is read
     * only to see that it leads back to h. */
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
    return is_plain(t.square, reach);
}

/* --- normals of faces --- */

typedef struct faces {
    const he_mesh *m;
    /* True if all faces of the mesh are triangles. The third half-edge of a face is then not read,
     * because it certainly leads back to the first. */
    bool triangles;
    he_vec3 *out;
} faces;

/* Returns true if all faces are triangles. Every face has at least three corners (invariant I7 of
 * mesh.h), so all faces are triangles if the mean number of corners is three. */
static bool are_triangles(const he_content *c)
{
    return 2 * (uint64_t)c->edges.live - c->boundary_halfedges == 3 * (uint64_t)c->faces.live;
}

typedef struct triple {
    /* ids of the vertices of a triangular face; all HE_NONE if the face is deleted, is no triangle
     * or has broken links */
    uint32_t a, b, c;
} triple;

static inline triple find_triple(const he_content *c, uint32_t f, bool triangles)
{
    const uint32_t end = 2u * c->edges.issued, vertices = c->vertices.issued;
    const triple none = {HE_NONE, HE_NONE, HE_NONE};
    uint32_t h = c->face_halfedge[f], i = h < end ? c->next[h] : HE_NONE;
    if (i >= end) {
        return none;
    }
    if (!triangles) {
        uint32_t j = c->next[i];
        if (j >= end || c->next[j] != h) {
            return none;
        }
    }
    /* The targets of the half-edges h and i are read as the origins of their twins, because the
     * origins of a half-edge and its twin are in one cache line. */
    triple t = {c->origin[h], c->origin[h ^ 1u], c->origin[i ^ 1u]};
    return t.a < vertices && t.b < vertices && t.c < vertices ? t : none;
}

/* Where the ids of a mesh are in no spatial order, each read of a face's links and of its corners'
 * positions waits for memory. Each read needs the result of the one before, so the memory is
 * prefetched in three steps, these numbers of faces ahead. */
enum { LINKS_AHEAD = 24, CORNERS_AHEAD = 12, POSITIONS_AHEAD = 6 };

static inline void prefetch_ahead(const he_content *c, size_t f, size_t to, bool triangles)
{
    const uint32_t end = 2u * c->edges.issued;
    if (f + LINKS_AHEAD < to) {
        const uint32_t h = c->face_halfedge[f + LINKS_AHEAD];
        if (h < end) {
            __builtin_prefetch(&c->next[h]);
            __builtin_prefetch(&c->origin[h]);
        }
    }
    if (f + CORNERS_AHEAD < to) {
        const uint32_t h = c->face_halfedge[f + CORNERS_AHEAD], i = h < end ? c->next[h] : HE_NONE;
        if (i < end) {
            __builtin_prefetch(&c->origin[i ^ 1u]);
            if (!triangles) {
                __builtin_prefetch(&c->next[i]);
            }
        }
    }
    if (f + POSITIONS_AHEAD < to) {
        const triple t = find_triple(c, (uint32_t)(f + POSITIONS_AHEAD), triangles);
        if (t.a != HE_NONE) {
            __builtin_prefetch(&c->position[t.a]);
            __builtin_prefetch(&c->position[t.b]);
            __builtin_prefetch(&c->position[t.c]);
        }
    }
}

/* Returns true if successive faces of the range mostly have their corners far from one another in
 * memory. Looks at a sample of the faces. */
static bool is_scattered(const he_content *c, size_t from, size_t to)
{
    enum { SAMPLES = 32, FAR = 4096 };
    const uint32_t end = 2u * c->edges.issued;
    size_t step = (to - from) / SAMPLES, apart = 0, seen = 0;
    for (size_t f = from; step > 0 && f + 1 < to; f += step) {
        const uint32_t h = c->face_halfedge[f], k = c->face_halfedge[f + 1];
        if (h < end && k < end) {
            const uint32_t a = c->origin[h], b = c->origin[k];
            apart += (a > b ? a - b : b - a) > FAR;
            seen++;
        }
    }
    return 2 * apart > seen;
}

static he_status one_normal(const he_mesh *m, uint32_t f, uint32_t *budget, he_vec3 *out,
                            he_error *err)
{
    *out = (he_vec3){0, 0, 0};
    if (m->c.face_halfedge[f] != HE_DEAD) {
        int exponent;
        he_ring r = he_ring_measure(m, m->c.face_halfedge[f], budget, &exponent);
        if (r.degree == 0) {
            return he_ring_corrupt(f, err);
        }
        he_ring_normal(&r, out);
    }
    return HE_OK;
}

/* Computes the normal of a triangular face. Returns false, and leaves the normal to one_normal, if
 * the face is none or not of ordinary size. */
static inline bool plain_normal(const he_content *c, const triple *t, he_vec3 *out)
{
    if (t->a == HE_NONE) {
        return false;
    }
    const he_vec3 p = c->position[t->a];
    const he_vec3 u = he_vec3_sub(c->position[t->b], p), v = he_vec3_sub(c->position[t->c], p);
    const he_vec3 vector = he_vec3_cross(u, v);
    const double square = he_vec3_dot(vector, vector);
    *out = he_vec3_scale(vector, 1 / sqrt(square));
    return is_plain(square, he_vec3_dot(u, u) * he_vec3_dot(v, v));
}

/* The loop over the faces of a range, which is compiled once for each value of `triangles` and
 * `scattered`. */
static inline __attribute__((always_inline)) he_status
face_loop(const faces *all, size_t from, size_t to, bool triangles, bool scattered, he_error *err)
{
    const he_content *c = &all->m->c;
    uint32_t budget = he_ring_budget(all->m);
    for (size_t f = from; f < to; f++) {
        if (scattered) {
            prefetch_ahead(c, f, to, triangles);
        }
        const triple t = find_triple(c, (uint32_t)f, triangles);
        if (!plain_normal(c, &t, &all->out[f])) {
            he_status status = one_normal(all->m, (uint32_t)f, &budget, &all->out[f], err);
            if (status != HE_OK) {
                return status;
            }
        }
    }
    return HE_OK;
}

static he_status face_range(void *context, uint32_t part, size_t from, size_t to, he_error *err)
{
    const faces *all = context;
    (void)part;
    if (is_scattered(&all->m->c, from, to)) {
        return all->triangles ? face_loop(all, from, to, true, true, err)
                              : face_loop(all, from, to, false, true, err);
    }
    return all->triangles ? face_loop(all, from, to, true, false, err)
                          : face_loop(all, from, to, false, false, err);
}

he_status he_face_normals(const he_mesh *m, he_progress *progress, he_vec3 *out, he_error *err)
{
    faces all = {m, are_triangles(&m->c), out};
    return he_run_ranges(progress, m->c.faces.issued, face_range, &all, err);
}

/* --- normals of vertices --- */

static void add_to(he_vec3 *sum, he_vec3 normal, double weight)
{
    *sum = he_vec3_add(*sum, he_vec3_scale(normal, weight));
}

/* Adds the normal of a triangle, times its weight, to the sums in `out` of its three vertices. With
 * HE_WEIGHT_AREA, twice the triangle's area vector times `half` is added: `half` is 2^-u / 2 for
 * the exponent u from area_unit_of_all, or 0 if a double cannot hold that number. Returns false,
 * and adds nothing, if the product would underflow. */
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
        /* At each corner, the cross product of the two sides that meet there has the length `root`
         * of t->vector. */
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

/* Returns a binary exponent for the areas of all faces of the mesh: twice the exponent of the
 * mesh's largest coordinate. Areas are divided by 2 to the power of this exponent. */
static int area_unit_of_all(const he_mesh *m)
{
    he_box box;
    he_surface_box(m, &box);
    return 2 * he_exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
}

he_status he_vertex_normals(const he_mesh *m, he_weight weight, he_progress *progress, he_vec3 *out,
                            he_error *err)
{
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        out[v] = (he_vec3){0, 0, 0};
    }
    int unit = weight == HE_WEIGHT_AREA ? area_unit_of_all(m) : 0;
    double half = abs(unit) < 1000 ? ldexp(0.5, -unit) : 0;
    uint32_t budget = he_ring_budget(m);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (he_progress_at(progress, f, m->c.faces.issued, err) != HE_OK) {
            return HE_CANCELLED;
        }
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
