#include "select/lasso.h"

#include "geometry/orient.h"
#include "geometry/scale.h"

#include <string.h>

struct he_noose {
    double x[4], y[4], w[4]; /* rows of the matrix, scaled by one power of two */
    int exponent;            /* coordinates in the plane are divided by two to this power */
    he_vec2 low, high;       /* box around the corners */
    size_t count;
    he_vec2 corners[]; /* scaled, so that the largest coordinate is below 1 */
};

/* Three rows count as linearly dependent if the determinants of all their 3 x 3 parts are below
 * this fraction of the sum of the absolute values of their terms. */
static const double DEPENDENT = 1e-12;

/* Returns whether the columns a, b and c of the rows x, y and w are linearly independent. */
static bool is_regular(const he_noose *n, int a, int b, int c)
{
    const int order[6][3] = {{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}, {c, b, a}, {b, a, c}};
    double sum = 0, size = 0;
    for (int i = 0; i < 6; i++) {
        double term = n->x[order[i][0]] * n->y[order[i][1]] * n->w[order[i][2]];
        sum += i < 3 ? term : -term;
        size += fabs(term);
    }
    return fabs(sum) > DEPENDENT * size;
}

/* Scales a row so that its largest number is in [1/2, 1). Only used to test for singularity: each
 * row may have a scale of its own there. */
static void normalise_row(double row[4])
{
    double most = fmax(fmax(fabs(row[0]), fabs(row[1])), fmax(fabs(row[2]), fabs(row[3])));
    int exponent = he_exponent_of(most);
    for (int i = 0; i < 4; i++) {
        row[i] = ldexp(row[i], -exponent);
    }
}

static bool is_singular(const he_noose *noose)
{
    he_noose n = {.x = {0}};
    memcpy(n.x, noose->x, sizeof n.x);
    memcpy(n.y, noose->y, sizeof n.y);
    memcpy(n.w, noose->w, sizeof n.w);
    normalise_row(n.x);
    normalise_row(n.y);
    normalise_row(n.w);
    return !is_regular(&n, 0, 1, 2) && !is_regular(&n, 0, 1, 3) && !is_regular(&n, 0, 2, 3) &&
           !is_regular(&n, 1, 2, 3);
}

static he_status check(const he_lasso *lasso, he_error *err)
{
    if (lasso->count < 3) {
        return he_fail_plain(err, HE_BAD_VALUE, "a polygon needs three corners, but has %zu",
                             lasso->count);
    }
    if (lasso->count > HE_LASSO_CORNERS) {
        return he_fail_plain(err, HE_LIMIT, "the polygon has %zu corners; at most %d are allowed",
                             lasso->count, (int)HE_LASSO_CORNERS);
    }
    for (size_t i = 0; i < lasso->count; i++) {
        if (!isfinite(lasso->corners[i].x) || !isfinite(lasso->corners[i].y)) {
            return he_fail_plain(err, HE_NOT_FINITE, "corner %zu of the polygon is not finite", i);
        }
    }
    for (int i = 0; i < 16; i++) {
        if (!isfinite(lasso->matrix[i])) {
            return he_fail_plain(err, HE_NOT_FINITE, "number %d of the matrix is not finite", i);
        }
    }
    return HE_OK;
}

/* Takes the rows of the matrix. All are scaled by one power of two, which changes neither the
 * mapped points nor the sign of W. */
static void take_matrix(he_noose *noose, const double *matrix)
{
    double most = 0;
    for (int i = 0; i < 16; i++) {
        most = i / 4 == 2 ? most : fmax(most, fabs(matrix[i]));
    }
    int exponent = he_exponent_of(most);
    for (int i = 0; i < 4; i++) {
        noose->x[i] = ldexp(matrix[i], -exponent);
        noose->y[i] = ldexp(matrix[4 + i], -exponent);
        noose->w[i] = ldexp(matrix[12 + i], -exponent);
    }
}

static void take_corners(he_noose *noose, const he_vec3 *corners)
{
    double extent = 0;
    for (size_t i = 0; i < noose->count; i++) {
        extent = fmax(extent, fmax(fabs(corners[i].x), fabs(corners[i].y)));
    }
    noose->exponent = he_exponent_of(extent);
    for (size_t i = 0; i < noose->count; i++) {
        he_vec2 p = {ldexp(corners[i].x, -noose->exponent), ldexp(corners[i].y, -noose->exponent)};
        noose->corners[i] = p;
        noose->low = i == 0 ? p : (he_vec2){fmin(noose->low.x, p.x), fmin(noose->low.y, p.y)};
        noose->high = i == 0 ? p : (he_vec2){fmax(noose->high.x, p.x), fmax(noose->high.y, p.y)};
    }
}

he_status he_noose_new(const he_lasso *lasso, he_noose **out, he_error *err)
{
    he_status status = check(lasso, err);
    if (status != HE_OK) {
        return status;
    }
    he_noose *noose = he_mem_zero(1, sizeof *noose + lasso->count * sizeof noose->corners[0]);
    if (noose == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for a polygon of %zu corners",
                             lasso->count);
    }
    noose->count = lasso->count;
    take_matrix(noose, lasso->matrix);
    take_corners(noose, lasso->corners);
    if (is_singular(noose)) {
        he_noose_free(noose);
        return he_fail_plain(
            err, HE_BAD_VALUE,
            "the matrix is singular: its first, second and fourth row are linearly "
            "dependent, so it maps all points to one line");
    }
    *out = noose;
    return HE_OK;
}

void he_noose_free(he_noose *noose)
{
    he_mem_free(noose);
}

/* Maps a point into the plane, and scales it like the corners. Returns false if it is behind the
 * camera. The result may be infinite. */
static bool map(const he_noose *n, he_vec3 p, he_vec2 *out)
{
    double one = 1, extent = he_vec3_extent(p);
    if (extent > 1) {
        one = ldexp(1, -he_exponent_of(extent));
        p = he_vec3_scale(p, one);
    }
    double w = n->w[0] * p.x + n->w[1] * p.y + n->w[2] * p.z + n->w[3] * one;
    if (!(w > 0)) {
        return false;
    }
    int exponent = 0;
    w = frexp(w, &exponent);
    double x = n->x[0] * p.x + n->x[1] * p.y + n->x[2] * p.z + n->x[3] * one;
    double y = n->y[0] * p.x + n->y[1] * p.y + n->y[2] * p.z + n->y[3] * one;
    out->x = ldexp(x / w, -exponent - n->exponent);
    out->y = ldexp(y / w, -exponent - n->exponent);
    return true;
}

static bool is_between(double a, double b, double x)
{
    return x >= fmin(a, b) && x <= fmax(a, b);
}

bool he_noose_holds(const he_noose *noose, he_vec3 point)
{
    he_vec2 p;
    if (!map(noose, point, &p) || !(p.x >= noose->low.x && p.x <= noose->high.x) ||
        !(p.y >= noose->low.y && p.y <= noose->high.y)) {
        return false;
    }
    int winding = 0;
    he_vec2 a = noose->corners[noose->count - 1];
    for (size_t i = 0; i < noose->count; i++) {
        const he_vec2 b = noose->corners[i];
        if (is_between(a.y, b.y, p.y)) {
            int side = he_orient2(a, b, p);
            if (side == 0 && is_between(a.x, b.x, p.x)) {
                return true;
            }
            if (a.y <= p.y && b.y > p.y) {
                winding += side > 0;
            } else if (a.y > p.y && b.y <= p.y) {
                winding -= side < 0;
            }
        }
        a = b;
    }
    return winding != 0;
}
