/* sweep.h - triangulating a flat loop by a line that sweeps over it.
 *
 * Corners are met in the order of x, then of y. Where the line is, the inside of the loop is a
 * stack of INTERVALS, each between a lower side, along which the loop runs onward, and an upper
 * one, along which it runs back. Behind each interval lies what is not triangulated yet, ahead of a
 * CHAIN of corners from its lower to its upper side that can be joined to none of their own:
 *
 *       _____c3                  A corner on one of the sides is joined to all of the chain that
 *      |    /                    it sees from that end. Where the loop begins to run onward and
 * back |  c2      v              inside an interval, the corner splits the interval, and its chain
 *      |    \                    at the corner met last, which it sees; where two intervals meet
 *      |_____c1____c0            in a corner, it is the middle of both chains together.
 *
 * S. Hertel and K. Mehlhorn, "Fast triangulation of the plane with respect to simple polygons",
 * 1985. Intervals are found in a splay tree (D. D. Sleator and R. E. Tarjan, "Self-adjusting binary
 * search trees", 1985), so n corners take n log n steps, whatever the loop. All is decided by exact
 * signs (orient.h).
 *
 * A simple polygon is always triangulated. Triangles are long and thin, which is why ears.h is
 * tried first. */
#ifndef HE_GEOMETRY_SWEEP_H
#define HE_GEOMETRY_SWEEP_H

#include "geometry/flat.h"

/* Fills `corners`, three a triangle in the order that triangulation.h asks for, with triangles that
 * all turn left; `steps` is added to. Where that cannot be done `done` becomes false, which happens
 * only if the loop meets itself. Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_sweep_cut(const he_flat *flat, uint32_t *corners, bool *done,
                                    uint64_t *steps, he_error *err);

#endif
