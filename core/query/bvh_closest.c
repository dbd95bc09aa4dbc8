#include "geometry/geometry.h"
#include "query/bvh_disc.h"
#include "query/bvh_walk.h"

#include <string.h>

static double square(he_vec3 a)
{
    return he_vec3_dot(a, a);
}

/* Returns where the point of the segment from a to b that is nearest to p lies: 0 at a, 1 at b,
 * linear in between. */
static double along(he_vec3 p, he_vec3 a, he_vec3 b)
{
    he_vec3 ab = he_vec3_sub(b, a);
    double t = he_vec3_dot(he_vec3_sub(p, a), ab) / square(ab);
    return t > 0 ? (t < 1 ? t : 1) : 0; /* if a and b are equal, t is NaN, and the result is 0 */
}

/* Projects p perpendicularly onto the plane of a triangle. Returns false if the projected point is
 * outside the triangle, or if the triangle is too thin to decide that. `thin` is set if rounding
 * may have moved the projected point noticeably. */
static bool over(he_vec3 p, const he_vec3 c[3], double weight[3], bool *thin)
{
    he_vec3 u = he_vec3_sub(c[1], c[0]), v = he_vec3_sub(c[2], c[0]), w = he_vec3_sub(p, c[0]);
    he_vec3 normal = he_vec3_cross(u, v);
    double area = square(normal);
    weight[0] = weight[1] = weight[2] = 0;
    const double widest = square(u) * square(v);
    *thin = !(area > 1e-8 * widest);
    if (!(area > 1e-24 * widest)) {
        return false;
    }
    weight[1] = he_vec3_dot(he_vec3_cross(w, v), normal) / area;
    weight[2] = he_vec3_dot(he_vec3_cross(u, w), normal) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
}

/* The best result so far of a search for the point of the mesh nearest to a query point: the
 * nearest point, and the vector from it to the query point. */
typedef struct approach {
    he_vec3 p, back;
    he_bvh_found best;
} approach;

static he_vec3 from_point(he_vec3 p, const he_vec3 c[3], const double weight[3])
{
    he_vec3 q =
        he_vec3_add(he_vec3_add(he_vec3_scale(c[0], weight[0]), he_vec3_scale(c[1], weight[1])),
                    he_vec3_scale(c[2], weight[2]));
    return he_vec3_sub(p, q);
}

/* If p is not over the triangle, the nearest point is on a side that separates p from it: the
 * weight of the corner opposite to that side is negative. Sides whose weight is larger than this,
 * which is far more than the rounding errors of triangles that are not thin, are not tried. */
static const double INSIDE = 1e-4;

he_vec3 he_bvh_to_triangle(he_vec3 p, const he_vec3 c[3], double weight[3])
{
    he_vec3 back = p;
    double best = HUGE_VAL, before[3];
    bool thin;
    const bool is_over = over(p, c, before, &thin);
    memcpy(weight, before, sizeof before);
    if (is_over) {
        back = from_point(p, c, weight);
        if (!thin) {
            return back;
        }
        best = square(back);
    }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        if (!thin && before[(i + 2) % 3] > INSIDE) {
            continue;
        }
        double t = along(p, c[i], c[j]), own[3] = {0, 0, 0};
        own[i] = 1 - t;
        own[j] += t;
        he_vec3 way = from_point(p, c, own);
        if (square(way) < best) {
            best = square(way);
            back = way;
            weight[0] = own[0];
            weight[1] = own[1];
            weight[2] = own[2];
        }
    }
    return back;
}

/* By rounding, the computed distance to a box may exceed that to a triangle in the box by at most
 * this factor. */
static const double SLACK = 1 + 16 * DBL_EPSILON;
static const double FLOAT_SLACK = 1 + 16 * (double)FLT_EPSILON; /* the same for floats */

/* Returns true if a triangle lies behind the plane that passes through the best point so far and is
 * perpendicular to the vector from this point to the query point. Such a triangle is farther away
 * than the best point. */
static bool is_behind(const approach *a, const he_vec3 c[3])
{
    double far = a->best.far * SLACK;
    return he_vec3_dot(he_vec3_sub(a->p, c[0]), a->back) > far &&
           he_vec3_dot(he_vec3_sub(a->p, c[1]), a->back) > far &&
           he_vec3_dot(he_vec3_sub(a->p, c[2]), a->back) > far;
}

static void try_triangle(approach *a, const he_bvh *tree, const he_mesh *m, uint32_t triangle)
{
    he_vec3 c[3];
    double weight[3] = {1, 0, 0};
    he_bvh_corners(tree, m, triangle, c);
    if (is_behind(a, c)) {
        return;
    }
    he_vec3 back = he_bvh_to_triangle(a->p, c, weight);
    double distance = square(back);
    bool nearer = distance < a->best.far;
    bool least = distance == a->best.far &&
                 (a->best.triangle == HE_NONE ||
                  tree->triangles[triangle].face < tree->triangles[a->best.triangle].face);
    if (nearer || least) {
        a->best = (he_bvh_found){triangle, {weight[0], weight[1], weight[2]}, distance};
        a->back = back;
    }
}

/* A point between two points in floats, so that distances from boxes can be bounded. Distances are
 * multiplied by 2 * `scale`, so that the squares of large ones do not overflow. */
typedef struct seen_point {
    float low[3], high[3], scale;
} seen_point;

/* Returns a float that is not greater than x. */
static float downward(double x)
{
    const float near = (float)x;
    return near - fabsf(near) * FLT_EPSILON - FLT_MIN;
}

static seen_point seen_from(he_vec3 p)
{
    const double extent = he_vec3_extent(p);
    return (seen_point){{downward(p.x), downward(p.y), downward(p.z)},
                        {-downward(-p.x), -downward(-p.y), -downward(-p.z)},
                        extent < 0x1p30 ? 0.5f : 0x1p-71f};
}

/* Computes lower bounds of the squared distances from a point to the boxes of the children of a
 * node. x + |x| is 2x or 0, which compilers compute for all children at once, unlike a maximum. */
static void to_boxes(const seen_point *p, const he_bvh_wide *node, float out[HE_BVH_WIDTH])
{
    for (int i = 0; i < HE_BVH_WIDTH; i++) {
        float sum = 0;
        for (int k = 0; k < 3; k++) {
            const float below = node->min[k][i] - p->high[k], beyond = p->low[k] - node->max[k][i];
            const float d = (below + fabsf(below) + (beyond + fabsf(beyond))) * p->scale;
            sum += d * d;
        }
        out[i] = sum;
    }
}

/* A child of a wide node that is still to be searched. */
typedef struct waiting {
    float near; /* lower bound of the squared distance, multiplied as those of to_boxes */
    uint32_t node, first, count; /* as in he_bvh_wide */
} waiting;

typedef struct search {
    approach a;
    seen_point p;
    float far; /* children whose `near` is larger need not be searched */
    waiting stack[HE_BVH_WIDTH * HE_BOXES_STACK];
    size_t depth;
} search;

static float far_of(const search *s)
{
    const double scale = 2 * (double)s->p.scale;
    /* Squares that are not normal floats may be rounded by more. */
    return (float)(s->a.best.far * FLOAT_SLACK * scale * scale + (double)FLT_MIN);
}

/* Puts the children of a node that may be near enough on the stack, the nearest one on top. */
static void open_node(search *s, const he_bvh_wide *node)
{
    float near[HE_BVH_WIDTH];
    uint32_t open = 0;
    to_boxes(&s->p, node, near);
    for (uint32_t i = 0; i < HE_BVH_WIDTH; i++) {
        open |= (uint32_t)(near[i] <= s->far && node->node[i] != HE_NONE) << i;
    }
    const size_t from = s->depth;
    for (; open != 0; open &= open - 1) {
        const uint32_t i = (uint32_t)__builtin_ctz(open);
        size_t k = s->depth++;
        for (; k > from && s->stack[k - 1].near < near[i]; k--) {
            s->stack[k] = s->stack[k - 1];
        }
        s->stack[k] = (waiting){near[i], node->node[i], node->first[i], node->count[i]};
    }
}

/* Returns true if all triangles in the disc of a node are farther away than the best one. The discs
 * of nodes that are not leaves are only worth their time where the best triangle is farther away
 * than the disc is wide. */
static bool is_beyond(const approach *a, const he_bvh_disc *disc, bool is_leaf)
{
    const double radius = disc->radius;
    return (is_leaf || a->best.far > radius * radius) &&
           he_bvh_to_disc(disc, a->p) > a->best.far * SLACK;
}

static he_status walk(search *s, const he_bvh *tree, const he_mesh *m, he_budget *budget,
                      he_error *err)
{
    he_status status = HE_OK;
    s->p = seen_from(s->a.p);
    s->far = far_of(s);
    s->stack[0] = (waiting){0, 0, 0, 0};
    s->depth = 1;
    while (s->depth > 0 && status == HE_OK) {
        const waiting at = s->stack[--s->depth];
        if (at.near > s->far || is_beyond(&s->a, &tree->discs[at.node], at.count > 0)) {
            continue;
        }
        status = he_budget_take(budget, HE_BVH_LOOK * (1 + (uint64_t)at.count), err);
        if (at.count == 0) {
            open_node(s, &tree->wide[at.first]);
            continue;
        }
        for (uint32_t i = 0; i < at.count; i++) {
            try_triangle(&s->a, tree, m, at.first + i);
        }
        s->far = far_of(s);
    }
    return status;
}

he_status he_bvh_near(const he_bvh *tree, const he_mesh *m, const he_bvh_asked *asked,
                      he_budget *budget, he_bvh_found *out, he_error *err)
{
    search s;
    s.a = (approach){.p = asked->point, .best = {.triangle = HE_NONE, .far = HUGE_VAL}};
    if (asked->hint != HE_NONE) {
        try_triangle(&s.a, tree, m, asked->hint);
    }
    he_status status = walk(&s, tree, m, budget, err);
    if (status == HE_OK) {
        *out = s.a.best;
    }
    return status;
}

he_status he_bvh_closest(const he_bvh *tree, const he_mesh *m, he_vec3 point, double max,
                         he_budget *budget, he_hit *out, he_error *err)
{
    he_hit none = {.face = HE_NONE};
    if (tree->count == 0) {
        *out = none;
        return HE_OK;
    }
    he_vec3 p = {ldexp(point.x, -tree->exponent), ldexp(point.y, -tree->exponent),
                 ldexp(point.z, -tree->exponent)};
    if (!(he_vec3_extent(p) < HE_BVH_FAR)) {
        /* The query point is so far away that only its direction decides which point of the mesh is
         * nearest. */
        he_vec3_normalise(point, &p);
        p = he_vec3_scale(p, HE_BVH_FAR);
    }
    he_bvh_found best;
    he_status status = he_bvh_near(tree, m, &(he_bvh_asked){p, HE_NONE}, budget, &best, err);
    if (status != HE_OK) {
        return status;
    }
    he_hit hit = he_bvh_tell(tree, m, &best);
    he_direction(point, hit.point, &hit.distance);
    *out = hit.distance <= max ? hit : none;
    return HE_OK;
}
