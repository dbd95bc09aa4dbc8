#include "tests/unit/triangle_intersection_oracle.h"

#include <math.h>

static he_vec2 oracle_seen(he_vec3 p, int axis)
{
    return axis == 0 ? (he_vec2){p.y, p.z} : axis == 1 ? (he_vec2){p.z, p.x} : (he_vec2){p.x, p.y};
}

/* Returns the first axis (0, 1 or 2) along which the triangle can be projected so that the
 * projection has an area. Returns 3 if the triangle itself has no area. */
static int oracle_axis(const he_vec3 t[3])
{
    int axis = 0;
    while (axis < 3 && he_orient2(oracle_seen(t[0], axis), oracle_seen(t[1], axis),
                                  oracle_seen(t[2], axis)) == 0) {
        axis++;
    }
    return axis;
}

static bool oracle_one_way(int a, int b, int c)
{
    return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

static bool oracle_is_in(he_vec2 p, const he_vec2 t[3])
{
    return oracle_one_way(he_orient2(t[0], t[1], p), he_orient2(t[1], t[2], p),
                          he_orient2(t[2], t[0], p));
}

static bool oracle_is_on(he_vec2 a, he_vec2 b, he_vec2 p)
{
    return he_orient2(a, b, p) == 0 && fmin(a.x, b.x) <= p.x && p.x <= fmax(a.x, b.x) &&
           fmin(a.y, b.y) <= p.y && p.y <= fmax(a.y, b.y);
}

static bool oracle_cross(he_vec2 a, he_vec2 b, he_vec2 c, he_vec2 d)
{
    return (he_orient2(a, b, c) * he_orient2(a, b, d) < 0 &&
            he_orient2(c, d, a) * he_orient2(c, d, b) < 0) ||
           oracle_is_on(a, b, c) || oracle_is_on(a, b, d) || oracle_is_on(c, d, a) ||
           oracle_is_on(c, d, b);
}

/* Returns whether the segment from p to q meets the triangle t, which must have an area. */
static bool oracle_segment(he_vec3 p, he_vec3 q, const he_vec3 t[3])
{
    int at_p = he_orient3(t[0], t[1], t[2], p), at_q = he_orient3(t[0], t[1], t[2], q);
    if (at_p == 0 && at_q == 0) {
        int axis = oracle_axis(t);
        he_vec2 a = oracle_seen(p, axis), b = oracle_seen(q, axis);
        he_vec2 c[3] = {oracle_seen(t[0], axis), oracle_seen(t[1], axis), oracle_seen(t[2], axis)};
        return oracle_is_in(a, c) || oracle_is_in(b, c) || oracle_cross(a, b, c[0], c[1]) ||
               oracle_cross(a, b, c[1], c[2]) || oracle_cross(a, b, c[2], c[0]);
    }
    return at_p * at_q <= 0 &&
           oracle_one_way(he_orient3(p, q, t[0], t[1]), he_orient3(p, q, t[1], t[2]),
                          he_orient3(p, q, t[2], t[0]));
}

static bool oracle_is_at(he_vec3 p, he_vec3 q)
{
    return p.x == q.x && p.y == q.y && p.z == q.z;
}

bool oracle_triangles_meet(const he_vec3 a[3], const he_vec3 b[3])
{
    int shared = 0, i = 0, k = 0, sum_i = 0, sum_k = 0;
    if (oracle_axis(a) == 3 || oracle_axis(b) == 3) {
        return false;
    }
    for (int n = 0; n < 9; n++) {
        if (oracle_is_at(a[n / 3], b[n % 3])) {
            shared++;
            i = n / 3;
            k = n % 3;
            sum_i += i;
            sum_k += k;
        }
    }
    if (shared == 3) {
        return true;
    }
    if (shared == 2) {
        he_vec3 from = a[(4 - sum_i) % 3], to = a[(5 - sum_i) % 3];
        he_vec3 tip = a[3 - sum_i], other = b[3 - sum_k];
        int axis = oracle_axis(a);
        return he_orient3(a[0], a[1], a[2], other) == 0 &&
               he_orient2(oracle_seen(from, axis), oracle_seen(to, axis), oracle_seen(tip, axis)) ==
                   he_orient2(oracle_seen(from, axis), oracle_seen(to, axis),
                              oracle_seen(other, axis));
    }
    if (shared == 1) {
        return oracle_segment(a[(i + 1) % 3], a[(i + 2) % 3], b) ||
               oracle_segment(b[(k + 1) % 3], b[(k + 2) % 3], a);
    }
    bool meet = false;
    for (int n = 0; n < 3; n++) {
        meet = meet || oracle_segment(a[n], a[(n + 1) % 3], b) ||
               oracle_segment(b[n], b[(n + 1) % 3], a);
    }
    return meet;
}
