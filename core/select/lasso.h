/* lasso.h - which points a matrix maps into a polygon.
 *
 * The matrix M has four rows of four numbers. It maps the point (x, y, z) to
 *
 *     (X, Y, Z, W) = M (x, y, z, 1),    which stands for (X / W, Y / W) in the polygon's plane,
 *
 * so it may be the product of a camera's projection and view. A point with W <= 0 is behind the
 * camera and never inside. Z is not used.
 *
 * The polygon may intersect itself: a point is inside if the polygon winds around it (non-zero
 * winding number), or if it lies on a side. For the mapped point, as rounded to doubles, the answer
 * is exact (orient.h). */
#ifndef HE_SELECT_LASSO_H
#define HE_SELECT_LASSO_H

#include "mesh/mesh.h"

enum { HE_LASSO_CORNERS = 4096 };

typedef struct he_lasso {
    const double *matrix;   /* 16 numbers, row by row */
    const he_vec3 *corners; /* z is not used */
    size_t count;
} he_lasso;

/* A lasso made ready for many points. */
typedef struct he_noose he_noose;

/* Makes a lasso ready.
 * Returns HE_BAD_VALUE if the polygon has fewer than three corners, or if the matrix is singular:
 * if its first, second and fourth row are linearly dependent up to rounding, it maps space to a
 * line. Returns HE_NOT_FINITE if a number is not finite. Returns HE_LIMIT if the polygon has more
 * than HE_LASSO_CORNERS corners. Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_noose_new(const he_lasso *lasso, he_noose **out, he_error *err);
void he_noose_free(he_noose *noose);
/* Returns whether a point is inside, in time linear in the number of corners. */
bool he_noose_holds(const he_noose *noose, he_vec3 point);

#endif
