/* near.h - of the points that were kept, the lowest that is no farther than a tolerance from
 * another.
 *
 *     for each point p, in the order of their numbers:
 *         he_near_find    the lowest kept point within the tolerance of p, or HE_NONE:
 *         he_near_keep    then p is kept, under its own number
 *
 * Kept points lie in a hash table of cells of 4 tolerances. What is within the tolerance of a point
 * is in its own cell or, where the point is near a side, in the neighbour there: 8 cells at most
 * (27 very far from 0), 3.4 on the average; and a cell holds few, since they are farther apart than
 * the tolerance. So all of it takes time linear in the points, wherever they lie and whatever they
 * come to. */
#ifndef HE_GEOMETRY_NEAR_H
#define HE_GEOMETRY_NEAR_H

#include "base/mem.h"
#include "mesh/mesh.h"

typedef struct he_near_slot {
    uint32_t hash, number; /* of a kept point, and 1; 0 where the slot is free */
} he_near_slot;

/* {0} is empty. */
typedef struct he_near {
    he_near_slot *slots;
    size_t mask;
    uint64_t seed;
    double tolerance;
    const he_vec3 *points; /* borrowed; of the kept ones, by their numbers */
} he_near;

/* Room for `most` kept points. No file can be made whose points all have one place in the table:
 * that depends on its address and `seed`. `watch` may be NULL. HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_near_make(he_near *out, const he_vec3 *points, size_t most,
                                    double tolerance, uint64_t seed, he_watch *watch,
                                    he_error *err);
void he_near_clear(he_near *near);
/* *home is for he_near_keep. */
uint32_t he_near_find(const he_near *near, he_vec3 p, uint32_t *home);
void he_near_keep(he_near *near, uint32_t home, uint32_t number);

#endif
