/* weld.h - points at equal positions made one vertex, for formats that repeat the position of a
 * corner in each of its faces.
 *
 * Equal means equal numbers: bit by bit, but for -0, which is 0. A hash table of the positions in a
 * soup; vertices are numbered as they first appear. Which slots they take depends on an address, so
 * that no file can be made in which all of them collide. */
#ifndef HE_FORMAT_IO_WELD_H
#define HE_FORMAT_IO_WELD_H

#include "build/build.h"

typedef struct he_weld_slot {
    uint32_t hash, vertex; /* number + 1; 0 where the slot is free */
} he_weld_slot;

/* {0} is empty. */
typedef struct he_weld {
    he_weld_slot *slots;
    unsigned bits; /* there are 2^bits slots */
    uint64_t seed;
} he_weld;

void he_weld_clear(he_weld *weld);
/* This position will be asked for soon: a hint to memory. */
void he_weld_expect(const he_weld *weld, he_vec3 position);
/* The vertex of the soup at `position`, added when there is none. All vertices of the soup are to
 * come through here. HE_NOT_FINITE, HE_LIMIT, HE_NO_MEMORY. */
HE_NODISCARD he_status he_weld_vertex(he_weld *weld, he_soup *soup, he_vec3 position,
                                      uint32_t *vertex, he_error *err);

#endif
