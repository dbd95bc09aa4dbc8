/* split.h - the fans of a soup while its vertices are split, for split.c and exchange.c.
 *
 * Two corners are mates if the half-edges that leave them run along one edge in opposite
 * directions, and their faces stay joined along it. Around a vertex, corner c is followed by the
 * corner after its mate, and preceded by the mate of the corner before it:
 *
 *            v                     c leaves v; so do the corner after mate(c), in the face on
 *          / | \                   the other side of c's edge, and mate(before(c)).
 *      c  /  |  \  mate(before(c))
 *        /   |   \
 *       o----o----o */
#ifndef HE_REPAIR_SPLIT_H
#define HE_REPAIR_SPLIT_H

#include "build/soup_check.h"
#include "repair/mend.h"

typedef struct he_splitting {
    const he_soup *soup;
    /* the mate of each corner; HE_NONE if it has none */
    uint32_t *mate;
    uint32_t *face_of;
    /* the vertex of each corner after the split, in which each fan has a vertex of its own */
    uint32_t *to;
    uint32_t *parents; /* for each new vertex the vertex of which it is a copy */
    size_t copies, capacity;
    bool is_crowded;  /* some edge has more than two corners, or two that run in one direction */
    bool has_closed;  /* some vertex has a closed fan beside another fan */
    uint64_t *done;   /* one bit for each corner: set if its fan was found */
    uint64_t *taken;  /* one bit for each vertex: set if a fan got it already */
    uint64_t *closed; /* one bit for each vertex: set if its first fan is closed */
} he_splitting;

static inline uint32_t he_corner_after(const he_splitting *s, uint32_t c)
{
    uint32_t f = s->face_of[c];
    return c + 1 < he_soup_end(s->soup, f) ? c + 1 : s->soup->starts[f];
}

static inline uint32_t he_corner_before(const he_splitting *s, uint32_t c)
{
    uint32_t f = s->face_of[c];
    return (c > s->soup->starts[f] ? c : he_soup_end(s->soup, f)) - 1;
}

/* Exchanges the partners of pairs of mates until no two edges would join the same two vertices.
 * Before the call `to` must have the vertices that follow from the mates; if *exchanged is true
 * afterwards, the caller must find the fans and fill `to` again.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_splitting_exchange(he_splitting *s, bool *exchanged, he_error *err);

#endif
