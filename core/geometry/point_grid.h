/* point_grid.h - a grid of points, which finds the point of lowest number within a tolerance of a
 * given point.
 *
 *     for each point p, in the order of their numbers:
 *         he_point_grid_find    finds the kept point of lowest number within the tolerance of p
 *         he_point_grid_keep    keeps p under its own number, if no kept point was found
 *
 * Kept points are stored in a hash table by the cell in which they lie. Cells are cubes whose sides
 * are four times the tolerance. A point within the tolerance of p is in the cell of p or, if p is
 * near the border of its cell, in a neighbouring cell: 8 cells must be searched at most (27 very
 * far from 0), 3.4 on average. A cell holds few points, because kept points are farther apart than
 * the tolerance. So the total time is linear in the number of points, wherever the points lie. */
#ifndef HE_GEOMETRY_POINT_GRID_H
#define HE_GEOMETRY_POINT_GRID_H

#include "base/mem.h"
#include "mesh/mesh.h"

typedef struct he_point_grid_slot {
    /* `hash`: hash of the cell of a kept point; `number`: number of that point + 1; both are 0 in
     * an unused entry */
    uint32_t hash, number;
} he_point_grid_slot;

/* A grid of kept points. {0} is empty. */
typedef struct he_point_grid {
    he_point_grid_slot *slots;
    size_t mask;
    uint64_t seed;
    double tolerance;
    const he_vec3 *points; /* positions of all points by their numbers; borrowed */
} he_point_grid;

/* The points that are compared, and the tolerance: points at most this far apart count as near. */
typedef struct he_point_grid_points {
    const he_vec3 *at; /* positions of the points; borrowed while the grid is used */
    double tolerance;
    /* A random number, on which the hash of a point depends, so that the author of a file cannot
     * choose points with equal hashes. */
    uint64_t seed;
} he_point_grid_points;

/* Makes an empty grid with room for `most` kept points. `progress` may be NULL.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_point_grid_make(he_point_grid *out, const he_point_grid_points *points,
                                          size_t most, he_progress *progress, he_error *err);
void he_point_grid_clear(he_point_grid *grid);
/* Finds the kept point of lowest number within the tolerance of p; HE_NONE if there is none. Sets
 * *home to the hash of p's cell, which the caller must pass to he_point_grid_keep if it keeps p. */
uint32_t he_point_grid_find(const he_point_grid *grid, he_vec3 p, uint32_t *home);
void he_point_grid_keep(he_point_grid *grid, uint32_t home, uint32_t number);

#endif
