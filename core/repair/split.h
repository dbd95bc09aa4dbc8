/* split.h - the fans of a soup while it is split, shared by split.c and exchange.c.
 *
 * Corners are mates where their faces stay joined along an edge. About a vertex, corner c is
 * followed by the one after its mate, and preceded by the mate of the one before it:
 *
 *            v                     c leaves v; so do the corner after mate(c), in the face on
 *          / | \                   the other side of c's edge, and mate(before(c)).
 *      c  /  |  \  mate(before(c))
 *        /   |   \
 *       o----o----o */
#ifndef HE_REPAIR_SPLIT_H
#define HE_REPAIR_SPLIT_H

#include "build/pair.h"
#include "repair/mend.h"

typedef struct he_splitting {
    const he_soup *soup;
    uint32_t *mate; /* of each corner, running along its edge the other way; HE_NONE */
    uint32_t *face_of;
    uint32_t *to;      /* each corner's vertex afterwards: its fan */
    uint32_t *parents; /* of the copies */
    size_t copies, capacity;
    bool is_crowded;  /* an edge has more than two corners, or two in one direction */
    bool has_closed;  /* a vertex has a closed fan and another */
    uint64_t *done;   /* corners whose fan is found */
    uint64_t *taken;  /* vertices that a fan has */
    uint64_t *closed; /* vertices whose first fan is closed */
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

/* Mates exchange partners until no two edges would join the same two vertices. The fans in `to` are
 * those of the mates before; after, if anything was `exchanged`, they are to be found again.
 * HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_splitting_exchange(he_splitting *s, bool *exchanged, he_error *err);

#endif
