/* turn.h - finds the neighbour of each corner of a soup around its vertex: the first half of
 * he_build.
 *
 * A corner c of a face stands for the half-edge that leaves it. The turn of c is the corner at the
 * same vertex in the next face counter-clockwise: it leaves along the edge by which the face of c
 * arrives.
 *
 *                 o
 *            turn(c) \   face of c        the edge from prev(c) to c runs back along turn(c), so
 *                     \                   the mate of a corner is the turn of the next one
 *          ------------ v -----> c
 *
 * With the corners sorted by vertex all this is found vertex by vertex, in a few words that lie
 * together: which edges have two faces, that none has three or has two in one direction, and that
 * the turns around a vertex reach all its corners. */
#ifndef HE_BUILD_TURN_H
#define HE_BUILD_TURN_H

#include "build/corner.h"

typedef struct he_turns {
    uint32_t *turn;  /* turn of each corner, HE_NONE at a boundary */
    uint32_t *first; /* first corner of each vertex, HE_NONE if it has none */
    uint32_t *
        spare; /* as many words as there are corners, which the caller may use for something else */
    size_t edges;
} he_turns;

/* Finds the turns. On success the caller owns the arrays. If the soup has defects, `report` and
 * *total get them and `out` is as it was. If some faces are not valid, only those are reported:
 * rest.h checks the others.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the watch cancelled the work. */
HE_NODISCARD he_status he_soup_turn(const he_corners *corners, he_turns *out, he_report *report,
                                    uint64_t *total, he_error *err);
void he_turns_clear(he_turns *turns);

#endif
