#include "query/bvh_disc.h"

#include "query/bvh_walk.h"

/* The disc around at most PATCH triangles is computed from the triangles. The disc of a larger node
 * is computed from the discs of its two children, which makes it a little larger than necessary at
 * each level of the tree. */
enum { PATCH = 256 };

static void to_floats(he_vec3 v, float out[3])
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

/* Returns a float that is not less than x. A margin is added, because the terms from which x was
 * computed may be rounded. */
static float upward(double x)
{
    return nextafterf((float)(x * (1 + 1e-6)), HUGE_VALF);
}

static void set(he_bvh_disc *disc, const he_box_node *node, he_vec3 normal, double thick,
                double radius)
{
    /* A disc never needs to be larger than the box of its node. */
    double half[3], diagonal = 0, support = 0;
    const double along[3] = {fabs(normal.x), fabs(normal.y), fabs(normal.z)};
    for (int k = 0; k < 3; k++) {
        double c = disc->center[k];
        half[k] = fmax(node->max[k] - c, c - node->min[k]);
        diagonal += half[k] * half[k];
        support += half[k] * along[k];
    }
    to_floats(normal, disc->normal);
    disc->thick = upward(fmin(thick, support));
    disc->radius = upward(fmin(radius, sqrt(diagonal)));
}

static void center(he_bvh_disc *disc, const he_box_node *node)
{
    for (int k = 0; k < 3; k++) {
        disc->center[k] = 0.5f * node->min[k] + 0.5f * node->max[k];
    }
}

static uint32_t begin_of(const he_bvh *tree, const he_box_node *node)
{
    while (node->count == 0) {
        node = &tree->nodes[node->first];
    }
    return node->first;
}

static uint32_t end_of(const he_bvh *tree, const he_box_node *node)
{
    while (node->count == 0) {
        node = &tree->nodes[node->first + 1];
    }
    return node->first + node->count;
}

/* Computes the disc with this normal around all triangles below a node. */
static void about(const he_bvh *tree, const he_mesh *m, const he_box_node *node, he_vec3 normal,
                  he_bvh_disc *disc)
{
    double thick = 0, radius = 0;
    center(disc, node);
    for (uint32_t i = begin_of(tree, node), end = end_of(tree, node); i < end; i++) {
        he_vec3 c[3];
        he_bvh_corners(tree, m, i, c);
        for (int k = 0; k < 3; k++) {
            double high, wide;
            he_bvh_reach(he_vec3_sub(c[k], he_bvh_of_floats(disc->center)), normal, &high, &wide);
            thick = high > thick ? high : thick;
            radius = wide > radius ? wide : radius;
        }
    }
    set(disc, node, normal, thick, radius);
}

static void about_leaf(const he_bvh *tree, const he_mesh *m, const he_box_node *node,
                       he_bvh_disc *disc)
{
    he_vec3 sum = {0, 0, 0}, normal;
    for (uint32_t i = 0; i < node->count; i++) {
        he_vec3 c[3];
        he_bvh_corners(tree, m, node->first + i, c);
        sum = he_vec3_add(sum, he_vec3_cross(he_vec3_sub(c[1], c[0]), he_vec3_sub(c[2], c[0])));
    }
    if (!he_vec3_normalise(sum, &normal)) {
        /* The triangles have no area, so any direction can be the normal. */
        normal = (he_vec3){0, 0, 1};
    }
    about(tree, m, node, normal, disc);
}

/* Returns the normal of a node's disc: the mean of the normals of the discs of its two children,
 * weighted by the areas of these discs. */
static he_vec3 mean_normal(const he_bvh_disc children[2])
{
    he_vec3 sum = {0, 0, 0}, normal;
    for (int i = 0; i < 2; i++) {
        double area = (double)children[i].radius * children[i].radius;
        sum = he_vec3_add(sum, he_vec3_scale(he_bvh_of_floats(children[i].normal), area));
    }
    if (!he_vec3_normalise(sum, &normal)) {
        he_vec3_normalise(he_bvh_of_floats(children[0].normal), &normal);
    }
    return normal;
}

/* Computes the disc of a node so that it contains the discs of its two children. */
static void about_children(const he_box_node *node, const he_bvh_disc children[2], he_vec3 normal,
                           he_bvh_disc *disc)
{
    double thick = 0, radius = 0;
    center(disc, node);
    for (int i = 0; i < 2; i++) {
        double high, wide;
        he_vec3 from =
            he_vec3_sub(he_bvh_of_floats(children[i].center), he_bvh_of_floats(disc->center));
        double same = fmin(fabs(he_vec3_dot(he_bvh_of_floats(children[i].normal), normal)), 1);
        /* HE_BVH_ROUNDING is added because a small angle between the two discs may have been lost
         * by rounding. */
        double askew = sqrt(1 - same * same) + 1e-3;
        he_bvh_reach(from, normal, &high, &wide);
        thick = fmax(thick, high + children[i].thick + children[i].radius * askew);
        radius = fmax(radius, wide + children[i].radius + children[i].thick * askew);
    }
    set(disc, node, normal, thick, radius);
}

he_status he_bvh_find_discs(he_bvh *tree, const he_mesh *m, he_budget *budget, he_error *err)
{
    he_status status = HE_OK;
    /* Children have higher numbers than their parent, so a loop from the highest number to the
     * lowest handles children before their parent. */
    for (uint32_t i = tree->node_count; i-- > 0 && status == HE_OK;) {
        const he_box_node *node = &tree->nodes[i];
        he_bvh_disc *disc = &tree->discs[i];
        if (node->count > 0) {
            about_leaf(tree, m, node, disc);
            continue;
        }
        const he_bvh_disc *children = &tree->discs[node->first];
        uint32_t count = end_of(tree, node) - begin_of(tree, node);
        status = he_budget_take(budget, count <= PATCH ? count : 1, err);
        if (count <= PATCH) {
            about(tree, m, node, mean_normal(children), disc);
        } else {
            about_children(node, children, mean_normal(children), disc);
        }
    }
    return status;
}
