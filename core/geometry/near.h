/* near.h - a grid of points: finds the point of lowest number within a tolerance of another.
 *
 *     for each point p, in the order of their numbers:
 *         he_near_find    finds the lowest kept point within the tolerance of p, or HE_NONE
 *         he_near_keep    keeps p under its own number, if no kept point was found
 *
 * Kept points are in a hash table of cells of 4 tolerances. Points within the tolerance of p are in
 * the cell of p or, if p is near a side of its cell, in the neighbour there: 8 cells at most (27
 * very far from 0), 3.4 on average. A cell holds few points, since kept points are farther apart
 * than the tolerance. So the total time is linear in the points, wherever they lie and whatever
 * their number. */
#ifndef HE_GEOMETRY_NEAR_H
#define HE_GEOMETRY_NEAR_H

#include "base/mem.h"
#include "mesh/mesh.h"

typedef struct he_near_slot {
    uint32_t hash, number; /* hash and number + 1 of a kept point; 0 in a free slot */
} he_near_slot;

/* A grid of kept points. {0} is empty. */
typedef struct he_near {
    he_near_slot *slots;
    size_t mask;
    uint64_t seed;
    double tolerance;
    const he_vec3 *points; /* positions of all points by their numbers; borrowed */
} he_near;

/* The points that are compared, and how near to each other two of them must be. */
typedef struct he_near_points {
    const he_vec3 *at; /* positions of the points; borrowed while the grid is used */
    double tolerance;
    /* A random number. It and the address of the table keep a file from choosing points that all
     * fall into one slot. */
    uint64_t seed;
} he_near_points;

/* Makes an empty grid with room for `most` kept points. `watch` may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the watch cancelled the work. */
HE_NODISCARD he_status he_near_make(he_near *out, const he_near_points *points, size_t most,
                                    he_watch *watch, he_error *err);
void he_near_clear(he_near *near);
/* Finds the kept point of lowest number within the tolerance of p; HE_NONE if there is none. Sets
 * *home, which the caller passes on to he_near_keep if it keeps p. */
uint32_t he_near_find(const he_near *near, he_vec3 p, uint32_t *home);
void he_near_keep(he_near *near, uint32_t home, uint32_t number);

#endif
