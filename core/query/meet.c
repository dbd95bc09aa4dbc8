#include "query/meet.h"

#include "mesh/orient.h"

/* --- in the plane of both --- */

/* Drop one axis. Coordinates stay as they are, so nothing is rounded. */
static he_vec2 flat(he_vec3 p, int axis)
{
    return axis == 0 ? (he_vec2){p.y, p.z} : axis == 1 ? (he_vec2){p.z, p.x} : (he_vec2){p.x, p.y};
}

/* An axis along which the triangle is seen with area, -1 when it has none. */
static int open_axis(const he_vec3 t[3])
{
    for (int axis = 0; axis < 3; axis++) {
        if (he_orient2(flat(t[0], axis), flat(t[1], axis), flat(t[2], axis)) != 0) {
            return axis;
        }
    }
    return -1;
}

/* p is on the line of a and b: is it between them? */
static bool between(he_vec2 a, he_vec2 b, he_vec2 p)
{
    return fmin(a.x, b.x) <= p.x && p.x <= fmax(a.x, b.x) && fmin(a.y, b.y) <= p.y &&
           p.y <= fmax(a.y, b.y);
}

static bool segments_meet(he_vec2 a, he_vec2 b, he_vec2 c, he_vec2 d)
{
    int abc = he_orient2(a, b, c), abd = he_orient2(a, b, d);
    int cda = he_orient2(c, d, a), cdb = he_orient2(c, d, b);
    if (abc * abd < 0 && cda * cdb < 0) {
        return true;
    }
    return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
           (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
}

static bool is_inside(he_vec2 p, const he_vec2 t[3])
{
    int turns[3];
    for (int i = 0; i < 3; i++) {
        turns[i] = he_orient2(t[i], t[(i + 1) % 3], p);
    }
    return (turns[0] >= 0 && turns[1] >= 0 && turns[2] >= 0) ||
           (turns[0] <= 0 && turns[1] <= 0 && turns[2] <= 0);
}

static bool flat_segment_meets(he_vec3 p, he_vec3 q, const he_vec3 t[3])
{
    int axis = open_axis(t);
    he_vec2 a = flat(p, axis), b = flat(q, axis);
    he_vec2 c[3] = {flat(t[0], axis), flat(t[1], axis), flat(t[2], axis)};
    return is_inside(a, c) || is_inside(b, c) || segments_meet(a, b, c[0], c[1]) ||
           segments_meet(a, b, c[1], c[2]) || segments_meet(a, b, c[2], c[0]);
}

/* --- in space --- */

/* A segment and a triangle that has area. */
static bool segment_meets(he_vec3 p, he_vec3 q, const he_vec3 t[3])
{
    int at_p = he_orient3(t[0], t[1], t[2], p), at_q = he_orient3(t[0], t[1], t[2], q);
    if (at_p == 0 && at_q == 0) {
        return flat_segment_meets(p, q, t);
    }
    if (at_p * at_q > 0) {
        return false;
    }
    int turns[3];
    for (int i = 0; i < 3; i++) {
        turns[i] = he_orient3(p, q, t[i], t[(i + 1) % 3]);
    }
    return (turns[0] >= 0 && turns[1] >= 0 && turns[2] >= 0) ||
           (turns[0] <= 0 && turns[1] <= 0 && turns[2] <= 0);
}

/* Do the corners of b that are not in the set `shared` lie on one side of the plane of a, with none
 * in it? */
static bool is_beside(const he_vec3 a[3], const he_vec3 b[3], unsigned shared)
{
    int first = 0;
    for (unsigned k = 0; k < 3; k++) {
        if (shared >> k & 1) {
            continue;
        }
        int side = he_orient3(a[0], a[1], a[2], b[k]);
        if (side == 0 || side == -first) {
            return false;
        }
        first = side;
    }
    return first != 0;
}

static bool same(he_vec3 p, he_vec3 q)
{
    return p.x == q.x && p.y == q.y && p.z == q.z;
}

/* What leaves a shared corner on both triangles ends on the side opposite to it of one, which the
 * other then meets. */
static bool meet_beyond_corner(const he_vec3 a[3], const he_vec3 b[3], int i, int k)
{
    return segment_meets(a[(i + 1) % 3], a[(i + 2) % 3], b) ||
           segment_meets(b[(k + 1) % 3], b[(k + 2) % 3], a);
}

/* Triangles in one plane that share the side opposite to corners i and k lie on one another when
 * they are on the same side of it. */
static bool meet_beyond_side(const he_vec3 a[3], const he_vec3 b[3], int i, int k)
{
    he_vec3 p = a[(i + 1) % 3], q = a[(i + 2) % 3];
    int axis = open_axis(a);
    int left = he_orient2(flat(p, axis), flat(q, axis), flat(a[i], axis));
    return left == he_orient2(flat(p, axis), flat(q, axis), flat(b[k], axis));
}

bool he_triangles_meet(const he_vec3 a[3], const he_vec3 b[3])
{
    int shared = 0, at_a = 0, at_b = 0, sum_a = 0, sum_b = 0;
    unsigned of_a = 0, of_b = 0;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            if (same(a[i], b[k])) {
                shared++;
                at_a = i;
                at_b = k;
                sum_a += i;
                sum_b += k;
                of_a |= 1u << i;
                of_b |= 1u << k;
            }
        }
    }
    /* Nearly all neighbours end here. */
    if (is_beside(a, b, of_b) || is_beside(b, a, of_a)) {
        return false;
    }
    if (open_axis(a) < 0 || open_axis(b) < 0) {
        return false;
    }
    if (shared == 1) {
        return meet_beyond_corner(a, b, at_a, at_b);
    }
    if (shared == 2) {
        return meet_beyond_side(a, b, 3 - sum_a, 3 - sum_b);
    }
    if (shared == 3) {
        return true;
    }
    for (int i = 0; i < 3; i++) {
        if (segment_meets(a[i], a[(i + 1) % 3], b) || segment_meets(b[i], b[(i + 1) % 3], a)) {
            return true;
        }
    }
    return false;
}
