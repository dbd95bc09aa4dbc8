#include "query/bvh_walk.h"
#include "query/geometry.h"

static double square(he_vec3 a)
{
    return he_vec3_dot(a, a);
}

/* How far along from a to b, 0 to 1, the nearest point is. */
static double along(he_vec3 p, he_vec3 a, he_vec3 b)
{
    he_vec3 ab = he_vec3_sub(b, a);
    double t = he_vec3_dot(he_vec3_sub(p, a), ab) / square(ab);
    return t > 0 ? (t < 1 ? t : 1) : 0; /* NaN is that of equal ends */
}

/* The nearest point over the inside of the triangle; false when the foot of the point is not there,
 * or the triangle is too thin to tell. */
static bool over(he_vec3 p, const he_vec3 c[3], double weight[3])
{
    he_vec3 u = he_vec3_sub(c[1], c[0]), v = he_vec3_sub(c[2], c[0]), w = he_vec3_sub(p, c[0]);
    he_vec3 normal = he_vec3_cross(u, v);
    double area = square(normal);
    if (!(area > 1e-24 * square(u) * square(v))) {
        return false;
    }
    weight[1] = he_vec3_dot(he_vec3_cross(w, v), normal) / area;
    weight[2] = he_vec3_dot(he_vec3_cross(u, w), normal) / area;
    weight[0] = 1 - weight[1] - weight[2];
    return weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0;
}

static double try_point(he_vec3 p, const he_vec3 c[3], const double weight[3])
{
    he_vec3 q =
        he_vec3_add(he_vec3_add(he_vec3_scale(c[0], weight[0]), he_vec3_scale(c[1], weight[1])),
                    he_vec3_scale(c[2], weight[2]));
    return square(he_vec3_sub(p, q));
}

/* The squared distance to a triangle. */
static double nearest(he_vec3 p, const he_vec3 c[3], double weight[3])
{
    if (over(p, c, weight)) {
        return try_point(p, c, weight);
    }
    double best = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        double t = along(p, c[i], c[j]), own[3] = {0, 0, 0};
        own[i] = 1 - t;
        own[j] += t;
        double distance = try_point(p, c, own);
        if (distance < best) {
            best = distance;
            weight[0] = own[0];
            weight[1] = own[1];
            weight[2] = own[2];
        }
    }
    return best;
}

static double to_box(he_vec3 p, const he_bvh_node *node)
{
    const double at[3] = {p.x, p.y, p.z};
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        double d = fmax(fmax(node->min[k] - at[k], at[k] - node->max[k]), 0);
        sum += d * d;
    }
    return sum;
}

static void approach(he_vec3 p, const he_bvh *tree, const he_mesh *m, uint32_t triangle,
                     he_bvh_found *best)
{
    he_vec3 c[3];
    double weight[3] = {1, 0, 0};
    he_bvh_corners(tree, m, triangle, c);
    double distance = nearest(p, c, weight);
    bool nearer = distance < best->far;
    bool least = distance == best->far &&
                 (best->triangle == HE_NONE ||
                  tree->triangles[triangle].face < tree->triangles[best->triangle].face);
    if (nearer || least) {
        *best = (he_bvh_found){triangle, {weight[0], weight[1], weight[2]}, distance};
    }
}

static he_status walk(he_vec3 p, const he_bvh *tree, const he_mesh *m, uint64_t *budget,
                      he_bvh_found *best, he_error *err)
{
    /* What rounding may make a box seem farther than a triangle in it. */
    static const double SLACK = 1 + 16 * DBL_EPSILON;
    struct {
        uint32_t node;
        double near;
    } stack[HE_BVH_STACK];
    int depth = 0;
    stack[0].near = 0;
    stack[depth++].node = 0;
    while (depth > 0) {
        double near = stack[--depth].near;
        const he_bvh_node *node = &tree->nodes[stack[depth].node];
        if (near > best->far * SLACK) {
            continue;
        }
        if (!he_bvh_spend(budget)) {
            return he_bvh_exhausted(err);
        }
        for (uint32_t i = 0; i < node->count; i++) {
            approach(p, tree, m, node->first + i, best);
        }
        if (node->count == 0) {
            uint32_t a = node->first, b = node->first + 1;
            double to_a = to_box(p, &tree->nodes[a]), to_b = to_box(p, &tree->nodes[b]);
            bool swap = to_a <= to_b; /* the nearer one on top */
            stack[depth].node = swap ? b : a;
            stack[depth++].near = swap ? to_b : to_a;
            stack[depth].node = swap ? a : b;
            stack[depth++].near = swap ? to_a : to_b;
        }
    }
    return HE_OK;
}

he_status he_bvh_closest(const he_bvh *tree, const he_mesh *m, he_vec3 point, double max,
                         uint64_t *budget, he_hit *out, he_error *err)
{
    he_hit none = {.face = HE_NONE};
    if (tree->count == 0) {
        *out = none;
        return HE_OK;
    }
    he_vec3 p = {ldexp(point.x, -tree->exponent), ldexp(point.y, -tree->exponent),
                 ldexp(point.z, -tree->exponent)};
    if (!(he_vec3_extent(p) < HE_BVH_FAR)) {
        /* From here on only the direction tells which point is nearest. */
        he_vec3_normalise(point, &p);
        p = he_vec3_scale(p, HE_BVH_FAR);
    }
    he_bvh_found best = {.triangle = HE_NONE, .far = HUGE_VAL};
    he_status status = walk(p, tree, m, budget, &best, err);
    if (status != HE_OK) {
        return status;
    }
    he_hit hit = he_bvh_tell(tree, m, &best);
    he_direction(point, hit.point, &hit.distance);
    *out = hit.distance <= max ? hit : none;
    return HE_OK;
}
