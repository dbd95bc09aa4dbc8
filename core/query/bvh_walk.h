/* bvh_walk.h - functions shared by the searches that walk over a tree of boxes: rays and nearest
 * points. */
#ifndef HE_QUERY_BVH_WALK_H
#define HE_QUERY_BVH_WALK_H

#include "geometry/scale.h"
#include "mesh/walk.h"
#include "query/bvh.h"

/* If a point is farther from the origin than this, in coordinates of the tree, products of
 * coordinates may overflow. */
#define HE_BVH_FAR 0x1p100

static inline void he_bvh_corners(const he_bvh *tree, const he_mesh *m, uint32_t triangle,
                                  he_vec3 out[3])
{
    const uint32_t *vertex = tree->triangles[triangle].vertex;
    for (int k = 0; k < 3; k++) {
        out[k] = he_vec3_scale(m->c.position[vertex[k]], tree->scale);
    }
}

/* The best result of a walk (search down the tree) so far: a triangle, and a point in it. */
typedef struct he_bvh_found {
    uint32_t triangle; /* HE_NONE if nothing was found yet */
    double weight[3];
    /* The length (or, in searches for the nearest point, the squared length) in the tree's
     * coordinates beyond which nothing needs to be visited. */
    double far;
} he_bvh_found;

/* Returns the vector from the nearest point of a triangle to p, and the barycentric coordinates of
 * that point. */
he_vec3 he_bvh_to_triangle(he_vec3 p, const he_vec3 corners[3], double weight[3]);

/* A point whose nearest triangle is searched, in coordinates of the tree and nearer to their origin
 * than HE_BVH_FAR; and a triangle that is probably near the point, or HE_NONE. */
typedef struct he_bvh_asked {
    he_vec3 point;
    uint32_t hint;
} he_bvh_asked;

/* Finds the nearest triangle of a tree that has triangles, faster than he_bvh_closest if the hint
 * is good. The result does not depend on the hint, unless two triangles of one face are equally
 * near. out->far gets the squared distance in coordinates of the tree.
 * Returns HE_LIMIT or HE_CANCELLED if the budget ends the work. */
HE_NODISCARD he_status he_bvh_near(const he_bvh *tree, const he_mesh *m, const he_bvh_asked *asked,
                                   he_budget *budget, he_bvh_found *out, he_error *err);

/* Converts the best result of a walk into a hit in coordinates of the mesh. Its distance is left to
 * the caller. */
static inline he_hit he_bvh_tell(const he_bvh *tree, const he_mesh *m, const he_bvh_found *found)
{
    const he_bvh_triangle *t = &tree->triangles[found->triangle];
    he_hit hit = {.face = t->face};
    he_vec3 p[3], sum = {0, 0, 0};
    he_bvh_corners(tree, m, found->triangle, p);
    for (int k = 0; k < 3; k++) {
        hit.vertex[k] = t->vertex[k];
        hit.weight[k] = found->weight[k];
        sum = he_vec3_add(sum, he_vec3_scale(p[k], found->weight[k]));
    }
    hit.point = (he_vec3){he_clamped(ldexp(sum.x, tree->exponent)),
                          he_clamped(ldexp(sum.y, tree->exponent)),
                          he_clamped(ldexp(sum.z, tree->exponent))};
    return hit;
}

#endif
