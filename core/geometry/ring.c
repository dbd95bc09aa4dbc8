#include "geometry/ring.h"

#include "mesh/walk.h"

he_ring he_ring_walk(const he_mesh *m, uint32_t first, double scale, uint32_t *budget)
{
    const uint32_t end = 2u * m->c.edges.issued, vertices = m->c.vertices.issued;
    he_ring r = {{0, 0, 0}, {0, 0, 0}, 0, 0};
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

static bool is_degenerate(const he_ring *r)
{
    return !(he_vec3_dot(r->vector, r->vector) > HE_RING_NOISE * r->degree * r->reach);
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

/* Walks around a face whose links are known to close. Coordinates are taken relative to the first
 * corner and multiplied by a power of two, so that the largest of them is near 1. This is for faces
 * whose products of coordinates would overflow or underflow. */
static he_ring walk_apart(const he_mesh *m, uint32_t first, uint32_t degree, int *exponent)
{
    he_vec3 o = m->c.position[m->c.origin[first]], u = {0, 0, 0};
    bool halves = largest_coordinate(m, first) > DBL_MAX / 4; /* a difference might overflow */
    double part = halves ? 0.5 : 1, largest = 0;
    uint32_t h = first;
    do {
        he_vec3 p = he_vec3_scale(m->c.position[m->c.origin[h]], part);
        largest = fmax(largest, he_vec3_extent(he_vec3_sub(p, he_vec3_scale(o, part))));
        h = m->c.next[h];
    } while (h != first);
    int own = he_exponent_of(largest);
    he_ring r = {.degree = degree};
    do {
        he_vec3 p = m->c.position[m->c.origin[h]];
        he_vec3 v = he_vec3_sub(he_vec3_scale(p, part), he_vec3_scale(o, part));
        v = he_vec3_scale(v, ldexp(1, -own));
        r.vector = he_vec3_add(r.vector, he_vec3_cross(u, v));
        r.reach += he_vec3_dot(u, u) * he_vec3_dot(v, v);
        r.sum = he_vec3_add(r.sum, he_vec3_scale(he_vec3_scale(p, part), ldexp(1, -own)));
        u = v;
        h = m->c.next[h];
    } while (h != first);
    *exponent = own + (halves ? 1 : 0);
    return r;
}

he_ring he_ring_measure(const he_mesh *m, uint32_t first, uint32_t *budget, int *exponent)
{
    *exponent = 0;
    he_ring r = he_ring_walk(m, first, 1, budget);
    if ((r.reach > HE_LEAST_PRODUCT && r.reach < HE_MOST_PRODUCT) || r.degree == 0) {
        return r;
    }
    return walk_apart(m, first, r.degree, exponent);
}

uint32_t he_ring_budget(const he_mesh *m)
{
    return 2u * m->c.edges.issued;
}

he_ring he_ring_of_face(const he_mesh *m, he_face f, int *exponent)
{
    uint32_t budget = he_ring_budget(m);
    return he_ring_measure(m, m->c.face_halfedge[f.i], &budget, exponent);
}

bool he_ring_normal(const he_ring *r, he_vec3 *out)
{
    if (r->degree == 0 || is_degenerate(r)) {
        *out = (he_vec3){0, 0, 0};
        return false;
    }
    *out = he_vec3_scale(r->vector, 1 / he_vec3_length(r->vector));
    return true;
}

double he_ring_area(const he_ring *r, int exponent)
{
    double scaled = r->degree == 0 ? 0 : 0.5 * he_vec3_length(r->vector);
    return exponent == 0 ? scaled : he_saturated(ldexp(scaled, 2 * exponent));
}

/* Returns the centroid of a face. If the corners are far from the origin of coordinates, the sum of
 * their positions in `found` may have overflowed; the positions are then summed up again in a
 * smaller scale. */
he_vec3 he_ring_centroid(const he_mesh *m, uint32_t first, const he_ring *found, int exponent)
{
    he_ring r = *found;
    if (r.degree == 0) {
        return (he_vec3){0, 0, 0};
    }
    if (!he_vec3_is_finite(r.sum)) {
        exponent = he_exponent_of(largest_coordinate(m, first));
        uint32_t again = r.degree;
        r = he_ring_walk(m, first, ldexp(1, -exponent), &again);
    }
    double n = r.degree;
    he_vec3 c = {r.sum.x / n, r.sum.y / n, r.sum.z / n};
    if (exponent != 0) {
        c = (he_vec3){he_clamped(ldexp(c.x, exponent)), he_clamped(ldexp(c.y, exponent)),
                      he_clamped(ldexp(c.z, exponent))};
    }
    return c;
}

he_status he_ring_corrupt(uint32_t face, he_error *err)
{
    return he_fail(err, HE_CORRUPT, HE_FACE, face,
                   "the mesh is damaged: the half-edges of face %u do not form a loop", face);
}
