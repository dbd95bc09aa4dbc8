#include "geometry/orient.h"

#include <math.h>

/* Upper bounds of the rounding errors of the determinants that he_orient3 (ERROR3) and he_orient2
 * (ERROR2) compute in doubles, relative to the sum of the absolute values of the terms. */
static const double ERROR3 = 8e-16, ERROR2 = 3.4e-16;

static int sign(double x)
{
    return (x > 0) - (x < 0);
}

/* --- expansions: exact sums of doubles, none of them zero, in rising order of size --- */

/* The most components (doubles) of an expansion: as many as the 3 x 3 determinant of he_orient3 may
 * need. */
enum { MOST = 192 };

typedef struct expansion {
    size_t count;
    double part[MOST];
} expansion;

typedef struct pair {
    double low, high;
} pair;

static pair exact_sum(double a, double b)
{
    double x = a + b, virtual = x - a;
    return (pair){(a - (x - virtual)) + (b - virtual), x};
}

static pair exact_product(double a, double b)
{
    double x = a * b;
    return (pair){fma(a, b, -x), x};
}

/* Adds the number b to an expansion. b is added to each component, from the smallest to the
 * largest; the rounding error of each addition becomes a component of the result. */
static void grow(expansion *e, double b)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->count; i++) {
        pair s = exact_sum(b, e->part[i]);
        b = s.high;
        if (s.low != 0) {
            e->part[kept++] = s.low;
        }
    }
    if (b != 0) {
        e->part[kept++] = b;
    }
    e->count = kept;
}

/* Adds the product a * b * c * sign_of to an expansion. Each of the factors a, b and c is the exact
 * sum of a pair of doubles. Usually `low` is 0 in all three factors; then seven of the eight terms
 * of the product are zero and are skipped. */
static void add_product(expansion *e, pair a, pair b, pair c, double sign_of)
{
    const double as[2] = {a.low, a.high}, bs[2] = {b.low, b.high}, cs[2] = {c.low, c.high};
    for (int i = 0; i < 8; i++) {
        if (as[i & 1] == 0 || bs[i >> 1 & 1] == 0 || cs[i >> 2] == 0) {
            continue;
        }
        pair ab = exact_product(as[i & 1], bs[i >> 1 & 1]);
        pair low = exact_product(ab.low, sign_of * cs[i >> 2]);
        pair high = exact_product(ab.high, sign_of * cs[i >> 2]);
        grow(e, low.low);
        grow(e, low.high);
        grow(e, high.low);
        grow(e, high.high);
    }
}

static int sign_of(const expansion *e)
{
    return e->count == 0 ? 0 : sign(e->part[e->count - 1]);
}

static pair difference(double a, double b)
{
    return exact_sum(a, -b);
}

/* --- numbers with twice the digits of a double, each stored as a pair of doubles (T. J. Dekker, "A
 * floating-point technique for extending the available precision", 1971) --- */

/* Upper bound of the rounding error of the 3 x 3 determinant if it is computed with pairs of
 * doubles, relative to the sum of the absolute values of its terms. Each of about twelve operations
 * adds less than 2^-102. */
static const double PAIR_ERROR3 = 0x1p-96;

static pair sum_of(pair a, pair b)
{
    pair high = exact_sum(a.high, b.high), low = exact_sum(a.low, b.low);
    pair sum = exact_sum(high.high, high.low + low.high);
    return exact_sum(sum.high, sum.low + low.low);
}

static pair product_of(pair a, pair b)
{
    pair p = exact_product(a.high, b.high);
    return exact_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

/* Returns a * d - b * c. */
static pair minor_of(pair a, pair b, pair c, pair d)
{
    pair left = product_of(a, d), right = product_of(b, c);
    return sum_of(left, (pair){-right.low, -right.high});
}

/* --- determinants --- */

/* Returns the exact sign of the determinant of he_orient3. `size` is the sum of the absolute values
 * of the determinant's terms. */
static int exact3(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d, double size)
{
    pair ax = difference(a.x, d.x), ay = difference(a.y, d.y), az = difference(a.z, d.z);
    pair bx = difference(b.x, d.x), by = difference(b.y, d.y), bz = difference(b.z, d.z);
    pair cx = difference(c.x, d.x), cy = difference(c.y, d.y), cz = difference(c.z, d.z);
    pair close = sum_of(
        sum_of(product_of(az, minor_of(bx, by, cx, cy)), product_of(bz, minor_of(cx, cy, ax, ay))),
        product_of(cz, minor_of(ax, ay, bx, by)));
    if (fabs(close.high) > PAIR_ERROR3 * size) {
        return sign(close.high);
    }
    expansion e = {.count = 0};
    add_product(&e, ax, by, cz, 1);
    add_product(&e, ax, bz, cy, -1);
    add_product(&e, bx, cy, az, 1);
    add_product(&e, bx, cz, ay, -1);
    add_product(&e, cx, ay, bz, 1);
    add_product(&e, cx, az, by, -1);
    return sign_of(&e);
}

static he_vec3 minus(he_vec3 a, he_vec3 b)
{
    return (he_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

int he_orient3(he_vec3 a, he_vec3 b, he_vec3 c, he_vec3 d)
{
    he_vec3 u = minus(a, d), v = minus(b, d), w = minus(c, d);
    double vxwy = v.x * w.y, wxvy = w.x * v.y, wxuy = w.x * u.y, uxwy = u.x * w.y, uxvy = u.x * v.y,
           vxuy = v.x * u.y;
    double determinant = u.z * (vxwy - wxvy) + v.z * (wxuy - uxwy) + w.z * (uxvy - vxuy);
    double size = (fabs(vxwy) + fabs(wxvy)) * fabs(u.z) + (fabs(wxuy) + fabs(uxwy)) * fabs(v.z) +
                  (fabs(uxvy) + fabs(vxuy)) * fabs(w.z);
    if (size == 0) {
        return 0; /* exact: a difference of doubles is 0 only if they are equal */
    }
    return fabs(determinant) > ERROR3 * size ? sign(determinant) : exact3(a, b, c, d, size);
}

int he_orient2(he_vec2 a, he_vec2 b, he_vec2 c)
{
    double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
    if (fabs(left - right) > ERROR2 * (fabs(left) + fabs(right))) {
        return sign(left - right);
    }
    if (left == 0 && right == 0) {
        return 0; /* exact: a difference of doubles is 0 only if they are equal */
    }
    expansion e = {.count = 0};
    const pair one = {0, 1};
    add_product(&e, difference(a.x, c.x), difference(b.y, c.y), one, 1);
    add_product(&e, difference(a.y, c.y), difference(b.x, c.x), one, -1);
    return sign_of(&e);
}
