#include "query/bvh_walk.h"

/* A ray in the tree's coordinates, with the values that the tests of boxes and triangles use again
 * and again. */
typedef struct ray {
    double origin[3], direction[3], inverse[3];
    /* Numbers of the axes (0 to 2), permuted so that the ray runs mostly along the axis `z`. */
    int x, y, z;
    double shear_x, shear_y, shear_z;
} ray;

static void as_array(he_vec3 v, double out[3])
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Computes the values of a ray that all later tests use. The direction has length 1. */
static ray prepare(he_vec3 origin, he_vec3 direction)
{
    ray r = {.z = 0};
    as_array(origin, r.origin);
    as_array(direction, r.direction);
    for (int k = 1; k < 3; k++) {
        r.z = fabs(r.direction[k]) > fabs(r.direction[r.z]) ? k : r.z;
    }
    for (int k = 0; k < 3; k++) {
        r.inverse[k] = 1 / r.direction[k];
    }
    r.x = (r.z + 1) % 3;
    r.y = (r.z + 2) % 3;
    r.shear_z = 1 / r.direction[r.z];
    r.shear_x = r.direction[r.x] * r.shear_z;
    r.shear_y = r.direction[r.y] * r.shear_z;
    return r;
}

/* The relative rounding error of the distance at which a ray enters or leaves a box. */
static const double SLACK = 32 * DBL_EPSILON;

/* Returns the distance along the ray at which the ray enters the box, at least 0; HUGE_VAL if the
 * ray misses the box or enters it beyond `far`. If the ray lies in the plane of a side of the box,
 * the distance to that plane is NaN, which the comparisons treat as inside. */
static double enter(const ray *r, const he_box_node *node, double far)
{
    double near = 0, out = far;
    for (int k = 0; k < 3; k++) {
        double a = ((double)node->min[k] - r->origin[k]) * r->inverse[k];
        double b = ((double)node->max[k] - r->origin[k]) * r->inverse[k];
        double first = a < b ? a : b, last = a < b ? b : a;
        if (isnan(a) || isnan(b)) {
            continue;
        }
        near = first > near ? first : near;
        out = last < out ? last : out;
    }
    return near <= out + SLACK * fabs(out) ? near : HUGE_VAL;
}

static void meet(const ray *r, const he_bvh *tree, const he_mesh *m, uint32_t triangle,
                 he_bvh_found *best)
{
    he_vec3 corners[3];
    double x[3], y[3], z[3];
    he_bvh_corners(tree, m, triangle, corners);
    for (int k = 0; k < 3; k++) {
        double p[3];
        as_array(corners[k], p);
        z[k] = p[r->z] - r->origin[r->z];
        x[k] = p[r->x] - r->origin[r->x] - r->shear_x * z[k];
        y[k] = p[r->y] - r->origin[r->y] - r->shear_y * z[k];
    }
    /* The two triangles beside an edge compute exactly equal products for the edge. So they agree
     * on which side of the edge the ray passes, and no ray passes between the two triangles. */
    double side[3];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        side[k] = x[j] * y[i] - y[j] * x[i];
    }
    if ((side[0] < 0 || side[1] < 0 || side[2] < 0) &&
        (side[0] > 0 || side[1] > 0 || side[2] > 0)) {
        return;
    }
    double all = side[0] + side[1] + side[2];
    double distance = 0, weight[3];
    if (all == 0) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        weight[k] = side[k] / all;
        distance += weight[k] * (z[k] * r->shear_z);
    }
    bool nearer = distance < best->far;
    bool least = distance == best->far &&
                 (best->triangle == HE_NONE ||
                  tree->triangles[triangle].face < tree->triangles[best->triangle].face);
    if (distance >= 0 && (nearer || least)) {
        *best = (he_bvh_found){triangle, {weight[0], weight[1], weight[2]}, distance};
    }
}

static he_status walk(const ray *r, const he_bvh *tree, const he_mesh *m, he_budget *budget,
                      he_bvh_found *best, he_error *err)
{
    struct {
        uint32_t node;
        double near;
    } stack[HE_BOXES_STACK];
    int depth = 0;
    stack[0].near = enter(r, &tree->nodes[0], best->far);
    stack[depth++].node = 0;
    while (depth > 0) {
        double near = stack[--depth].near;
        const he_box_node *node = &tree->nodes[stack[depth].node];
        if (near == HUGE_VAL || near > best->far + SLACK * best->far) {
            continue;
        }
        he_status status = he_budget_take(budget, HE_BVH_LOOK * (1 + (uint64_t)node->count), err);
        if (status != HE_OK) {
            return status;
        }
        for (uint32_t i = 0; i < node->count; i++) {
            meet(r, tree, m, node->first + i, best);
        }
        if (node->count == 0) {
            uint32_t a = node->first, b = node->first + 1;
            double to_a = enter(r, &tree->nodes[a], best->far);
            double to_b = enter(r, &tree->nodes[b], best->far);
            bool swap = to_a <= to_b; /* the nearer child must be on top of the stack */
            stack[depth].node = swap ? b : a;
            stack[depth++].near = swap ? to_b : to_a;
            stack[depth].node = swap ? a : b;
            stack[depth++].near = swap ? to_a : to_b;
        }
    }
    return HE_OK;
}

/* Moves the origin of a ray that starts far away to the point where the ray enters the box of all
 * faces. Returns the distance from the old origin to the new one; HUGE_VAL if the ray misses the
 * box. The new origin lies exactly in the plane of the side of the box through which the ray
 * enters, although doubles are coarse at such distances. */
static double approach(ray *r, const he_box_node *root)
{
    double near = enter(r, root, HUGE_VAL), latest = -HUGE_VAL;
    int axis = 0;
    if (near == HUGE_VAL) {
        return near;
    }
    for (int k = 0; k < 3; k++) {
        double side = r->direction[k] > 0 ? root->min[k] : root->max[k];
        double first = (side - r->origin[k]) * r->inverse[k];
        if (r->direction[k] != 0 && first > latest) {
            latest = first;
            axis = k;
        }
    }
    for (int k = 0; k < 3; k++) {
        double x = r->origin[k] + near * r->direction[k];
        r->origin[k] = fmin(fmax(x, root->min[k]), root->max[k]);
    }
    r->origin[axis] = r->direction[axis] > 0 ? root->min[axis] : root->max[axis];
    return near;
}

he_status he_bvh_ray(const he_bvh *tree, const he_mesh *m, const he_ray *along, he_budget *budget,
                     he_hit *out, he_error *err)
{
    he_vec3 unit;
    if (!he_vec3_normalise(along->direction, &unit)) {
        return he_fail_plain(err, HE_BAD_VALUE, "the ray's direction must not be zero");
    }
    he_hit none = {.face = HE_NONE};
    if (tree->count == 0) {
        *out = none;
        return HE_OK;
    }
    he_vec3 origin = along->origin;
    he_vec3 from = {ldexp(origin.x, -tree->exponent), ldexp(origin.y, -tree->exponent),
                    ldexp(origin.z, -tree->exponent)};
    from = (he_vec3){he_clamped(from.x), he_clamped(from.y), he_clamped(from.z)};
    ray r = prepare(from, unit);
    double shift = he_vec3_extent(from) < HE_BVH_FAR ? 0 : approach(&r, &tree->nodes[0]);
    double reach = ldexp(along->max, -tree->exponent) - shift;
    he_bvh_found best = {.triangle = HE_NONE, .far = reach};
    if (shift == HUGE_VAL || reach < 0) {
        *out = none;
        return HE_OK;
    }
    he_status status = walk(&r, tree, m, budget, &best, err);
    if (status != HE_OK) {
        return status;
    }
    if (best.triangle == HE_NONE) {
        *out = none;
        return HE_OK;
    }
    *out = he_bvh_tell(tree, m, &best);
    out->distance = he_saturated(ldexp(best.far + shift, tree->exponent));
    return HE_OK;
}
