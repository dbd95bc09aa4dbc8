#include "geometry/planar_loop.h"

#include <math.h>

static he_vec3 minus(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static he_vec3 cross(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(he_vec3 a, he_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double largest(double size, he_vec3 p)
{
    double x = fabs(p.x), y = fabs(p.y), z = fabs(p.z);
    size = x > size ? x : size;
    size = y > size ? y : size;
    return z > size ? z : size;
}

/* A power of two, stored as two factors, because the power may be too large or too small for one
 * double. */
typedef struct power {
    double one, other;
} power;

static he_vec3 scaled(he_vec3 p, power by)
{
    return (he_vec3){p.x * by.one * by.other, p.y * by.one * by.other, p.z * by.one * by.other};
}

/* Returns the power of two by which `size` must be multiplied to lie in [0.5, 1). */
static power power_for(double size)
{
    int exponent = 0;
    (void)frexp(size, &exponent);
    return (power){ldexp(1, -exponent / 2), ldexp(1, -exponent - -exponent / 2)};
}

/* Writes the positions of the loop's corners, relative to corner 0, into `at`. The positions are
 * scaled by powers of two: before corner 0 is subtracted, so that differences do not overflow, and
 * afterwards, so that the largest coordinate is in [0.5, 1). */
static void place(const he_mesh *m, const he_planar_loop *flat, he_vec3 *at)
{
    double size = 0;
    for (uint32_t i = 0; i < flat->n; i++) {
        at[i] = he_position(m, he_origin(m, (he_halfedge){flat->halfedge[i]}));
        size = largest(size, at[i]);
    }
    const power first = power_for(size);
    const he_vec3 base = scaled(at[0], first);
    size = 0;
    for (uint32_t i = 0; i < flat->n; i++) {
        at[i] = minus(scaled(at[i], first), base);
        size = largest(size, at[i]);
    }
    const power second = power_for(size);
    for (uint32_t i = 0; i < flat->n; i++) {
        at[i] = scaled(at[i], second);
    }
}

static he_vec3 newell(const he_vec3 *at, uint32_t n, double *length2)
{
    he_vec3 sum = {0, 0, 0}, a = at[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        he_vec3 b = at[i], normal = cross(a, b), side = minus(b, a);
        sum = (he_vec3){sum.x + normal.x, sum.y + normal.y, sum.z + normal.z};
        *length2 += dot(side, side);
        a = b;
    }
    return sum;
}

static void project(he_planar_loop *flat, const he_vec3 *at, he_vec3 normal)
{
    double length = sqrt(dot(normal, normal));
    normal = (he_vec3){normal.x / length, normal.y / length, normal.z / length};
    /* The plane's axis v is the cross product of the normal and a coordinate axis that is not
     * nearly parallel to the normal. */
    he_vec3 away = fabs(normal.x) < 0.6 ? (he_vec3){1, 0, 0} : (he_vec3){0, 1, 0};
    he_vec3 v = cross(normal, away);
    length = sqrt(dot(v, v));
    v = (he_vec3){v.x / length, v.y / length, v.z / length};
    he_vec3 u = cross(v, normal);
    for (uint32_t i = 0; i < flat->n; i++) {
        flat->x[i] = dot(at[i], u);
        flat->y[i] = dot(at[i], v);
    }
}

void he_planar_loop_clear(he_planar_loop *flat)
{
    he_mem_free(flat->memory);
    *flat = (he_planar_loop){0};
}

he_status he_planar_loop_init(he_planar_loop *out, const he_mesh *m, he_halfedge first,
                              he_error *err)
{
    enum { FEW = 32 };
    he_vec3 few[FEW], *at = few;
    he_planar_loop flat = {.n = he_loop_length(m, first)};
    flat.memory = he_mem_zero(flat.n, 2 * sizeof *flat.x + sizeof *flat.halfedge);
    if (flat.n > FEW) {
        at = he_mem_array(NULL, flat.n, sizeof *at);
    }
    flat.x = flat.memory;
    if (flat.x == NULL || at == NULL) {
        he_mem_free(at == few ? NULL : at);
        he_planar_loop_clear(&flat);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to triangulate a loop");
    }
    flat.y = flat.x + flat.n;
    flat.halfedge = (uint32_t *)(flat.y + flat.n);
    he_halfedge h = first;
    for (uint32_t i = 0; i < flat.n; i++, h = he_next(m, h)) {
        flat.halfedge[i] = h.i;
    }
    double length2 = 0;
    place(m, &flat, at);
    he_vec3 normal = newell(at, flat.n, &length2);
    flat.degenerate = !(sqrt(dot(normal, normal)) > HE_PLANAR_LOOP_THIN * length2);
    if (!flat.degenerate) {
        project(&flat, at, normal);
    }
    he_mem_free(at == few ? NULL : at);
    *out = flat;
    return HE_OK;
}
