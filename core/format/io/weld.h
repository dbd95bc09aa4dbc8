/* weld.h - merges points at equal positions into one vertex, for formats that repeat the position
 * of a corner in each of its faces.
 *
 * Positions are equal if all their bits are equal, except that -0 equals 0. A hash table contains
 * the positions of a soup; vertices are numbered in the order in which they first appear. The hash
 * depends on an address, so no file can be made in which all positions collide. */
#ifndef HE_FORMAT_IO_WELD_H
#define HE_FORMAT_IO_WELD_H

#include "build/build.h"

typedef struct he_weld_slot {
    uint32_t hash, vertex; /* `vertex` is the number + 1 of the vertex with this hash, 0 if none */
} he_weld_slot;

/* {0} is empty. */
typedef struct he_weld {
    he_weld_slot *slots;
    unsigned bits; /* there are 2^bits slots */
    uint64_t seed;
} he_weld;

void he_weld_clear(he_weld *weld);
/* Prefetches the entry of the hash table for a position that will be looked up soon. */
void he_weld_expect(const he_weld *weld, he_vec3 position);
/* Finds the vertex of the soup that lies at `position`, or adds one. All vertices of the soup must
 * have been added by this function.
 * Returns HE_NOT_FINITE if a coordinate is not finite.
 * Returns HE_LIMIT if a limit of the soup would be exceeded.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_weld_vertex(he_weld *weld, he_soup *soup, he_vec3 position,
                                      uint32_t *vertex, he_error *err);

#endif
