#include "geometry/triangle_intersection.h"

#include "geometry/orient.h"

/* --- intersection tests in a plane --- */

/* Projects a point by dropping one axis. Coordinates stay as they are, so nothing is rounded. */
static he_vec2 flat(he_vec3 p, int axis)
{
    return axis == 0 ? (he_vec2){p.y, p.z} : axis == 1 ? (he_vec2){p.z, p.x} : (he_vec2){p.x, p.y};
}

/* Returns the axis along which the triangle's projection has the largest area, subject to
 * rounding. */
static int likely_axis(const he_vec3 t[3])
{
    he_vec3 n = he_vec3_cross(he_vec3_sub(t[1], t[0]), he_vec3_sub(t[2], t[0]));
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return x > y && x > z ? 0 : y > z ? 1 : 2;
}

/* Returns an axis along which the triangle's projection has area, -1 if it has none. */
static int open_axis(const he_vec3 t[3])
{
    int likely = likely_axis(t);
    for (int i = 0; i < 3; i++) {
        int axis = (likely + i) % 3;
        if (he_orient2(flat(t[0], axis), flat(t[1], axis), flat(t[2], axis)) != 0) {
            return axis;
        }
    }
    return -1;
}

bool he_triangle_has_area(const he_vec3 t[3])
{
    return open_axis(t) >= 0;
}

/* Returns true if p, which is on the line of a and b, lies between them. */
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

/* Returns true if a segment and a triangle in one plane intersect. Both are projected along an
 * axis. */
static bool flat_segment_meets(he_vec3 p, he_vec3 q, const he_vec3 t[3], int axis)
{
    he_vec2 a = flat(p, axis), b = flat(q, axis);
    he_vec2 c[3] = {flat(t[0], axis), flat(t[1], axis), flat(t[2], axis)};
    return is_inside(a, c) || is_inside(b, c) || segments_meet(a, b, c[0], c[1]) ||
           segments_meet(a, b, c[1], c[2]) || segments_meet(a, b, c[2], c[0]);
}

/* Two triangles, projected along an axis along which triangle a has area. Triangle b then has area,
 * too, if it is in the same plane. */
typedef struct flat_pair {
    he_vec2 a[3], b[3];
} flat_pair;

static flat_pair flatten(const he_vec3 a[3], const he_vec3 b[3], int axis)
{
    return (flat_pair){{flat(a[0], axis), flat(a[1], axis), flat(a[2], axis)},
                       {flat(b[0], axis), flat(b[1], axis), flat(b[2], axis)}};
}

/* Returns true if all corners of triangle u are beyond the line of the side of triangle t that
 * begins at corner i; false if t has no area. */
static bool is_beyond_side(const he_vec2 t[3], int i, const he_vec2 u[3])
{
    he_vec2 p = t[i], q = t[(i + 1) % 3];
    int beyond = -he_orient2(p, q, t[(i + 2) % 3]);
    return beyond != 0 && he_orient2(p, q, u[0]) == beyond && he_orient2(p, q, u[1]) == beyond &&
           he_orient2(p, q, u[2]) == beyond;
}

/* Returns true if two triangles in one plane intersect. They are disjoint exactly if one lies
 * beyond some side of the other, because the differences of their points fill a convex polygon,
 * whose sides are parallel to theirs. */
static bool flat_meet(const flat_pair *f)
{
    for (int i = 0; i < 3; i++) {
        if (is_beyond_side(f->a, i, f->b) || is_beyond_side(f->b, i, f->a)) {
            return false;
        }
    }
    return true;
}

/* The sector of triangle t at its corner `at` is on one side of the line through its ray to corner
 * `to`. Returns true if the sector of triangle u at its corner `of`, which is at the position of
 * `at`, is on the other side, without touching that ray. */
static bool is_beyond_ray(const he_vec2 t[3], int at, int to, const he_vec2 u[3], int of)
{
    he_vec2 apex = t[at], ray = t[to];
    int beyond = -he_orient2(apex, ray, t[3 - at - to]);
    for (int k = 1; k < 3; k++) {
        he_vec2 other = u[(of + k) % 3];
        int turn = he_orient2(apex, ray, other);
        if (turn != beyond && (turn != 0 || !between(ray, other, apex))) {
            return false;
        }
    }
    return true;
}

/* Returns true if two triangles in one plane with a common corner share other points. They do so
 * exactly if their sectors at that corner share a ray. If they share none, the line through one of
 * their four rays separates them. */
static bool flat_meet_beyond_corner(const flat_pair *f, int at_a, int at_b)
{
    for (int k = 1; k < 3; k++) {
        if (is_beyond_ray(f->a, at_a, (at_a + k) % 3, f->b, at_b) ||
            is_beyond_ray(f->b, at_b, (at_b + k) % 3, f->a, at_a)) {
            return false;
        }
    }
    return true;
}

/* Returns true if two triangles in one plane that share the side opposite to corners i and k
 * overlap. They do so if they are on the same side of that common side. */
static bool flat_meet_beyond_side(const flat_pair *f, int i, int k)
{
    he_vec2 p = f->a[(i + 1) % 3], q = f->a[(i + 2) % 3];
    return he_orient2(p, q, f->a[i]) == he_orient2(p, q, f->b[k]);
}

/* --- intersection tests in space --- */

/* Two triangles, and on which side of each one's plane the corners of the other are. */
typedef struct meeting {
    const he_vec3 *t[2];
    /* side[0]: where the corners of t[0] are, as seen from the plane of t[1]; side[1]: the
     * reverse. */
    int side[2][3];
} meeting;

/* Returns true if the side that begins at corner i of triangle `of` intersects the other
 * triangle. */
static bool side_meets(const meeting *m, int of, int i)
{
    const he_vec3 *t = m->t[1 - of];
    int k = (i + 1) % 3, at_p = m->side[of][i], at_q = m->side[of][k];
    he_vec3 p = m->t[of][i], q = m->t[of][k];
    if (at_p == 0 && at_q == 0) {
        return flat_segment_meets(p, q, t, open_axis(t));
    }
    if (at_p * at_q > 0) {
        return false;
    }
    int turns[3];
    for (int j = 0; j < 3; j++) {
        turns[j] = he_orient3(p, q, t[j], t[(j + 1) % 3]);
    }
    return (turns[0] >= 0 && turns[1] >= 0 && turns[2] >= 0) ||
           (turns[0] <= 0 && turns[1] <= 0 && turns[2] <= 0);
}

/* Computes on which sides of the plane of t[1 - of] the corners of t[of] are; corners in the set
 * `shared`, which both triangles have, lie in the plane. Returns true if all other corners are on
 * one side and none is in the plane, as for nearly all neighbours. */
static bool is_beside(meeting *m, int of, unsigned shared)
{
    const he_vec3 *plane = m->t[1 - of];
    int least = 1, most = -1;
    for (unsigned k = 0; k < 3; k++) {
        m->side[of][k] = 0;
        if (shared >> k & 1) {
            continue;
        }
        int side = he_orient3(plane[0], plane[1], plane[2], m->t[of][k]);
        m->side[of][k] = side;
        least = side < least ? side : least;
        most = side > most ? side : most;
    }
    return least == most && most != 0;
}

static bool is_in_plane(const int side[3])
{
    return side[0] == 0 && side[1] == 0 && side[2] == 0;
}

static bool same(he_vec3 p, he_vec3 q)
{
    return p.x == q.x && p.y == q.y && p.z == q.z;
}

bool he_triangles_intersect(const he_vec3 a[3], const he_vec3 b[3])
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
    meeting m = {.t = {a, b}};
    if (is_beside(&m, 1, of_b)) {
        return false;
    }
    bool flat = is_in_plane(m.side[1]);
    if ((!flat && is_beside(&m, 0, of_a)) || !he_triangle_has_area(a) || !he_triangle_has_area(b)) {
        return false;
    }
    if (shared == 3) {
        return true;
    }
    if (flat) {
        const flat_pair f = flatten(a, b, open_axis(a));
        return shared == 0   ? flat_meet(&f)
               : shared == 1 ? flat_meet_beyond_corner(&f, at_a, at_b)
                             : flat_meet_beyond_side(&f, 3 - sum_a, 3 - sum_b);
    }
    if (shared == 1) {
        /* If both triangles contain more than the shared corner, what they have in common reaches
         * the side opposite to that corner in one of them, and this side intersects the other
         * triangle. */
        return side_meets(&m, 0, (at_a + 1) % 3) || side_meets(&m, 1, (at_b + 1) % 3);
    }
    /* If the projections of the triangles are disjoint, the triangles are disjoint, too; this test
     * is cheaper than the ones that follow. */
    const flat_pair seen = flatten(a, b, likely_axis(a));
    if (!flat_meet(&seen)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        if (side_meets(&m, 0, i) || side_meets(&m, 1, i)) {
            return true;
        }
    }
    return false;
}
