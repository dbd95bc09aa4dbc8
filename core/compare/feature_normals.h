/* feature_normals.h - the normals of the triangles, edges and vertices of a surface that decide on
 * which side of it a point is (angle-weighted pseudonormals, see deviation.h). */
#ifndef HE_COMPARE_FEATURE_NORMALS_H
#define HE_COMPARE_FEATURE_NORMALS_H

#include "query/bvh_walk.h"

/* The sum of the normals of the triangles at an edge between two vertices, the lower id first. */
typedef struct he_hub_edge {
    uint32_t low, high;
    uint32_t triangle; /* one of them */
    he_vec3 normal;
} he_hub_edge;

typedef struct he_feature_normals {
    const he_mesh *mesh; /* borrowed, as is the tree */
    const he_bvh *tree;
    he_vec3 *vertex; /* the normals of vertices, of any length */
    /* The triangles at vertex v are at[first[v]] to at[first[v + 1] - 1]. */
    uint32_t *first, *at;
    /* The edges between vertices with so many triangles that searching there takes long, sorted by
     * their vertices. */
    he_hub_edge *hub_edges;
    size_t hub_edge_count;
} he_feature_normals;

/* Makes the normals of a surface, in linear time but for sorting edges between hubs;
 * he_feature_normals_clear frees them. `out` must be {0} before, and is cleared by the caller on
 * failure, too. */
HE_NODISCARD he_status he_feature_normals_make(const he_mesh *m, const he_bvh *tree,
                                               he_budget *budget, he_feature_normals *out,
                                               he_error *err);
void he_feature_normals_clear(he_feature_normals *normals);
/* Returns the normal of the feature on which a nearest point is: a corner of its triangle, a side,
 * or the triangle. */
he_vec3 he_feature_normal(const he_feature_normals *normals, const he_bvh_found *found);

#endif
