/* sweep.h - triangulates a flat loop by a sweep line.
 *
 * Corners are visited in the order of x, then of y. The sweep line crosses the inside of the loop
 * in a stack of INTERVALS. An interval lies between a lower side of the loop, which runs in the
 * direction of the sweep, and an upper side, which runs in the opposite direction. Behind each
 * interval lies a region that is not triangulated yet. This region ends at a CHAIN of corners, from
 * the lower to the upper side, no two of which can be joined:
 *
 *       _____c3
 *      |    /
 *      |  c2      v         (the sweep goes from left to right and visits corner v next)
 *      |    \
 *      |_____c1____c0
 *
 * A visited corner that continues the lower or upper side of an interval is joined to all corners
 * of the chain that it sees from that end. A corner at which two sides begin inside an interval
 * splits the interval in two; the chain is split at the corner that was visited last, which the new
 * corner sees. At a corner in which two intervals meet, their chains become one chain with this
 * corner in its middle.
 *
 * S. Hertel and K. Mehlhorn, "Fast triangulation of the plane with respect to simple polygons",
 * 1985. Intervals are found in a splay tree (D. D. Sleator and R. E. Tarjan, "Self-adjusting binary
 * search trees", 1985), so n corners take n log n steps, whatever the loop. Every decision is an
 * exact sign (orient.h).
 *
 * A simple polygon is always triangulated. The triangles are long and thin, which is why ears.h is
 * tried first. */
#ifndef HE_GEOMETRY_SWEEP_H
#define HE_GEOMETRY_SWEEP_H

#include "geometry/planar_loop.h"

/* Fills `corners` with three corners for each triangle, in the order that triangulation.h requires.
 * All triangles turn left. Adds the number of steps taken to `*steps`. *done becomes false if no
 * triangulation was found, which happens only if the loop intersects itself.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_sweep_cut(const he_planar_loop *flat, uint32_t *corners, bool *done,
                                    uint64_t *steps, he_error *err);

#endif
