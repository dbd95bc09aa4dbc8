#include "compare/comparing.h"

/* Upper bounds of the distances of all triangles without samples.
 *
 * The distance to one triangle of `to` is convex, so the largest distance of the corners of a
 * triangle from it bounds the distances of all its points. Neighbours follow each other in both
 * trees: a triangle of `to` that is near one triangle of `from`, or one beside it in the list, is
 * mostly near the next one, too. Only where this bound is too large, the nearest triangle is looked
 * for. */

enum {
    /* The first lower bound is the largest distance of so many corners, or more. */
    SCOUTS = 1024,
    MOST_STRIDE = 64,
    /* So many triangles before and after a near one are looked at. */
    BESIDE = 8
};

static he_vec3 sum_of(const he_vec3 p[3])
{
    return he_vec3_add(p[0], he_vec3_add(p[1], p[2]));
}

static double square(he_vec3 a)
{
    return he_vec3_dot(a, a);
}

/* --- the first lower bound --- */

he_status he_compare_scout(he_comparing *c, he_error *err)
{
    const uint32_t count = c->from.tree->count, wanted = count / SCOUTS;
    const uint32_t stride = wanted < 1 ? 1 : wanted < MOST_STRIDE ? wanted : MOST_STRIDE;
    uint32_t hint = HE_NONE;
    he_status status = HE_OK;
    for (uint64_t i = 0; i < count && status == HE_OK; i += stride) {
        he_vec3 corner[3];
        double distance;
        if (!he_bits_get(c->equal, i)) {
            he_comparing_corners(c, (uint32_t)i, corner);
            status = he_comparing_ask(c, corner[0], (uint32_t)i, &hint, &distance, err);
        }
    }
    return status;
}

/* --- the bounds --- */

/* Returns the triangle whose middle is nearest to that of a triangle with these corners, among
 * `near` and those beside it in the list of triangles. */
static uint32_t find_beside(const he_comparing *c, const he_vec3 corner[3], uint32_t near)
{
    const he_bvh *tree = c->to.tree;
    const uint32_t from = near > BESIDE ? near - BESIDE : 0;
    const uint32_t to = tree->count - near > BESIDE + 1 ? near + BESIDE + 1 : tree->count;
    const he_vec3 middle = sum_of(corner);
    double best = HUGE_VAL;
    for (uint32_t i = from; i < to; i++) {
        he_vec3 p[3];
        he_bvh_corners(tree, c->to.mesh, i, p);
        const double far = square(he_vec3_sub(sum_of(p), middle));
        if (far < best) {
            best = far;
            near = i;
        }
    }
    return near;
}

/* Finds the largest distance of the corners of a triangle from triangle `near` of `to`. Returns
 * false if it is above the target. */
static bool is_bound(const he_comparing *c, const he_vec3 corner[3], uint32_t near, double *bound)
{
    const double most = c->target * c->target;
    he_vec3 p[3];
    double weight[3], largest = 0;
    he_bvh_corners(c->to.tree, c->to.mesh, near, p);
    for (int k = 0; k < 3 && largest <= most; k++) {
        largest = fmax(largest, square(he_bvh_to_triangle(corner[k], p, weight)));
    }
    *bound = sqrt(largest);
    return *bound <= c->target;
}

/* Finds an upper bound from the triangle of `to` that is nearest to the middle. */
static he_status bound_by_middle(he_comparing *c, uint32_t triangle, const he_vec3 corner[3],
                                 uint32_t *near, he_error *err)
{
    const he_vec3 middle = he_vec3_scale(sum_of(corner), 1 / 3.0);
    double distance, radius = 0;
    uint32_t farthest;
    he_status status = he_comparing_ask(c, middle, triangle, near, &distance, err);
    if (status == HE_OK) {
        for (int k = 0; k < 3; k++) {
            radius = fmax(radius, he_vec3_length(he_vec3_sub(corner[k], middle)));
        }
        c->upper[triangle] =
            fmin(distance + radius, he_comparing_farthest(c, corner, 3, *near, &farthest));
    }
    return status;
}

static he_status bound_part(he_comparing *c, uint32_t from, uint32_t to, he_error *err)
{
    uint32_t near = c->triangle == HE_NONE ? HE_NONE : c->found.triangle;
    he_status status = HE_OK;
    for (uint32_t i = from; status == HE_OK && i < to; i++) {
        he_vec3 corner[3];
        status = he_comparing_report(c, i, err);
        if (status != HE_OK || he_bits_get(c->equal, i)) {
            c->upper[i] = 0;
            continue;
        }
        he_comparing_corners(c, i, corner);
        if (near != HE_NONE && is_bound(c, corner, near, &c->upper[i])) {
            continue;
        }
        if (near != HE_NONE) {
            status = he_budget_take(&c->budget, HE_BVH_LOOK * BESIDE, err);
            near = find_beside(c, corner, near);
            if (status == HE_OK && is_bound(c, corner, near, &c->upper[i])) {
                continue;
            }
        }
        if (status == HE_OK) {
            status = bound_by_middle(c, i, corner, &near, err);
        }
    }
    return status;
}

he_status he_compare_bound(he_comparing *c, he_error *err)
{
    return he_compare_in_parts(c, bound_part, err);
}
