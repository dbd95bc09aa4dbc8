/* weld.h - merges listed vertices (vertex_weld), or all vertices that are close together (weld). */
#ifndef HE_EDIT_MERGE_WELD_H
#define HE_EDIT_MERGE_WELD_H

#include "edit/merge/merge.h"

/* vertex_weld: merges the given vertices into the one with the lowest id; V, E and F fall by the
 * numbers of deleted elements.
 *
 *     o---o       o---o               o---o---o          o---o           o---o
 *     |   a       b   |               |   a   |          |  / \ f        |   |
 *     |   |       |   |   a,b c,d     |   |   |          | a---b   a,b   | a |    f goes, and its
 *     |   c       d   |     --->      |   c   |          |  \ / g  --->  |   |    sides are one
 *     o---o       o---o               o---o---o          o---o           o---o    edge (g too)
 *
 * merge.h says which other elements are merged or deleted. The vertex with the lowest id moves to
 * the mean of the given vertices, or does not move if `place` is HE_MERGE_INTO. `into`, which may
 * be NULL, gets the vertex that stays. `moved`, which may be NULL, gets the number of values that
 * were moved from vertices to corners (keep.h).
 *
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_REPEATED_CORNER, HE_NONMANIFOLD_EDGE, HE_ORIENTATION, HE_CLOSED_FAN or
 * HE_LOCKED_ELEMENT as he_merge_vertices does.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_vertex_weld(he_mesh *m, const uint32_t *vertices, size_t count,
                                      he_merge_place place, he_vertex *into, uint64_t *moved,
                                      he_error *err);

/* weld: merges all vertices that are close together. Vertices are visited in rising order of ids.
 * Each vertex is merged into the first earlier vertex that stays and is no farther away than
 * `tolerance`. If there is no such vertex, the visited vertex stays, and later vertices may be
 * merged into it. So all vertices that become one lie in a ball around the vertex with the lowest
 * id. A chain of vertices with small gaps does not become one vertex. With a tolerance of 0, only
 * vertices at equal positions are merged.
 *
 * The ids of the vertices into which others were merged are appended to `into`, in rising order.
 * Takes time linear in the number of vertices, with the grid of point_grid.h. Fails as vertex_weld
 * does, and:
 * Returns HE_BAD_VALUE if the tolerance is negative. */
HE_NODISCARD he_status he_weld_near(he_mesh *m, double tolerance, he_merge_place place,
                                    he_ids *into, uint64_t *moved, he_error *err);

#endif
