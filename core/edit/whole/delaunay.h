/* delaunay.h - flips edges until the triangles are as round as possible. */
#ifndef HE_EDIT_WHOLE_DELAUNAY_H
#define HE_EDIT_WHOLE_DELAUNAY_H

#include "mesh/mesh.h"

/* An edge is flipped only if the two angles opposite to it sum to more than pi plus this number of
 * radians. Otherwise rounding would flip the edges between four points on a circle back and
 * forth. */
#define HE_DELAUNAY_EPSILON 1e-9

/* The edit is refused if it takes more than this number of steps for each live edge. Testing an
 * edge is one step. Visiting a half-edge around a vertex, in search of an edge, is also one
 * step. */
enum { HE_DELAUNAY_STEPS = 512 };

/* delaunay flips edges until the triangles are as round as possible; no element is made or deleted.
 * Edges between two triangles are flipped (see edge_flip) while the angles opposite to them sum to
 * more than pi:
 *
 *            c                          c
 *            o                          o
 *          /   \                      / | \
 *        / alpha \                  /   |   \        alpha + beta > pi: in a flat kite the
 *      /           \              /     |     \      circle through a, b and c goes round d, and
 *    a o-----------o b   --->   a o     |     o b    c-d makes the smallest angle larger
 *      \  beta     /              \     |     /
 *        \       /                  \   |   /
 *          \   /                      \ | /
 *            o                          o
 *            d                          d
 *
 * After a flip the four sides of the kite may violate the criterion, so they are tested again, from
 * a queue in which no edge is twice (C. L. Lawson, "Software for C1 surface interpolation", 1977).
 * If edges are listed, only these are in the queue at first, and flips spread from there; NULL
 * means all edges.
 *
 * These edges are never flipped: edges on the boundary or beside a face of more than three corners,
 * feature edges, locked edges and edges beside a locked face (marks.h). If he_edge_flip refuses an
 * edge, the edge is tried again after other flips. At the end, all tested edges except these
 * satisfy the criterion. If no edges were listed, a second call changes nothing.
 *
 * The algorithm ends. Angles are those of the triangles in space. A flip of an edge at which the
 * two triangles are not coplanar changes the surface, but never increases its area. To see this,
 * unfold the two triangles into a plane: the kite is then convex. The flip does not change its
 * area. Folding it back shortens c-d, which shrinks the two new triangles, because their angles
 * opposite to c-d sum to less than pi. So if a set of triangles ever occurred again, all flips in
 * between would have left the area as it was, so they would have been flips inside flat parts of
 * the surface. There, no triangulation ever repeats (A. I. Bobenko and B. A. Springborn, "A
 * discrete Laplace-Beltrami operator for simplicial surfaces", 2007). The number of flips may be
 * quadratic, so the work is limited.
 *
 * Edges and faces keep their ids; attributes follow the rules of edge_flip. `flips`, which may be
 * NULL, gets the flipped edges in the order of the flips; an edge is listed once for each of its
 * flips.
 *
 * If the edit is refused, nothing changes.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT or HE_REPEATED_ELEMENT if an element of the list
 * is not live or is listed twice.
 * Returns HE_LIMIT if it takes more than HE_DELAUNAY_STEPS steps for each edge.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_delaunay(he_mesh *m, const uint32_t *edges, size_t count, he_ids *flips,
                                   he_error *err);

#endif
