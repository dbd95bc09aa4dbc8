/* corner_tree.h - a tree of boxes over the corners of a flat loop, which finds corners inside a
 * given triangle.
 *
 * The corners are sorted along the Z curve (G. M. Morton, 1966) and divided into leaves of about
 * HE_CORNER_LEAF corners. The tree is complete, so it is one array without links:
 *
 *                1                 node i has the children 2i and 2i + 1
 *            2       3             leaf l is node `leaves` + l and holds the corners
 *          4   5   6   7           count * l / leaves up to count * (l + 1) / leaves
 *
 * Corners can be removed but not added; the boxes shrink when corners are removed. Building the
 * tree takes linear time, removing a corner logarithmic time. A search visits the boxes that the
 * triangle touches: few in practice, all of them in the worst case. Each search counts the boxes
 * and corners that it visits, so that the caller can limit the work.
 *
 * Up to HE_CORNER_FEW corners are kept in a plain list instead, without sorting and without boxes,
 * because testing all of them takes less time than building and searching a tree (`make
 * bench-space` measures this). A search of the list finds the corner that comes first along the Z
 * curve, as a search of the tree would. Only in a list that began with at most HE_CORNER_UNSORTED
 * corners does a search find the first corner in the order of the list instead. */
#ifndef HE_GEOMETRY_CORNER_TREE_H
#define HE_GEOMETRY_CORNER_TREE_H

#include "geometry/planar_loop.h"

enum {
    HE_CORNER_LEAF = 6,
    /* up to this many corners of a loop are kept in a list instead of a tree */
    HE_CORNER_FEW = 128,
    /* in a list made of at most this many corners, a search finds the first suitable corner in the
     * order of the list and not along the Z curve */
    HE_CORNER_UNSORTED = 16
};

/* The box around the corners in a node's subtree. The box is empty if its minimum is larger than
 * its maximum. */
typedef struct he_corner_box {
    double min[2], max[2];
} he_corner_box;

/* A tree, or a list, of corners of a loop. {0} holds no corners. */
typedef struct he_corner_tree {
    const he_planar_loop *flat;
    void *memory;         /* one block of memory that contains the arrays below */
    he_corner_box *boxes; /* the box of each node of the tree; a list has none */
    /* In a list: the coordinates of the corners, in the order of the list. Further entries, up to
     * the next multiple of 8, are infinite. Unused in a tree. */
    double *x, *y;
    /* for each corner of the loop its index in `order`, or HE_NONE if it is not in the tree
     * or list */
    uint32_t *place;
    /* In a tree: the corners in the order of the Z curve, HE_NONE for each corner that was removed.
     * In a list: the corners in any order and without gaps. */
    uint32_t *order;
    uint32_t count;  /* number of entries of `order` */
    uint32_t made;   /* number of corners when the tree or list was made */
    uint32_t leaves; /* number of leaves; 0 for a list */
} he_corner_tree;

/* Makes a tree, or a list, of `count` corners of a loop. Borrows `flat`, copies `corners`.
 * he_corner_tree_clear frees the tree.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_corner_tree_make(he_corner_tree *out, const he_planar_loop *flat,
                                           const uint32_t *corners, uint32_t count, he_error *err);
void he_corner_tree_clear(he_corner_tree *tree);

static inline bool he_corner_tree_has(const he_corner_tree *tree, uint32_t corner)
{
    return tree->count > 0 && tree->place[corner] != HE_NONE;
}

/* Removes a corner, which must be in the tree. */
void he_corner_tree_remove(he_corner_tree *tree, uint32_t corner);

/* Returns a corner of the tree inside the closed triangle a, b, c, which must turn left; HE_NONE if
 * there is none. A corner is inside unless it is to the right of a side of the triangle by more
 * than rounding errors (planar_loop.h), so corners on a side are inside, too. Corners at the
 * position of a, b or c do not count. Adds the number of boxes and corners visited to `steps`; in a
 * list, HE_CORNER_LEAF corners count as one step, because testing them costs about as much as
 * testing a box. */
uint32_t he_corner_tree_find(const he_corner_tree *tree, uint32_t a, uint32_t b, uint32_t c,
                             uint64_t *steps);

#endif
