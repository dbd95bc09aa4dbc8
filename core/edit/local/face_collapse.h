/* face_collapse.h - collapses a face to one vertex. */
#ifndef HE_EDIT_LOCAL_FACE_COLLAPSE_H
#define HE_EDIT_LOCAL_FACE_COLLAPSE_H

#include "mesh/mesh.h"

/* The most work that the collapse of one face may take, measured as the number of its corners times
 * the number of half-edges in the loops at its corners. */
enum { HE_FACE_COLLAPSE_STEPS = 1 << 24 };

/* face_collapse: a face of n corners is deleted, and its corners become one vertex at their mean: V
 * - (n - 1). If no neighbour of the face is a triangle, E - n, F - 1. A triangle that shares a side
 * with the face is deleted as well, together with one more edge.
 *
 *        o---o---o---o               o----o----o
 *        |   |   |   |               |\   |   /|
 *        o---d---c---o               | \  |  / |
 *        |   | f |   |      --->     o--- a ---o
 *        o---a-->b---o               | /  |  \ |
 *        |   |   |   |               |/   |   \|
 *        o---o---o---o               o----o----o
 *
 * The edit runs edge_collapse on the sides, in order. Corner a, which the stored half-edge of f
 * leaves, stays. The corner that follows a is merged into a, again and again, until the last side
 * is collapsed. Interpolated attributes of a become the mean of all corners.
 *
 * If the edit is refused, nothing changes. The output `vertex` is a and may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_LINK_CONDITION or HE_LOCKED_ELEMENT or HE_FEATURE_EDGE if edge_collapse refuses one of
 * the sides.
 * Returns HE_LIMIT if the face needs more work than HE_FACE_COLLAPSE_STEPS.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_face_collapse(he_mesh *m, he_face f, he_vertex *vertex, he_error *err);

#endif
