/* rotation.c - the nearest rotation, by one of two ways.
 *
 * Let s1 >= s2 >= |s3| be the singular values of the matrix S, with s3 below 0 if the determinant
 * is. The largest product of S and a rotation is z = s1 + s2 + s3, the largest root of
 *
 *     p(z) = (z^2 - |S|^2)^2 - 8 z det S - 4 |cof S|^2,
 *
 * where cof S is the matrix of cofactors; Newton's method finds it from above. The rotation is the
 * gradient of z with respect to S. As p(z) = 0 for all S, it is the quotient of the derivatives of
 * p:
 *
 *     R = ((z^2 + |S|^2) S + 2 z cof S - 2 S S' S) / (z (z^2 - |S|^2) - 2 det S).
 *
 * The divisor is 2 (s1 + s2) (s2 + s3) (s3 + s1). If it is small, R is found as Horn does, as the
 * quaternion that is the eigenvector of a symmetric matrix. */
#include "deform/rotation.h"

#include <float.h>
#include <string.h>

static const he_rotation NO_ROTATION = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};

static void multiply(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
        }
    }
}

/* Sets `out` to A B', where B' is B with rows and columns exchanged. */
static void multiply_turned(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[3 * i + j] =
                a[3 * i] * b[3 * j] + a[3 * i + 1] * b[3 * j + 1] + a[3 * i + 2] * b[3 * j + 2];
        }
    }
}

static double square_of(const double a[9])
{
    double sum = 0;
    for (int i = 0; i < 9; i++) {
        sum += a[i] * a[i];
    }
    return sum;
}

/* --- by the gradient --- */

/* Returns false if the divisor is too small for an exact result. The entries of `s` are at most 1,
 * and one of them is 1 or -1. */
static bool by_gradient(const double s[9], he_rotation *out)
{
    enum { TRIES = 40 };
    static const double SMALL = 0.01;
    const double cof[9] = {
        s[4] * s[8] - s[5] * s[7], s[5] * s[6] - s[3] * s[8], s[3] * s[7] - s[4] * s[6],
        s[2] * s[7] - s[1] * s[8], s[0] * s[8] - s[2] * s[6], s[1] * s[6] - s[0] * s[7],
        s[1] * s[5] - s[2] * s[4], s[2] * s[3] - s[0] * s[5], s[0] * s[4] - s[1] * s[3]};
    const double det = s[0] * cof[0] + s[1] * cof[1] + s[2] * cof[2];
    const double square = square_of(s), constant = 4 * square_of(cof);
    double z = sqrt(3 * square), divisor = 0;
    for (int i = 0; i < TRIES; i++) {
        const double over = z * z - square;
        divisor = z * over - 2 * det;
        if (!(divisor > SMALL)) {
            return false;
        }
        const double step = (over * over - 8 * z * det - constant) / (4 * divisor);
        z -= step;
        if (fabs(step) < 2 * DBL_EPSILON * z) {
            break;
        }
    }
    double gram[9], cubic[9], r[9];
    multiply_turned(s, s, gram);
    multiply(gram, s, cubic);
    for (int i = 0; i < 9; i++) {
        r[i] = ((z * z + square) * s[i] + 2 * z * cof[i] - 2 * cubic[i]) / divisor;
    }
    /* A step of Newton's method for the polar factor makes the rows orthogonal up to rounding. */
    multiply_turned(r, r, gram);
    multiply(gram, r, cubic);
    for (int i = 0; i < 9; i++) {
        out->k[i] = 1.5 * r[i] - 0.5 * cubic[i];
    }
    return true;
}

/* --- by quaternions --- */

/* Rotates lines and columns p and q of a symmetric matrix so that entry (p, q) becomes 0 (Jacobi's
 * method), and the columns of `vectors` in the same way. */
static void turn(double k[4][4], double vectors[4][4], int p, int q)
{
    const double theta = (k[q][q] - k[p][p]) / (2 * k[p][q]);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1));
    const double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int i = 0; i < 4; i++) {
        const double a = k[i][p], b = k[i][q];
        k[i][p] = c * a - s * b;
        k[i][q] = s * a + c * b;
    }
    for (int i = 0; i < 4; i++) {
        const double a = k[p][i], b = k[q][i];
        k[p][i] = c * a - s * b;
        k[q][i] = s * a + c * b;
    }
    for (int i = 0; i < 4; i++) {
        const double a = vectors[i][p], b = vectors[i][q];
        vectors[i][p] = c * a - s * b;
        vectors[i][q] = s * a + c * b;
    }
}

static he_rotation rotation_of(double w, double x, double y, double z)
{
    return (he_rotation){{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y),
                          2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
                          2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
}

/* Finds the rotation by the eigenvector of the largest eigenvalue. Returns false if the second
 * eigenvalue is hardly smaller. */
static bool by_quaternion(const double s[9], he_rotation *out)
{
    enum { SWEEPS = 30 };
    double k[4][4] = {
        {s[0] + s[4] + s[8], s[7] - s[5], s[2] - s[6], s[3] - s[1]},
        {s[7] - s[5], s[0] - s[4] - s[8], s[1] + s[3], s[2] + s[6]},
        {s[2] - s[6], s[1] + s[3], s[4] - s[0] - s[8], s[5] + s[7]},
        {s[3] - s[1], s[2] + s[6], s[5] + s[7], s[8] - s[0] - s[4]},
    };
    double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        bool turned = false;
        for (int p = 0; p < 3; p++) {
            for (int q = p + 1; q < 4; q++) {
                if (fabs(k[p][q]) > 1e-17) {
                    turn(k, v, p, q);
                    turned = true;
                }
            }
        }
        if (!turned) {
            break;
        }
    }
    int best = 0;
    for (int i = 1; i < 4; i++) {
        best = k[i][i] > k[best][best] ? i : best;
    }
    double gap = INFINITY;
    for (int i = 0; i < 4; i++) {
        gap = i == best ? gap : fmin(gap, k[best][best] - k[i][i]);
    }
    *out = rotation_of(v[0][best], v[1][best], v[2][best], v[3][best]);
    return gap > 1e-13;
}

he_rotation he_rotation_nearest(const double s[9])
{
    double size = 0, scaled[9];
    for (int i = 0; i < 9; i++) {
        size = fabs(s[i]) > size ? fabs(s[i]) : size;
    }
    if (!(size > DBL_MIN) || isinf(size)) {
        return NO_ROTATION;
    }
    for (int i = 0; i < 9; i++) {
        scaled[i] = s[i] / size;
    }
    he_rotation r = NO_ROTATION;
    if (by_gradient(scaled, &r) || by_quaternion(scaled, &r)) {
        return r;
    }
    /* Several rotations are nearest: a little of the identity prefers one that turns little. */
    for (int i = 0; i < 9; i += 4) {
        scaled[i] += 1e-9;
    }
    (void)by_quaternion(scaled, &r);
    return r;
}
