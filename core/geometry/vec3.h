/* vec3.h - inline arithmetic on points and vectors. These functions do not guard against overflow
 * and underflow; the functions of geometry.h do, by scaling coordinates first. */
#ifndef HE_GEOMETRY_VEC3_H
#define HE_GEOMETRY_VEC3_H

#include "mesh/mesh.h"

#include <math.h>

static inline he_vec3 he_vec3_add(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline he_vec3 he_vec3_sub(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline he_vec3 he_vec3_scale(he_vec3 a, double s)
{
    return (he_vec3){a.x * s, a.y * s, a.z * s};
}
static inline double he_vec3_dot(he_vec3 a, he_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline he_vec3 he_vec3_cross(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double he_vec3_length(he_vec3 a)
{
    return sqrt(he_vec3_dot(a, a));
}
/* Returns the largest absolute value among the three components of a vector. */
static inline double he_vec3_extent(he_vec3 a)
{
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}
static inline bool he_vec3_is_finite(he_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

#endif
