/* ears.h - triangulates a loop by ear clipping (G. H. Meisters, "Polygons have ears", 1975).
 *
 * An EAR is a corner that turns left and whose triangle, with the corners before and after it,
 * contains no other corner of the loop. Cutting it off leaves a loop of one corner less:
 *
 *          i                          The corners that may be ears are kept in a ring, in their
 *         / \                         order, and tried round and round, so that triangles stay
 *    ----a - -c----                   balanced. After a cut only a and c are tried again.
 *
 * If the triangle contains corners, the one nearest to a - c does not turn left, so it is enough to
 * test corners that do not turn left: only these are kept in a tree of boxes (corner_tree.h). If
 * the tree has a corner q inside the triangle of a corner p, p is PIERCED by q: p is listed under
 * q, and is tried again only when q has been cut off or turns left.
 *
 * A simple polygon has an ear as long as it has corners left, and each corner is tried at most
 * three times. A search of the tree takes logarithmic time in most polygons, but not in all. After
 * HE_EAR_STEPS times n log2 n steps for n corners the cutting is STUCK, and also if there is no
 * ear, as in some loops that intersect themselves in the plane. With HE_ANY_CORNER cutting goes on
 * even then: after too many steps triangles are no longer tested for being empty, and if there is
 * no ear any corner is cut, one that turns left if there is one. */
#ifndef HE_GEOMETRY_EARS_H
#define HE_GEOMETRY_EARS_H

#include "geometry/triangulation.h"

enum {
    HE_ANY_CORNER = 4, /* a further flag of he_ears_cut: cut any corner rather than get stuck */
    HE_EAR_STEPS = 8
};

/* Fills triangulation->corners and triangulation->degenerate from triangulation->flat. If cutting
 * gets stuck, it only sets `*stuck` to true.
 * Returns HE_DOUBLED_EDGE with HE_AVOID_EDGES in `flags` if every ear that is left, or every
 * corner, has a diagonal that is an edge.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_ears_cut(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                                   he_triangulation *triangulation, bool *stuck, he_error *err);

#endif
