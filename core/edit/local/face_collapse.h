/* face_collapse.h - a face drawn together to one vertex. */
#ifndef HE_EDIT_LOCAL_FACE_COLLAPSE_H
#define HE_EDIT_LOCAL_FACE_COLLAPSE_H

#include "mesh/mesh.h"

/* The work of one face: its corners times the half-edges of the loops about them. */
enum { HE_FACE_COLLAPSE_STEPS = 1 << 24 };

/* face_collapse: a face of n corners goes, and its corners become one vertex at their mean:
 * V - (n - 1). Among polygons of more corners E - n, F - 1; a triangle beside one of the sides goes
 * too, with another edge.
 *
 *        o---o---o---o               o----o----o
 *        |   |   |   |               |\   |   /|
 *        o---d---c---o               | \  |  / |
 *        |   | f |   |      --->     o--- a ---o
 *        o---a-->b---o               | /  |  \ |
 *        |   |   |   |               |/   |   \|
 *        o---o---o---o               o----o----o
 *
 * It is edge_collapse of the sides, in order: a, the corner that the stored half-edge leaves, stays
 * and takes in the one after it, until only the two ends of the last side are left, then that one.
 * Interpolated attributes of a become the mean of the corners'.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; what edge_collapse refuses at
 * any of these steps: HE_LINK_CONDITION, HE_LOCKED_ELEMENT, HE_FEATURE_EDGE; HE_LIMIT where that is
 * too much work. HE_NO_MEMORY. `vertex` is a and may be NULL. */
HE_NODISCARD he_status he_face_collapse(he_mesh *m, he_face f, he_vertex *vertex, he_error *err);

#endif
