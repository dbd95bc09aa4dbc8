/* swing.h - finds the neighbour of each corner of a soup around its vertex: the first half of
 * he_build.
 *
 * A corner c of a face stands for the half-edge that leaves it. The swing of c (an operator of J.
 * Rossignac's corner table) is the corner at the same vertex in the next face counter-clockwise: it
 * leaves along the edge by which the face of c arrives.
 *
 *                 o
 *            swing(c)\   face of c        the edge from prev(c) to c runs back along swing(c), so
 *                     \                   the mate of a corner (the one whose half-edge is the
 *          ------------ v -----> c        twin) is the swing of the next corner of its face
 *
 * The corners are sorted by vertex; then one vertex after another is checked, each in a few words
 * that lie together in memory. The check finds which edges at the vertex have two faces, and
 * whether an edge has three faces or two in the same direction, or swings around the vertex do not
 * reach all its corners. */
#ifndef HE_BUILD_SWING_H
#define HE_BUILD_SWING_H

#include "build/corner.h"

typedef struct he_swings {
    uint32_t *swing; /* for each corner the next corner around its vertex; HE_NONE at a boundary */
    /* for each vertex the corner at which swings begin, HE_NONE if the vertex has no corner */
    uint32_t *first;
    uint32_t *spare; /* a word for each corner, memory that the caller may use for anything */
    size_t edges;
} he_swings;

/* Finds the next corner around the vertex of each corner. The caller owns the arrays on success. If
 * the soup has defects, they are added to `report` and counted in *total, and `out` is as it was.
 * If some faces are not valid, only these faces are reported: rest.h checks the others.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_soup_swing(const he_corners *corners, he_swings *out, he_report *report,
                                     uint64_t *total, he_error *err);
void he_swings_clear(he_swings *swings);

#endif
