/* sweep.h - triangulates a flat loop by a sweep line.
 *
 * Corners are visited in the order of x, then of y. The inside of the loop crosses the sweep line
 * in a stack of INTERVALS, each between a lower side of the loop, which runs onward (in the
 * direction of the sweep), and an upper side, which runs back. Behind each interval lies a region
 * that is not triangulated yet. It ends at a CHAIN of corners, from the lower to the upper side, no
 * two of which can be joined:
 *
 *       _____c3                  A corner on one of the sides is joined to all of the chain that
 *      |    /                    it sees from that end. Where the loop begins to run onward and
 * back |  c2      v              inside an interval, the corner splits the interval, and its chain
 *      |    \                    at the corner visited last, which it sees; where two intervals
 *      |_____c1____c0            meet in a corner, it is the middle of both chains together.
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

/* Fills `corners` with triangles that all turn left, three corners for each, in the order that
 * triangulation.h requires; adds to `steps`. *done becomes false if no triangulation was found,
 * which happens only if the loop intersects itself.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_sweep_cut(const he_planar_loop *flat, uint32_t *corners, bool *done,
                                    uint64_t *steps, he_error *err);

#endif
