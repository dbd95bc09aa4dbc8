/* bvh_pairs.h - what the two searches for triangles that meet share.
 *
 *     bvh_pairs.c      all pairs but those at one hub, down the tree of boxes
 *     bvh_sectors.c    pairs of spokes of one hub, by the directions in which they leave it */
#ifndef HE_QUERY_BVH_PAIRS_H
#define HE_QUERY_BVH_PAIRS_H

#include "query/bvh.h"

typedef struct he_pair_search {
    const he_bvh *tree;
    const he_mesh *m;
    he_budget *budget;
    size_t most; /* ids that the list may hold */
    he_ids *pairs;
    uint32_t *hubs_of; /* HE_HUBS_OF numbers a triangle (hubs.h); NULL without hubs */
} he_pair_search;

/* The least hub that both triangles are spokes of, or HE_NONE. */
uint32_t he_pair_hub(const he_pair_search *s, uint32_t i, uint32_t k);

/* List the faces of triangles i and k, whose corners are a and b, if those meet. Returns HE_LIMIT
 * if the list is full, or by the budget. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_pair_try(he_pair_search *s, uint32_t i, uint32_t k, const he_vec3 a[3],
                                   const he_vec3 b[3], he_error *err);

/* Try the spokes of a hub with one another, but for pairs that have a lesser hub as well. Fails as
 * he_pair_try does. */
HE_NODISCARD he_status he_pairs_at_hub(he_pair_search *s, uint32_t hub, he_error *err);

#endif
