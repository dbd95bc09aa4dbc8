/* bvh_wide.h - a tree of boxes whose nodes have up to eight children, for searches for nearest
 * points.
 *
 * It has about every third level of the binary tree (boxes.h), and the same leaves. The boxes of
 * the children are stored coordinate by coordinate, so that a compiler computes the distances of
 * several at once (as in H. Dammertz, J. Hanika and A. Keller, "Shallow bounding volume
 * hierarchies for fast SIMD ray tracing of incoherent rays", 2008). */
#ifndef HE_QUERY_BVH_WIDE_H
#define HE_QUERY_BVH_WIDE_H

#include "query/boxes.h"

enum { HE_BVH_WIDTH = 8 };

/* A node with up to HE_BVH_WIDTH children. The box of a child that does not exist is empty: its
 * least coordinates are FLT_MAX, and its greatest ones -FLT_MAX. */
typedef struct he_bvh_wide {
    float min[3][HE_BVH_WIDTH], max[3][HE_BVH_WIDTH];
    uint32_t node[HE_BVH_WIDTH]; /* number in the binary tree; HE_NONE: the child does not exist */
    /* The number of the first thing in a leaf, and how many there are. Of other children `count` is
     * 0, and `first` is the number among the wide nodes. */
    uint32_t first[HE_BVH_WIDTH], count[HE_BVH_WIDTH];
} he_bvh_wide;

/* Makes the wide nodes of a binary tree, with the root first, in linear time. `count` gets their
 * number. Returns NULL if memory is out. */
he_bvh_wide *he_bvh_wide_new(const he_box_node *nodes, uint32_t *count);

#endif
