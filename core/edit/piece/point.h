/* point.h - points between vertices, computed without overflow. */
#ifndef HE_EDIT_PIECE_POINT_H
#define HE_EDIT_PIECE_POINT_H

#include "mesh/walk.h"

#include <math.h>

static inline bool he_point_is_finite(he_vec3 p)
{
    return isfinite(p.x) && isfinite(p.y) && isfinite(p.z);
}

/* Interpolates from a (t = 0) to b (t = 1). Rounding never puts the result outside [a, b], so the
 * result is finite if a and b are finite, and equal to a if a = b. */
static inline double he_between(double a, double b, double t)
{
    double low = a < b ? a : b, high = a < b ? b : a;
    double value = (1 - t) * a + t * b;
    return value < low ? low : value > high ? high : value;
}

static inline he_vec3 he_point_between(he_vec3 a, he_vec3 b, double t)
{
    return (he_vec3){he_between(a.x, b.x, t), he_between(a.y, b.y, t), he_between(a.z, b.z, t)};
}

/* Returns the mean position of the corners of a loop, which is the face or the hole that half-edge
 * h belongs to. The result is always finite. */
he_vec3 he_loop_mean(const he_mesh *m, he_halfedge h);

#endif
