#include "query/geometry.h"

#include "mesh/walk.h"

#include <float.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

/* Between these, products of four lengths neither overflow nor lose their digits. */
static const double LEAST = 1e-250, MOST = 1e250;

/* The exponent by which to divide so that `extent` falls into [1/2, 1). Powers of two make scaling
 * exact. The floor keeps the factor itself finite. */
static int exponent_of(double extent)
{
    int exponent = 0;
    if (extent > 0) {
        frexp(extent, &exponent);
    }
    return exponent < -1000 ? -1000 : exponent;
}

static double saturated(double x)
{
    return fmin(x, DBL_MAX);
}

/* A unit vector, whatever the size of `a`; zero and false when it is zero. */
static bool normalise(he_vec3 a, he_vec3 *out)
{
    double extent = he_vec3_extent(a);
    if (!(extent > 0)) {
        *out = (he_vec3){0, 0, 0};
        return false;
    }
    a = he_vec3_scale(a, ldexp(1, -exponent_of(extent)));
    *out = he_vec3_scale(a, 1 / he_vec3_length(a));
    return true;
}

he_vec3 he_direction(he_vec3 from, he_vec3 to, double *length)
{
    he_vec3 d = he_vec3_sub(to, from);
    double square = he_vec3_dot(d, d);
    if (square > LEAST && square < MOST) {
        double root = sqrt(square);
        if (length != NULL) {
            *length = root;
        }
        return (he_vec3){d.x / root, d.y / root, d.z / root};
    }
    int halved = 0;
    if (!he_vec3_is_finite(d)) {
        d = he_vec3_sub(he_vec3_scale(to, 0.5), he_vec3_scale(from, 0.5));
        halved = 1;
    }
    int exponent = exponent_of(he_vec3_extent(d));
    d = he_vec3_scale(d, ldexp(1, -exponent));
    double scaled = he_vec3_length(d);
    if (length != NULL) {
        *length = saturated(ldexp(scaled, exponent + halved));
    }
    he_vec3 unit;
    normalise(d, &unit);
    return unit;
}

double he_edge_length(const he_mesh *m, he_edge e)
{
    double length;
    he_direction(m->c.position[m->c.origin[2u * e.i]], m->c.position[m->c.origin[2u * e.i + 1u]],
                 &length);
    return length;
}

/* A walk around a face, in coordinates times a scale. */
typedef struct ring {
    he_vec3 vector; /* twice the area vector */
    he_vec3 sum;    /* of the corners */
    double
        reach; /* sum of |u|^2 |v|^2 over the fan's triangles: what `vector` was cancelled from */
    uint32_t degree; /* 0: the links are broken */
} ring;

/* `budget` is the number of half-edges that may still be visited. */
static ring walk(const he_mesh *m, uint32_t first, double scale, uint32_t *budget)
{
    const uint32_t end = 2u * m->c.edges.issued, vertices = m->c.vertices.issued;
    ring r = {{0, 0, 0}, {0, 0, 0}, 0, 0};
    he_vec3 o = {0, 0, 0}, u = {0, 0, 0};
    uint32_t h = first, degree = 0;
    double u2 = 0;
    do {
        if (h >= end || m->c.origin[h] >= vertices || (*budget)-- == 0) {
            *budget = 0;
            r.degree = 0;
            return r;
        }
        he_vec3 p = he_vec3_scale(m->c.position[m->c.origin[h]], scale);
        r.sum = he_vec3_add(r.sum, p);
        if (degree == 0) {
            o = p;
        } else {
            he_vec3 v = he_vec3_sub(p, o);
            double v2 = he_vec3_dot(v, v);
            r.vector = he_vec3_add(r.vector, he_vec3_cross(u, v));
            r.reach += u2 * v2;
            u = v;
            u2 = v2;
        }
        degree++;
        h = m->c.next[h];
    } while (h != first);
    r.degree = degree;
    return r;
}

/* The relative error of a product of differences, squared, with a margin. */
static const double NOISE = 64 * DBL_EPSILON * DBL_EPSILON;

static bool is_degenerate(const ring *r)
{
    return !(he_vec3_dot(r->vector, r->vector) > NOISE * r->degree * r->reach);
}

static double largest_coordinate(const he_mesh *m, uint32_t first)
{
    double largest = 0;
    uint32_t h = first;
    do {
        largest = fmax(largest, he_vec3_extent(m->c.position[m->c.origin[h]]));
        h = m->c.next[h];
    } while (h != first);
    return largest;
}

/* The ring of a face in a scale where nothing overflows or vanishes: true lengths are those of the
 * ring times 2^exponent. */
static ring measure(const he_mesh *m, uint32_t first, uint32_t *budget, int *exponent)
{
    *exponent = 0;
    ring r = walk(m, first, 1, budget);
    if ((r.reach > LEAST && r.reach < MOST) || r.degree == 0) {
        return r;
    }
    *exponent = exponent_of(largest_coordinate(m, first));
    uint32_t again = r.degree;
    return walk(m, first, ldexp(1, -*exponent), &again);
}

static uint32_t whole_budget(const he_mesh *m)
{
    return 2u * m->c.edges.issued;
}

static ring measure_face(const he_mesh *m, he_face f, int *exponent)
{
    uint32_t budget = whole_budget(m);
    return measure(m, m->c.face_halfedge[f.i], &budget, exponent);
}

static bool unit_normal(const ring *r, he_vec3 *out)
{
    if (r->degree == 0 || is_degenerate(r)) {
        *out = (he_vec3){0, 0, 0};
        return false;
    }
    *out = he_vec3_scale(r->vector, 1 / he_vec3_length(r->vector));
    return true;
}

static double area_of(const ring *r, int exponent)
{
    double scaled = r->degree == 0 ? 0 : 0.5 * he_vec3_length(r->vector);
    return exponent == 0 ? scaled : saturated(ldexp(scaled, 2 * exponent));
}

static double clamped(double x)
{
    return fmax(fmin(x, DBL_MAX), -DBL_MAX);
}

/* Corners far out can overflow the sum where the differences between them are ordinary. */
static he_vec3 centroid_of(const he_mesh *m, uint32_t first, const ring *found, int exponent)
{
    ring r = *found;
    if (r.degree == 0) {
        return (he_vec3){0, 0, 0};
    }
    if (!he_vec3_is_finite(r.sum)) {
        exponent = exponent_of(largest_coordinate(m, first));
        uint32_t again = r.degree;
        r = walk(m, first, ldexp(1, -exponent), &again);
    }
    double n = r.degree;
    he_vec3 c = {r.sum.x / n, r.sum.y / n, r.sum.z / n};
    if (exponent != 0) {
        c = (he_vec3){clamped(ldexp(c.x, exponent)), clamped(ldexp(c.y, exponent)),
                      clamped(ldexp(c.z, exponent))};
    }
    return c;
}

he_face_shape he_face_measure(const he_mesh *m, he_face f)
{
    int exponent;
    ring r = measure_face(m, f, &exponent);
    he_face_shape shape = {.centroid = centroid_of(m, m->c.face_halfedge[f.i], &r, exponent),
                           .area = area_of(&r, exponent),
                           .degree = r.degree};
    shape.degenerate = !unit_normal(&r, &shape.normal);
    return shape;
}

bool he_face_normal(const he_mesh *m, he_face f, he_vec3 *out)
{
    int exponent;
    ring r = measure_face(m, f, &exponent);
    return unit_normal(&r, out);
}

double he_face_area(const he_mesh *m, he_face f)
{
    int exponent;
    ring r = measure_face(m, f, &exponent);
    return area_of(&r, exponent);
}

he_vec3 he_face_centroid(const he_mesh *m, he_face f)
{
    int exponent;
    ring r = measure_face(m, f, &exponent);
    return centroid_of(m, m->c.face_halfedge[f.i], &r, exponent);
}

/* The angle between unit vectors; exact to rounding at 0 and pi, where acos is not. */
static double angle_between(he_vec3 a, he_vec3 b)
{
    return atan2(he_vec3_length(he_vec3_cross(a, b)), he_vec3_dot(a, b));
}

double he_corner_angle(const he_mesh *m, he_halfedge h)
{
    uint32_t prev = m->c.prev[h.i];
    uint32_t at = m->c.origin[h.i], to = m->c.origin[h.i ^ 1u];
    uint32_t from = prev < whole_budget(m) ? m->c.origin[prev] : HE_NONE;
    uint32_t vertices = m->c.vertices.issued;
    if (at >= vertices || to >= vertices || from >= vertices) {
        return 0;
    }
    double ahead, behind;
    he_vec3 a = he_direction(m->c.position[at], m->c.position[to], &ahead);
    he_vec3 b = he_direction(m->c.position[at], m->c.position[from], &behind);
    return ahead == 0 || behind == 0 ? 0 : angle_between(a, b);
}

bool he_edge_dihedral(const he_mesh *m, he_edge e, double *out)
{
    he_halfedge h = he_edge_halfedge(e, 0);
    he_vec3 left, right;
    *out = 0;
    if (he_is_boundary_edge(m, e) || !he_face_normal(m, he_face_of(m, h), &left) ||
        !he_face_normal(m, he_face_of(m, he_twin(h)), &right)) {
        return false;
    }
    he_vec3 along =
        he_direction(he_position(m, he_origin(m, h)), he_position(m, he_target(m, h)), NULL);
    double sine = he_vec3_dot(he_vec3_cross(left, right), along);
    double angle = atan2(sine, he_vec3_dot(left, right)) + 0.0; /* no minus zero */
    *out = angle > -PI ? angle : PI;
    return true;
}

/* Areas differ beyond what a double spans only in meshes nobody draws; this keeps their faces from
 * vanishing where there are no larger ones. */
static double area_weight(const ring *r, int exponent, int unit)
{
    return fmax(ldexp(0.5 * he_vec3_length(r->vector), 2 * exponent - unit), DBL_MIN);
}

/* The binary exponent of the largest area about a vertex, from which the weights are taken. */
static int area_unit(const he_mesh *m, he_vertex v)
{
    int unit = INT32_MIN;
    uint32_t first = m->c.vertex_halfedge[v.i], h = first, budget = whole_budget(m);
    do {
        he_vec3 normal;
        int exponent, own;
        if (m->c.face[h] < m->c.faces.issued) {
            ring r = measure_face(m, (he_face){m->c.face[h]}, &exponent);
            if (unit_normal(&r, &normal)) {
                frexp(he_vec3_length(r.vector), &own);
                unit = own + 2 * exponent > unit ? own + 2 * exponent : unit;
            }
        }
        h = m->c.prev[h] ^ 1u;
    } while (h != first && h < whole_budget(m) && budget-- > 0);
    return unit;
}

bool he_vertex_normal(const he_mesh *m, he_vertex v, he_weight weight, he_vec3 *out)
{
    he_vec3 sum = {0, 0, 0};
    uint32_t first = m->c.vertex_halfedge[v.i], h = first, budget = whole_budget(m);
    if (first == HE_NONE) {
        return normalise(sum, out);
    }
    int unit = weight == HE_WEIGHT_AREA ? area_unit(m, v) : 0;
    do {
        he_vec3 normal;
        int exponent;
        if (m->c.face[h] < m->c.faces.issued) {
            ring r = measure_face(m, (he_face){m->c.face[h]}, &exponent);
            if (unit_normal(&r, &normal)) {
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
    } while (h != first && h < whole_budget(m) && budget-- > 0);
    return normalise(sum, out);
}

static he_status corrupt(uint32_t face, he_error *err)
{
    return he_fail(err, HE_CORRUPT, HE_FACE, face, "the half-edges of face %u do not close", face);
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
    return reach > LEAST && reach < MOST && t.square > NOISE * 3 * reach;
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
    uint32_t budget = whole_budget(m);
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
        ring r = measure(m, h, &budget, &exponent);
        if (r.degree == 0) {
            return corrupt(f, err);
        }
        unit_normal(&r, &out[f]);
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
        if (!(he_vec3_extent(share) > LEAST)) {
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
    int unit = 2 * exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    double half = abs(unit) < 1000 ? ldexp(0.5, -unit) : 0;
    uint32_t budget = whole_budget(m);
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
        ring r = measure(m, first, &budget, &exponent);
        if (r.degree == 0) {
            return corrupt(f, err);
        }
        if (!unit_normal(&r, &normal)) {
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
        normalise(out[v], &out[v]);
    }
    return HE_OK;
}

bool he_mesh_box(const he_mesh *m, he_box *out)
{
    he_vec3 low = {0, 0, 0}, high = {0, 0, 0};
    bool any = false;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (!he_vertex_is_live(m, (he_vertex){v})) {
            continue;
        }
        he_vec3 p = m->c.position[v];
        if (!any) {
            low = high = p;
            any = true;
        }
        low = (he_vec3){p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y,
                        p.z < low.z ? p.z : low.z};
        high = (he_vec3){p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y,
                         p.z > high.z ? p.z : high.z};
    }
    *out = (he_box){low, high};
    return any;
}

/* Neumaier's sum: the rounding errors are summed beside it. */
typedef struct total {
    double sum, error;
} total;

static void add(total *t, double x)
{
    double sum = t->sum + x;
    t->error += fabs(t->sum) >= fabs(x) ? (t->sum - sum) + x : (x - sum) + t->sum;
    t->sum = sum;
}

he_status he_mesh_measure(const he_mesh *m, he_measures *out, he_error *err)
{
    he_box box;
    he_mesh_box(m, &box);
    int exponent = exponent_of(fmax(he_vec3_extent(box.min), he_vec3_extent(box.max)));
    double scale = ldexp(1, -exponent);
    total area = {0, 0}, volume = {0, 0};
    uint32_t budget = whole_budget(m);
    he_vec3 about = {0, 0, 0}; /* a corner of the mesh: far from it, the sum would cancel */
    bool any = false;
    he_status status = he_watch_phase(m->watch, "measuring", 1, err);
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (status == HE_OK) {
            status = he_watch_at(m->watch, f, m->c.faces.issued, err);
        }
        if (status != HE_OK) {
            return status;
        }
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        uint32_t first = m->c.face_halfedge[f];
        ring r = walk(m, first, scale, &budget);
        if (r.degree == 0) {
            return corrupt(f, err);
        }
        he_vec3 corner = he_vec3_scale(m->c.position[m->c.origin[first]], scale);
        if (!any) {
            about = corner;
            any = true;
        }
        /* The tetrahedra over a fan of triangles from p0 add up to p0 . A, whatever the other
         * corners: p0 . (p0 x q) is nothing. */
        add(&area, he_vec3_length(r.vector));
        add(&volume, he_vec3_dot(he_vec3_sub(corner, about), r.vector));
    }
    out->area = saturated(ldexp((area.sum + area.error) / 2, 2 * exponent));
    out->has_volume = m->c.boundary_halfedges == 0;
    double signed_volume = ldexp((volume.sum + volume.error) / 6, 3 * exponent);
    out->volume = out->has_volume ? clamped(signed_volume) : 0;
    return HE_OK;
}
