/* merge.h - merges vertices, and the boundary edges that then coincide.
 *
 * The caller says which vertices are merged into which; the rest follows:
 *
 *     o---o   o---o              o---o---o        The vertices of each side become one, pair by
 *     |   a   c   |              |   |   |        pair: c is merged into a, d into b. The edges a-b
 *     | f |   | g |     --->     | f a g |        and c-d, which then join the same two vertices,
 *     |   b   d   |              |   b   |        become one edge: the lowest stays.
 *     o---o   o---o              o---o---o
 *
 *  - An edge whose ends become one is deleted, and the faces beside it lose a corner. A face left
 *    with fewer than three corners is deleted.
 *  - If several faces then run through the same corners in the same order, only the lowest stays.
 *  - Edges without a face are deleted; so are vertices left without an edge, except those into
 *    which others were merged.
 *
 * Corner values follow their half-edges. Values in which merged vertices differ move to their
 * corners (keep.h); an edge into which others are merged keeps its values. Recorded as merged:
 * vertices, edges, and faces equal to another. */
#ifndef HE_EDIT_MERGE_MERGE_H
#define HE_EDIT_MERGE_MERGE_H

#include "mesh/mesh.h"

/* Where a vertex is after others were merged into it. */
typedef enum he_merge_place {
    HE_MERGE_MEAN, /* at the mean of all of them */
    HE_MERGE_INTO  /* where it was */
} he_merge_place;

typedef struct he_merge {
    /* gone[i] is merged into into[i]. All are live vertices; none is gone twice, and no `into` is
     * gone: the caller has checked that. */
    const uint32_t *gone, *into;
    size_t count;
    he_merge_place place;
} he_merge;

/* V - count and more for other vertices that are deleted; does nothing if count is 0. `moved`,
 * which may be NULL, is the number of values of vertices that corners keep (edit/piece/keep.h).
 *
 * Returns HE_REPEATED_CORNER if a face would pass a vertex twice.
 * Returns HE_NONMANIFOLD_EDGE if more than two faces would meet at an edge.
 * Returns HE_ORIENTATION if two would run along an edge in one direction.
 * Returns HE_CLOSED_FAN if a vertex would have a closed fan and another.
 * Returns HE_LOCKED_ELEMENT if an element that would be deleted, a vertex that would move, or an
 * edge or face that would get another vertex is locked (marks.h).
 * Returns HE_NO_MEMORY if memory is out.
 *
 * Costs n log n for the n elements at the vertices and at their neighbours. */
HE_NODISCARD he_status he_merge_vertices(he_mesh *m, const he_merge *how, uint64_t *moved,
                                         he_error *err);

#endif
