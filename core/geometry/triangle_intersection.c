#include "geometry/triangle_intersection.h"

#include "geometry/orient.h"

/* --- intersection tests in a plane --- */

/* Projects a point along a coordinate axis, by dropping the coordinate on that axis. The remaining
 * coordinates do not change, so nothing is rounded. */
static he_vec2 flat(he_vec3 p, int axis)
{
    return axis == 0 ? (he_vec2){p.y, p.z} : axis == 1 ? (he_vec2){p.z, p.x} : (he_vec2){p.x, p.y};
}

/* Returns the coordinate axis along which the triangle's projection has the largest area. The areas
 * are rounded, so the result may be another axis if two areas are almost equal. */
static int likely_axis(const he_vec3 t[3])
{
    he_vec3 n = he_vec3_cross(he_vec3_sub(t[1], t[0]), he_vec3_sub(t[2], t[0]));
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return x > y && x > z ? 0 : y > z ? 1 : 2;
}

/* Returns a coordinate axis along which the triangle's projection has an area other than 0; -1 if
 * there is none. The test is exact. */
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

/* Returns true if p lies between a and b. p must be on the line through a and b. */
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

/* Returns true if the segment from p to q and the triangle t, which lie in one plane, intersect.
 * The test uses their projections along a coordinate axis. */
static bool flat_segment_meets(he_vec3 p, he_vec3 q, const he_vec3 t[3], int axis)
{
    he_vec2 a = flat(p, axis), b = flat(q, axis);
    he_vec2 c[3] = {flat(t[0], axis), flat(t[1], axis), flat(t[2], axis)};
    return is_inside(a, c) || is_inside(b, c) || segments_meet(a, b, c[0], c[1]) ||
           segments_meet(a, b, c[1], c[2]) || segments_meet(a, b, c[2], c[0]);
}

/* The projections of two triangles along a coordinate axis. The projection of triangle a has area.
 * If the triangles lie in one plane, the projection of triangle b has area, too. */
typedef struct flat_pair {
    he_vec2 a[3], b[3];
} flat_pair;

static flat_pair flatten(const he_vec3 a[3], const he_vec3 b[3], int axis)
{
    return (flat_pair){{flat(a[0], axis), flat(a[1], axis), flat(a[2], axis)},
                       {flat(b[0], axis), flat(b[1], axis), flat(b[2], axis)}};
}

/* Returns true if the line through the side of triangle t that begins at corner i separates the
 * triangles: all corners of u lie on that side of the line on which t does not lie. Returns false
 * if t has no area. */
static bool is_beyond_side(const he_vec2 t[3], int i, const he_vec2 u[3])
{
    he_vec2 p = t[i], q = t[(i + 1) % 3];
    int beyond = -he_orient2(p, q, t[(i + 2) % 3]);
    return beyond != 0 && he_orient2(p, q, u[0]) == beyond && he_orient2(p, q, u[1]) == beyond &&
           he_orient2(p, q, u[2]) == beyond;
}

/* Returns true if two triangles in one plane intersect. Two triangles are disjoint exactly if the
 * line through one of their six sides separates them (separating axis theorem). */
static bool flat_meet(const flat_pair *f)
{
    for (int i = 0; i < 3; i++) {
        if (is_beyond_side(f->a, i, f->b) || is_beyond_side(f->b, i, f->a)) {
            return false;
        }
    }
    return true;
}

/* Two triangles, t and u, have a common corner: corner `at` of t is at the position of corner `of`
 * of u. The sector of a triangle is the angle at this corner, between the rays along two sides of
 * the triangle. Returns true if the line through the ray from corner `at` to corner `to` of t
 * separates the sector of t from the sector of u, and u's sector does not contain that ray. */
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

/* Returns true if two triangles in one plane, with a common corner, share other points, too. They
 * do exactly if their sectors at that corner (is_beyond_ray) share a ray. If the sectors share no
 * ray, the line through one of the four rays that bound the sectors separates the sectors. */
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

/* Returns true if two triangles in one plane with a common side overlap. The side is opposite to
 * corner i of triangle a and to corner k of triangle b. The triangles overlap exactly if these two
 * corners are on one side of the line through the common side. */
static bool flat_meet_beyond_side(const flat_pair *f, int i, int k)
{
    he_vec2 p = f->a[(i + 1) % 3], q = f->a[(i + 2) % 3];
    return he_orient2(p, q, f->a[i]) == he_orient2(p, q, f->b[k]);
}

/* --- intersection tests in space --- */

/* Two triangles in space, and where the corners of each triangle lie relative to the plane of the
 * other triangle. */
typedef struct meeting {
    const he_vec3 *t[2];
    /* side[0][i]: on which side of the plane of t[1] corner i of t[0] lies (0: in the plane);
     * side[1][i]: on which side of the plane of t[0] corner i of t[1] lies */
    int side[2][3];
} meeting;

/* Returns true if a side of one triangle intersects the other triangle. The side begins at corner i
 * of the triangle t[of]. */
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

/* Computes on which side of the plane of triangle t[1 - of] each corner of triangle t[of] lies. Bit
 * i of `shared` is set if corner i of t[of] is also a corner of t[1 - of]; such a corner lies in
 * the plane. Returns true if all other corners lie on one side of the plane and none lies in it.
 * The triangles then do not intersect. This is so for nearly all triangles that are neighbours in a
 * mesh. */
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
        /* The triangles share a corner and lie in different planes, so their common points form a
         * segment that begins at this corner. If the segment is longer than a point, it ends on the
         * side opposite to this corner of one triangle, and that side intersects the other
         * triangle. */
        return side_meets(&m, 0, (at_a + 1) % 3) || side_meets(&m, 1, (at_b + 1) % 3);
    }
    /* If the projections of the triangles are disjoint, the triangles are disjoint, too. This test
     * is cheaper than the tests of the six sides below. */
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
