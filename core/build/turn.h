/* turn.h - how the corners of a soup lie about their vertices: the first half of he_build.
 *
 * A corner c of a face stands for the half-edge that leaves it. The turn of c is the corner at the
 * same vertex whose face lies counter-clockwise beside: it leaves along the edge by which the face
 * of c arrives.
 *
 *                 o
 *            turn(c) \   face of c        the edge from prev(c) to c runs back along turn(c), so
 *                     \                   the mate of a corner is the turn of the next one
 *          ------------ v -----> c
 *
 * With the corners filed by their vertices all this is found vertex by vertex, each in a few words
 * that lie together: which edges have two faces, that none has three or two in one direction, and
 * that the turns about a vertex meet all its corners. */
#ifndef HE_BUILD_TURN_H
#define HE_BUILD_TURN_H

#include "build/corner.h"

typedef struct he_turns {
    uint32_t *turn;  /* of each corner, HE_NONE at a boundary */
    uint32_t *first; /* of each vertex the first of its corners, HE_NONE where there is none */
    uint32_t *spare; /* as many words as corners, for whoever needs some next */
    size_t edges;
} he_turns;

/* The arrays are the caller's. HE_NO_MEMORY, HE_CANCELLED; where the structure cannot hold what was
 * found its defects are in `report` and *total, and `out` is as it was. Where faces are not proper
 * these alone are found: rest.h finds what else is wrong. */
HE_NODISCARD he_status he_soup_turn(const he_corners *corners, he_turns *out, he_report *report,
                                    uint64_t *total, he_error *err);
void he_turns_clear(he_turns *turns);

#endif
