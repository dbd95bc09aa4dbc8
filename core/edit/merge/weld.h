/* weld.h - vertices welded: some that are named, or all that lie close together. */
#ifndef HE_EDIT_MERGE_WELD_H
#define HE_EDIT_MERGE_WELD_H

#include "edit/merge/merge.h"

/* vertex_weld: the vertices named become one, that with the lowest id; V, E and F by what goes.
 *
 *     o---o       o---o               o---o---o          o---o           o---o
 *     |   a       b   |               |   a   |          |  / \ f        |   |
 *     |   |       |   |   a,b c,d     |   |   |          | a---b   a,b   | a |    f goes, and its
 *     |   c       d   |     --->      |   c   |          |  \ / g  --->  |   |    sides are one
 *     o---o       o---o               o---o---o          o---o           o---o    edge (g too)
 *
 * What else becomes one or goes: merge.h. It lies at the mean of all of them, or with
 * HE_MERGE_INTO stays where it is. `into`, which may be NULL, is the one that stays; `moved`, which
 * may be NULL, counts the values that went from vertices to corners (keep.h).
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT; HE_REPEATED_CORNER,
 * HE_NONMANIFOLD_EDGE, HE_ORIENTATION, HE_CLOSED_FAN, HE_LOCKED_ELEMENT as merge.h has them.
 * HE_NO_MEMORY. */
HE_NODISCARD he_status he_vertex_weld(he_mesh *m, const uint32_t *vertices, size_t count,
                                      he_merge_place place, he_vertex *into, uint64_t *moved,
                                      he_error *err);

/* weld: in rising order of their ids, each vertex joins the first that lies no farther away than
 * `tolerance` and has not itself joined another, or else stays for others to join. So what becomes
 * one lies within a ball about its lowest vertex, and vertices do not wander along chains. With a
 * tolerance of 0 those at equal positions become one.
 *
 * The ids of those that took in others are appended to `into`, in rising order. Refused as by
 * vertex_weld, and HE_BAD_VALUE for a negative tolerance. Linear in the vertices: near.h. */
HE_NODISCARD he_status he_weld_near(he_mesh *m, double tolerance, he_merge_place place,
                                    he_ids *into, uint64_t *moved, he_error *err);

#endif
