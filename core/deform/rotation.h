/* rotation.h - the rotation that is nearest to a matrix of 3 by 3 numbers. */
#ifndef HE_DEFORM_ROTATION_H
#define HE_DEFORM_ROTATION_H

#include "geometry/vec3.h"

/* A matrix, row by row. */
typedef struct he_rotation {
    double k[9];
} he_rotation;

/* Returns the rotation R for which the sum of the products of the entries of R and `s` is largest.
 * It is the factor R of the polar decomposition s = R U if the determinant of `s` is above 0, and
 * has the determinant 1 in any case (Horn, Closed-form solution of absolute orientation using unit
 * quaternions, 1987). If several rotations are nearest, returns one of them that turns little. */
he_rotation he_rotation_nearest(const double s[9]);

static inline he_vec3 he_rotation_apply(const he_rotation *r, he_vec3 p)
{
    const double *k = r->k;
    return (he_vec3){k[0] * p.x + k[1] * p.y + k[2] * p.z, k[3] * p.x + k[4] * p.y + k[5] * p.z,
                     k[6] * p.x + k[7] * p.y + k[8] * p.z};
}

/* Adds `weight` times the product of the column `a` and the row `b` to a matrix. */
static inline void he_matrix_add(double s[9], double weight, he_vec3 a, he_vec3 b)
{
    const he_vec3 c = he_vec3_scale(a, weight);
    s[0] += c.x * b.x, s[1] += c.x * b.y, s[2] += c.x * b.z;
    s[3] += c.y * b.x, s[4] += c.y * b.y, s[5] += c.y * b.z;
    s[6] += c.z * b.x, s[7] += c.z * b.y, s[8] += c.z * b.z;
}

#endif
