#include "edit/piece/point.h"

#include <float.h>

/* Returns the sum of the positions of the corners of a loop, each multiplied by `scale`. */
static he_vec3 sum_corners(const he_mesh *m, he_halfedge h, double scale)
{
    he_vec3 sum = {0, 0, 0};
    he_halfedge x = h;
    do {
        he_vec3 p = he_position(m, he_origin(m, x));
        sum.x += p.x * scale;
        sum.y += p.y * scale;
        sum.z += p.z * scale;
        x = he_next(m, x);
    } while (x.i != h.i);
    return sum;
}

he_vec3 he_loop_mean(const he_mesh *m, he_halfedge h)
{
    double n = he_loop_length(m, h);
    he_vec3 sum = sum_corners(m, h, 1);
    if (he_point_is_finite(sum)) {
        return (he_vec3){sum.x / n, sum.y / n, sum.z / n};
    }
    /* The sum of the unscaled positions is more exact, so it is tried first. If it overflows, half
     * of the mean is computed from scaled positions, which cannot overflow. */
    sum = sum_corners(m, h, 0.5 / n);
    he_vec3 mean = {2 * sum.x, 2 * sum.y, 2 * sum.z};
    mean.x = fmin(fmax(mean.x, -DBL_MAX), DBL_MAX);
    mean.y = fmin(fmax(mean.y, -DBL_MAX), DBL_MAX);
    mean.z = fmin(fmax(mean.z, -DBL_MAX), DBL_MAX);
    return mean;
}
