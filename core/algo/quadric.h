/* quadric.h - inline quadrics: the sum of a point's squared distances to many planes.
 *
 * Garland and Heckbert, "Surface simplification using quadric error metrics", 1997: the sum of the
 * squared distances to planes, each with a weight, is a quadratic function of the point, and such
 * functions are added by adding their coefficients,
 *
 *     q(x) = x' A x + 2 b' x + c        A symmetric, 3 by 3
 *
 * Here x is relative to the vertex to which the quadric belongs; the quadric does not store its
 * position. So coordinates are about as large as the edges are long, wherever the mesh lies, and
 * few digits are lost. */
#ifndef HE_ALGO_QUADRIC_H
#define HE_ALGO_QUADRIC_H

#include "geometry/vec3.h"

typedef struct he_quadric {
    double xx, xy, xz, yy, yz, zz; /* entries of A */
    he_vec3 b;
    double c;
    double weight; /* sum of the weights of all planes */
} he_quadric;

/* Adds a plane through the point to which the quadric is relative. */
static inline void he_quadric_add_plane(he_quadric *q, he_vec3 unit_normal, double weight)
{
    he_vec3 n = unit_normal, w = he_vec3_scale(n, weight);
    q->xx += w.x * n.x;
    q->xy += w.x * n.y;
    q->xz += w.x * n.z;
    q->yy += w.y * n.y;
    q->yz += w.y * n.z;
    q->zz += w.z * n.z;
    q->weight += weight;
}

static inline he_vec3 he_quadric_times(const he_quadric *q, he_vec3 x)
{
    return (he_vec3){q->xx * x.x + q->xy * x.y + q->xz * x.z,
                     q->xy * x.x + q->yy * x.y + q->yz * x.z,
                     q->xz * x.x + q->yz * x.y + q->zz * x.z};
}

/* Returns the value of the quadric at x; a negative value, which can only be rounding noise, is
 * returned as 0. */
static inline double he_quadric_at(const he_quadric *q, he_vec3 x)
{
    double value = he_vec3_dot(x, he_vec3_add(he_quadric_times(q, x), he_vec3_scale(q->b, 2)));
    value += q->c;
    return value > 0 ? value : 0;
}

/* Makes the quadric relative to another point: the present one plus the vector `by`. */
static inline void he_quadric_shift(he_quadric *q, he_vec3 by)
{
    q->c = he_quadric_at(q, by);
    q->b = he_vec3_add(q->b, he_quadric_times(q, by));
}

/* Adds another quadric; both must be relative to the same point. */
static inline void he_quadric_add(he_quadric *q, const he_quadric *more)
{
    q->xx += more->xx;
    q->xy += more->xy;
    q->xz += more->xz;
    q->yy += more->yy;
    q->yz += more->yz;
    q->zz += more->zz;
    q->b = he_vec3_add(q->b, more->b);
    q->c += more->c;
    q->weight += more->weight;
}

/* Finds where q(x) + pull * |x - home|^2 is least. A pull of more than a few 1e-12 of the trace of
 * A makes the result unique even if the planes do not determine one point, as in a flat region.
 * Returns false if there are no planes. */
static inline bool he_quadric_least(const he_quadric *q, double pull, he_vec3 home, he_vec3 *x)
{
    double xx = q->xx + pull, yy = q->yy + pull, zz = q->zz + pull;
    he_vec3 r = he_vec3_sub(he_vec3_scale(home, pull), q->b);
    double a = yy * zz - q->yz * q->yz, b = q->xz * q->yz - q->xy * zz;
    double c = q->xy * q->yz - q->xz * yy, d = xx * zz - q->xz * q->xz;
    double e = q->xy * q->xz - xx * q->yz, f = xx * yy - q->xy * q->xy;
    double determinant = xx * a + q->xy * b + q->xz * c;
    if (!(determinant > 0)) {
        return false;
    }
    *x = he_vec3_scale((he_vec3){a * r.x + b * r.y + c * r.z, b * r.x + d * r.y + e * r.z,
                                 c * r.x + e * r.y + f * r.z},
                       1 / determinant);
    return he_vec3_is_finite(*x);
}

#endif
