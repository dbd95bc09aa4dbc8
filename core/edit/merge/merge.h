/* merge.h - vertices made one, and the boundary edges that come to coincide.
 *
 * The caller says which vertices become part of which; the rest follows:
 *
 *     o---o   o---o              o---o---o        The vertices of each side become one, pair by
 *     |   a   c   |              |   |   |        pair: c goes into a, d into b. The edges a-b and
 *     | f |   | g |     --->     | f a g |        c-d, which then join the same two vertices, are
 *     |   b   d   |              |   b   |        one edge: the lowest stays.
 *     o---o   o---o              o---o---o
 *
 *  - An edge whose ends become one goes, and the faces beside it lose a corner. A face left with
 *    fewer than three goes.
 *  - Of faces that come to run through the same corners in the same order the lowest stays.
 *  - Edges without a face go; so do vertices left without an edge, but for those that took in
 *    others.
 *
 * Corner values follow their half-edges. What vertices say that become one goes to their corners
 * where it differs (keep.h); an edge that takes in others keeps its values. Noted as merged:
 * vertices, edges, and faces that were the same as another. */
#ifndef HE_EDIT_MERGE_MERGE_H
#define HE_EDIT_MERGE_MERGE_H

#include "mesh/mesh.h"

/* Where a vertex lies that took in others. */
typedef enum he_merge_place {
    HE_MERGE_MEAN, /* at the mean of all of them */
    HE_MERGE_INTO  /* where it was */
} he_merge_place;

typedef struct he_merge {
    /* gone[i] becomes part of into[i]. Live vertices; none is gone twice, and no `into` is gone:
     * the caller has checked that. */
    const uint32_t *gone, *into;
    size_t count;
    he_merge_place place;
} he_merge;

/* V - count, less what goes besides; nothing at all when count is 0. `moved`, which may be NULL, is
 * the number of values of vertices that corners keep (edit/piece/keep.h).
 *
 * Refused: HE_REPEATED_CORNER when a face would pass a vertex twice; HE_NONMANIFOLD_EDGE when more
 * than two faces would meet at an edge; HE_ORIENTATION when two would run along it in one
 * direction; HE_CLOSED_FAN when a vertex would have a closed fan and another;
 * HE_LOCKED_ELEMENT for what would go, a vertex that would move, an edge with an end that goes, or
 * a face with a corner that does (marks.h). HE_NO_MEMORY.
 *
 * Costs what is about the vertices, and about the neighbours of those, times the logarithm of
 * that. */
HE_NODISCARD he_status he_merge_vertices(he_mesh *m, const he_merge *how, uint64_t *moved,
                                         he_error *err);

#endif
