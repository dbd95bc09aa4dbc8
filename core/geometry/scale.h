/* scale.h - keeps products of coordinates within the range of a double. Scaling by powers of two is
 * exact. */
#ifndef HE_GEOMETRY_SCALE_H
#define HE_GEOMETRY_SCALE_H

#include "geometry/vec3.h"

#include <float.h>

#define HE_PI 3.14159265358979323846

/* Products of four lengths between these two limits neither overflow nor lose digits
 * by underflow. */
#define HE_LEAST_PRODUCT 1e-250
#define HE_MOST_PRODUCT  1e250

/* Returns the exponent e for which extent / 2^e is in [1/2, 1). The exponent is at least -1000, so
 * that 2^-e is finite in a double. */
static inline int he_exponent_of(double extent)
{
    int exponent = 0;
    if (extent > 0) {
        frexp(extent, &exponent);
    }
    return exponent < -1000 ? -1000 : exponent;
}

/* Returns the power of two, from 2^-1000 to 2^1000, in whose units coordinates up to `extent` are
 * below 1, if it reaches that far; 1 if the extent is 0. */
static inline double he_unit_of(double extent)
{
    const int exponent = he_exponent_of(extent);
    return ldexp(1, exponent > 1000 ? 1000 : exponent);
}

static inline double he_saturated(double x)
{
    return fmin(x, DBL_MAX);
}

static inline double he_clamped(double x)
{
    return fmax(fmin(x, DBL_MAX), -DBL_MAX);
}

/* Finds the unit vector in the direction of `a`, whatever the length of `a`. If `a` is zero, the
 * result is zero and the function returns false. */
static inline bool he_vec3_normalise(he_vec3 a, he_vec3 *out)
{
    double square = he_vec3_dot(a, a);
    if (!(square > HE_LEAST_PRODUCT && square < HE_MOST_PRODUCT)) {
        double extent = he_vec3_extent(a);
        if (!(extent > 0)) {
            *out = (he_vec3){0, 0, 0};
            return false;
        }
        a = he_vec3_scale(a, ldexp(1, -he_exponent_of(extent)));
        square = he_vec3_dot(a, a);
    }
    double length = sqrt(square);
    /* a vector along an axis gives exactly 1 */
    *out = (he_vec3){a.x / length, a.y / length, a.z / length};
    return true;
}

/* Returns the angle between two vectors. The result is accurate also near 0 and pi, where acos is
 * not. */
static inline double he_vec3_angle(he_vec3 a, he_vec3 b)
{
    return atan2(he_vec3_length(he_vec3_cross(a, b)), he_vec3_dot(a, b));
}

#endif
