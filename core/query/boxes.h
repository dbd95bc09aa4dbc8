/* boxes.h - a binary tree of boxes over things that have boxes.
 *
 * The tree is made top-down by binned surface area heuristics (I. Wald, "On fast construction of
 * SAH-based bounding volume hierarchies", 2007), each node down to HE_BOXES_LEAF things; from
 * HE_BOXES_DEEP on it is halved instead, so that no input makes it deeper than what the walks have
 * room for.
 *
 *     nodes    0: the root; children of a node stand together, first and first + 1
 *     order    the things, in the order of leaves
 *
 * Things may come in GROUPS that are to have subtrees of their own, such as the triangles about a
 * vertex where thousands meet: while a run holds things of more than one group, those of a group
 * count as lying where the box of the whole group lies, and so stay together. */
#ifndef HE_QUERY_BOXES_H
#define HE_QUERY_BOXES_H

#include "base/budget.h"
#include "mesh/mesh.h"

enum {
    HE_BOXES_LEAF = 4,
    HE_BOXES_DEEP = 48, /* below this, halves */
    HE_BOXES_STACK = 96 /* more than any path is long */
};

typedef struct he_bounds {
    double min[3], max[3];
} he_bounds;

/* A box of floats, rounded outward. */
typedef struct he_box_node {
    float min[3], max[3];
    uint32_t first; /* place in the order, or node */
    uint32_t count; /* things of a leaf, 0 inside */
} he_box_node;

typedef struct he_boxes {
    he_box_node *nodes;
    uint32_t *order;
    uint32_t node_count;
    he_bounds all;
} he_boxes;

/* Holds nothing, and holds what `b` holds as well. */
he_bounds he_bounds_none(void);
void he_bounds_include(he_bounds *b, const he_bounds *other);

/* A tree over one thing or more, n log n in time. `group` has a number from 0 below `groups` for
 * each thing; those of group 0 belong to none. NULL where there are no groups. `out` is the
 * caller's to clear. HE_NO_MEMORY; HE_LIMIT and HE_CANCELLED by the budget. */
HE_NODISCARD he_status he_boxes_make(const he_bounds *boxes, uint32_t count, const uint32_t *group,
                                     uint32_t groups, he_budget *budget, he_boxes *out,
                                     he_error *err);
void he_boxes_clear(he_boxes *tree);

/* What is done with the pairs of things whose boxes meet. */
typedef struct he_boxes_visit {
    /* Need nothing below one node be tried with anything below the other? May be NULL: boxes that
     * do not meet are left out anyhow. */
    bool (*is_needless)(void *context, uint32_t a, uint32_t b);
    /* Try the things of two leaves, or of one with one another where both are the same node. What
     * it fails with ends the visit. */
    he_status (*try_leaves)(void *context, const he_box_node *a, const he_box_node *b,
                            he_error *err);
} he_boxes_visit;

/* Visit each pair of leaves whose boxes meet once, charged a step for each pair of nodes. HE_LIMIT
 * and HE_CANCELLED by the budget, and what try_leaves fails with. */
HE_NODISCARD he_status he_boxes_visit_pairs(const he_box_node *nodes, const he_boxes_visit *visit,
                                            void *context, he_budget *budget, he_error *err);

#endif
