/* boxes.h - a bounding volume hierarchy: a binary tree of boxes over things that have boxes, such
 * as triangles.
 *
 * The tree is built top-down by binned surface area heuristics along the widest axis (I. Wald, "On
 * fast construction of SAH-based bounding volume hierarchies", 2007), down to nodes of at most
 * HE_BOXES_LEAF things. From depth HE_BOXES_DEEP on nodes are halved instead, so that no input
 * makes the tree deeper than the stacks with which it is walked.
 *
 *     nodes    0: the root; children of a node are neighbours, first and first + 1
 *     order    the things, in the order of leaves
 *
 * Things may belong to GROUPS that get subtrees of their own, such as the triangles about a vertex
 * of very large degree: while a node contains things of more than one group, each thing of a group
 * counts as having the box of the whole group, so the group stays together. */
#ifndef HE_QUERY_BOXES_H
#define HE_QUERY_BOXES_H

#include "base/budget.h"
#include "mesh/mesh.h"

enum {
    HE_BOXES_LEAF = 4,
    /* Nodes at this depth or deeper are halved without a search for the best division. */
    HE_BOXES_DEEP = 48,
    /* Number of nodes on the stack of a walk down the tree; every path from the root is shorter. */
    HE_BOXES_STACK = 96
};

typedef struct he_bounds {
    double min[3], max[3];
} he_bounds;

/* A node of the tree, with its box in floats, which are rounded outward. */
typedef struct he_box_node {
    float min[3], max[3];
    /* In a leaf, index of its first thing in `order`; else index of the first child. */
    uint32_t first;
    uint32_t count; /* number of things in a leaf, 0 for an inner node */
} he_box_node;

typedef struct he_boxes {
    he_box_node *nodes;
    uint32_t *order;
    uint32_t node_count;
    he_bounds all;
} he_boxes;

/* he_bounds_none returns a box that contains nothing; he_bounds_include enlarges a box so that it
 * contains another one, too. */
he_bounds he_bounds_none(void);
void he_bounds_include(he_bounds *b, const he_bounds *other);

/* The things that a tree is made over, at least one. */
typedef struct he_boxed {
    const he_bounds *boxes; /* box of each thing */
    uint32_t count;
    const uint32_t *group; /* the group of each thing, 0 for none; NULL if there are no groups */
    uint32_t groups;       /* larger than every number in `group` */
} he_boxed;

/* Makes a tree in O(n log n) time. The caller clears `out`.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_LIMIT or HE_CANCELLED if the budget ends the work. */
HE_NODISCARD he_status he_boxes_make(const he_boxed *things, he_budget *budget, he_boxes *out,
                                     he_error *err);
void he_boxes_clear(he_boxes *tree);

/* The functions that visit pairs of things whose boxes intersect. */
typedef struct he_boxes_visit {
    /* Returns true if no thing below one node needs to be tried with any thing below the other
     * node. This callback may be NULL. Nodes whose boxes do not intersect are skipped in any
     * case. */
    bool (*is_needless)(void *context, uint32_t a, uint32_t b);
    /* Tests each thing of leaf a against each thing of leaf b; if a and b are one leaf, tests its
     * things against each other. An error ends the visit. */
    he_status (*try_leaves)(void *context, const he_box_node *a, const he_box_node *b,
                            he_error *err);
} he_boxes_visit;

/* Visits each pair of leaves whose boxes intersect once, and charges one step to the budget for
 * each pair of nodes.
 * Returns HE_LIMIT or HE_CANCELLED if the budget ends the work.
 * Returns the error of try_leaves if that fails. */
HE_NODISCARD he_status he_boxes_visit_pairs(const he_box_node *nodes, const he_boxes_visit *visit,
                                            void *context, he_budget *budget, he_error *err);

#endif
