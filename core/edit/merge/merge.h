/* merge.h - merges vertices, and the boundary edges that then coincide.
 *
 * The caller says which vertices are merged into which. This decides which edges and faces are
 * merged or deleted:
 *
 *     o---o   o---o              o---o---o        The vertices of each side become one, pair by
 *     |   a   c   |              |   |   |        pair: c is merged into a, d into b. The edges a-b
 *     | f |   | g |     --->     | f a g |        and c-d, which then join the same two vertices,
 *     |   b   d   |              |   b   |        become one edge: the lowest stays.
 *     o---o   o---o              o---o---o
 *
 *  - An edge whose ends become one is deleted, and the faces beside it lose a corner. A face left
 *    with fewer than three corners is deleted.
 *  - If several faces then pass equal corners in equal order, only the face with the lowest id
 *    stays.
 *  - Edges without a face are deleted; so are vertices left without an edge, except those into
 *    which others were merged.
 *
 * Corner values follow their half-edges. Values in which merged vertices differ move to their
 * corners (keep.h). An edge into which others are merged keeps its attribute values. The delta (the
 * log of the edit's writes) lists the vertices and edges that were merged, and the faces that were
 * deleted because they are equal to another face. */
#ifndef HE_EDIT_MERGE_MERGE_H
#define HE_EDIT_MERGE_MERGE_H

#include "mesh/mesh.h"

/* Where a vertex lies after other vertices were merged into it. */
typedef enum he_merge_place {
    HE_MERGE_MEAN, /* at the mean of all merged vertices */
    HE_MERGE_INTO  /* where it was before */
} he_merge_place;

typedef struct he_merge {
    /* Vertex gone[i] is merged into vertex into[i]. The caller has checked that all these vertices
     * are live, that none is in `gone` twice, and that none is in both lists. */
    const uint32_t *gone, *into;
    size_t count;
    he_merge_place place;
} he_merge;

/* Merges vertices: V falls by `count`, and by more if other vertices are deleted as well. Does
 * nothing if `count` is 0. `moved`, which may be NULL, gets the number of vertex values that are
 * kept at corners (edit/piece/keep.h).
 *
 * Returns HE_REPEATED_CORNER if a face would pass a vertex twice.
 * Returns HE_NONMANIFOLD_EDGE if more than two faces would meet at an edge.
 * Returns HE_ORIENTATION if two faces would run along an edge in one direction.
 * Returns HE_CLOSED_FAN if a vertex would have a closed fan beside other fans.
 * Returns HE_LOCKED_ELEMENT if an element that would be deleted, a vertex that would move, or an
 * edge or face that would get another vertex is locked (marks.h).
 * Returns HE_NO_MEMORY if memory is out.
 *
 * Takes time O(n log n) if there are n elements at the merged vertices and at their neighbours. */
HE_NODISCARD he_status he_merge_vertices(he_mesh *m, const he_merge *how, uint64_t *moved,
                                         he_error *err);

#endif
