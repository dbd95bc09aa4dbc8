/* bvh_pairs.h - the state that the two searches for pairs of intersecting triangles share.
 *
 * A hub is a position at which very many triangles, its spokes, meet (hubs.h). The first search
 * goes down the tree of boxes and finds all pairs but those of two spokes of one hub; the second
 * finds these, by the directions in which spokes leave the hub.
 *
 *     bvh_pairs.c      pairs that are not at one hub
 *     bvh_sectors.c    pairs of spokes of one hub */
#ifndef HE_QUERY_BVH_PAIRS_H
#define HE_QUERY_BVH_PAIRS_H

#include "query/bvh.h"

typedef struct he_pair_search {
    const he_bvh *tree;
    const he_mesh *m;
    he_budget *budget;
    size_t most; /* the most face ids that `pairs` may hold */
    he_ids *pairs;
    uint32_t *hubs_of; /* HE_HUBS_OF numbers for each triangle (hubs.h); NULL without hubs */
} he_pair_search;

/* Returns the hub with the lowest number at which both triangles have a corner, or HE_NONE. */
uint32_t he_pair_hub(const he_pair_search *s, uint32_t i, uint32_t k);

/* Appends the faces of triangles i and k if the triangles intersect; `a` are the corners of i, `b`
 * those of k.
 * Returns HE_LIMIT if the list is full, or the budget ran out.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_pair_try(he_pair_search *s, uint32_t i, uint32_t k, const he_vec3 a[3],
                                   const he_vec3 b[3], he_error *err);

/* Tests the triangles at a hub (its spokes) against each other, except pairs of spokes that also
 * meet at another hub with a lower number. Returns the errors of he_pair_try. */
HE_NODISCARD he_status he_pairs_at_hub(he_pair_search *s, uint32_t hub, he_error *err);

#endif
