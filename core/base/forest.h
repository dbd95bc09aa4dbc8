/* forest.h - union-find: sets that are joined two by two.
 *
 * The sets are trees in one array: parent[i] is the parent of element i, and the root of a tree,
 * its own parent, is the element with the lowest id. Paths are halved on the way (van Leeuwen and
 * van der Weide 1977). No ranks are needed to keep them short, because elements of one set usually
 * have close ids. */
#ifndef HE_BASE_FOREST_H
#define HE_BASE_FOREST_H

#include <stdbool.h>
#include <stdint.h>

/* Returns the root of the tree of element i. */
static inline uint32_t he_forest_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* Joins the trees of elements a and b. Returns true if these were two different trees. */
static inline bool he_forest_unite(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = he_forest_root(parent, a);
    b = he_forest_root(parent, b);
    if (a < b) {
        parent[b] = a;
    } else {
        parent[a] = b;
    }
    return a != b;
}

#endif
