/* ears.h - triangulates a loop by ear clipping (G. H. Meisters, "Polygons have ears", 1975).
 *
 * An EAR is a corner that turns left and whose triangle, with the corners before and after it,
 * contains no other corner of the loop. Cutting the ear off leaves a loop of one corner less:
 *
 *          i                  The corners that may be ears are kept in a circular list, in the
 *         / \                 order of the loop, and are tried one after another, so that
 *    ----a - -c----           triangles stay balanced.
 *
 * After corner i was cut off, only the corners a and c must be tried again.
 *
 * If the triangle of corner i contains corners of the loop, the one that is farthest from the line
 * a - c does not turn left. So it is enough to test corners that do not turn left: only these are
 * kept in a tree of boxes (corner_tree.h). If the tree has a corner q inside the triangle of a
 * corner p, p is PIERCED by q: p is listed under q, and is tried again only when q was cut off or
 * turns left.
 *
 * A simple polygon has an ear as long as it has more than three corners, and each corner is tried
 * at most three times. A search of the tree takes logarithmic time in most polygons, but not in
 * all. The cutting is STUCK after HE_EAR_STEPS times n log2 n steps for n corners, and also if
 * there is no ear, as in some loops that intersect themselves in the plane. With the flag
 * HE_ANY_CORNER cutting goes on even then: after too many steps triangles are no longer tested for
 * being empty, and if there is no ear, any corner is cut off, if possible one that turns left. */
#ifndef HE_GEOMETRY_EARS_H
#define HE_GEOMETRY_EARS_H

#include "geometry/triangulation.h"

enum {
    /* a flag of he_ears_cut: if there is no ear, cut off any corner instead of giving up */
    HE_ANY_CORNER = 4,
    HE_EAR_STEPS = 8
};

/* Fills triangulation->corners and triangulation->degenerate from triangulation->flat. If cutting
 * gets stuck, the function sets `*stuck` to true instead.
 * Returns HE_DOUBLED_EDGE, with HE_AVOID_EDGES in `flags`, if all remaining ears, or all remaining
 * corners, have diagonals that are edges of the mesh.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_ears_cut(const he_mesh *m, unsigned flags, he_triangulation_work *work,
                                   he_triangulation *triangulation, bool *stuck, he_error *err);

#endif
