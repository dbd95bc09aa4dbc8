#include "edit/plane/plane.h"

#include "geometry/vec3.h"

#include <float.h>

/* TOLERANCE is the default tolerance, relative to the size of the mesh. NOISE bounds the rounding
 * error of a distance from the plane, relative to the size of the coordinates. */
static const double TOLERANCE = 1e-9, NOISE = 0x1p-48;

/* Coordinates are scaled by a power of two with at most this exponent. Very small coordinates would
 * need a larger power, which may exceed the range of a double, so they are scaled less. */
enum { MOST_EXPONENT = 1000 };

static he_status check(const he_plane *plane, he_error *err)
{
    const double *tolerance = plane->tolerance;
    if (!he_vec3_is_finite(plane->point) || !he_vec3_is_finite(plane->normal)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the plane's point and normal must be finite");
    }
    if (he_vec3_extent(plane->normal) == 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "the plane's normal must not be zero");
    }
    if (tolerance != NULL && !isfinite(*tolerance)) {
        return he_fail_plain(err, HE_NOT_FINITE, "the tolerance must be finite");
    }
    if (tolerance != NULL && *tolerance < 0) {
        return he_fail_plain(err, HE_BAD_VALUE, "the tolerance must not be negative, but is %g",
                             *tolerance);
    }
    return HE_OK;
}

static he_vec3 unit_of(he_vec3 normal)
{
    double extent = he_vec3_extent(normal);
    he_vec3 n = {normal.x / extent, normal.y / extent, normal.z / extent};
    double length = he_vec3_length(n);
    return (he_vec3){n.x / length, n.y / length, n.z / length};
}

/* Returns true if vertex v has edges. A vertex without edges is not cut, so it does not count for
 * the size of the mesh. */
static bool is_cut(const he_mesh *m, uint32_t v)
{
    return m->c.vertex_halfedge[v] < HE_DEAD;
}

static double find_scale(const he_mesh *m, he_vec3 point)
{
    double extent = he_vec3_extent(point);
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        if (is_cut(m, v)) {
            extent = fmax(extent, he_vec3_extent(m->c.position[v]));
        }
    }
    int exponent = 0;
    (void)frexp(extent, &exponent);
    return ldexp(1, -exponent < MOST_EXPONENT ? -exponent : MOST_EXPONENT);
}

/* Returns the sum of the absolute values of the terms of the dot product of n and p. The rounding
 * error of the dot product is at most a small multiple of this sum. */
static double weigh(he_vec3 n, he_vec3 p)
{
    return fabs(n.x * p.x) + fabs(n.y * p.y) + fabs(n.z * p.z);
}

/* Returns the distance of point p from the plane, times `scale`. The point may be an isolated
 * vertex, which is much farther away than the vertices that determine the scale. A result that
 * would overflow is clamped to the range of a double. */
static double distance_of(he_vec3 p, he_vec3 point, he_vec3 n, double scale)
{
    he_vec3 near = he_vec3_scale(p, scale);
    if (he_vec3_extent(near) <= 1) {
        return he_vec3_dot(n, he_vec3_sub(near, he_vec3_scale(point, scale)));
    }
    int exponent = 0;
    (void)frexp(he_vec3_extent(p), &exponent);
    he_vec3 way = he_vec3_sub(he_vec3_scale(p, ldexp(1, -exponent)),
                              he_vec3_scale(point, ldexp(1, -exponent)));
    double far = ldexp(he_vec3_dot(n, way), exponent) * scale;
    return fmax(fmin(far, DBL_MAX), -DBL_MAX);
}

/* Computes the distances of all vertices from the plane, and the default tolerance. All results are
 * multiplied by sides->scale. */
static he_status measure(const he_mesh *m, he_vec3 point, he_vec3 n, he_sides *sides,
                         double *tolerance, he_error *err)
{
    he_vec3 low = {1, 1, 1}, high = {-1, -1, -1}, q = he_vec3_scale(point, sides->scale);
    double weight = 0;
    he_status status = HE_OK;
    for (uint32_t v = 0; v < sides->count && status == HE_OK; v++) {
        status = he_progress_at(m->progress, v, sides->count, err);
        if (he_vertex_is_live(m, (he_vertex){v})) {
            sides->distance[v] = distance_of(m->c.position[v], point, n, sides->scale);
        }
        if (is_cut(m, v)) {
            he_vec3 p = he_vec3_scale(m->c.position[v], sides->scale);
            weight = fmax(weight, weigh(n, p));
            low = (he_vec3){fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z)};
            high = (he_vec3){fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z)};
        }
    }
    double size = fmax(0, fmax(high.x - low.x, fmax(high.y - low.y, high.z - low.z)));
    *tolerance = fmax(TOLERANCE * size, NOISE * (weight + weigh(n, q)));
    return status;
}

he_status he_sides_find(const he_mesh *m, const he_plane *plane, he_sides *out, he_error *err)
{
    he_status status = check(plane, err);
    if (status != HE_OK) {
        return status;
    }
    he_sides sides = {.count = m->c.vertices.issued, .scale = find_scale(m, plane->point)};
    sides.distance = he_mem_zero((size_t)sides.count + 1, sizeof *sides.distance);
    if (sides.distance == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the distances of %u vertices",
                             sides.count);
    }
    double within = 0;
    status = measure(m, plane->point, unit_of(plane->normal), &sides, &within, err);
    if (status != HE_OK) {
        he_sides_clear(&sides);
        return status;
    }
    if (plane->tolerance != NULL) {
        within = *plane->tolerance * sides.scale;
    }
    for (uint32_t v = 0; v < sides.count; v++) {
        if (fabs(sides.distance[v]) <= within) {
            sides.distance[v] = 0;
        }
    }
    *out = sides;
    return HE_OK;
}

void he_sides_clear(he_sides *sides)
{
    he_mem_free(sides->distance);
    *sides = (he_sides){.distance = NULL};
}
