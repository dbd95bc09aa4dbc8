/* flip.h - flips the edge between two faces. */
#ifndef HE_EDIT_LOCAL_FLIP_H
#define HE_EDIT_LOCAL_FLIP_H

#include "mesh/mesh.h"

/* edge_flip turns an edge inside the two faces beside it: V + 0, E + 0, F + 0. It turns
 * counter-clockwise: each end moves to the next corner of its face. Ids of edge and faces stay;
 * half-edge 2e runs d -> c and keeps its face.
 *
 *          c       b                   c       b             2e: a -> b   --->   d -> c
 *          o<------o                   o<------o
 *          |  f   ^|                   |^   g  |             f: a b c ..  --->   d c .. a
 *          |     / |        --->       | \     |             g: b a d ..  --->   c d .. b
 *          |   /   |                   |   \   |
 *          | /  g  |                   | f   \ |             (in polygons c and d are the
 *          o------>o                   o------>o              corners after b and a)
 *          a       d                   a       d
 *
 * The new corner of f at d gets the values of the corner of g at d. The new corner of g at c gets
 * the values of the corner of f at c.
 *
 * At each of the four vertices a fan loses or gains an edge between two of its faces, so no fan
 * closes or opens.
 *
 * Takes time linear in the number of corners of f and g plus the smaller of the degrees of c and d.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BOUNDARY_EDGE if the edge is on the boundary.
 * Returns HE_SAME_ENDS if c = d.
 * Returns HE_LOW_DEGREE if an end of the edge is an interior vertex of degree 3 or less. (An end on
 * the boundary has at least 3 edges, because the edge is interior, and so keeps at least 2.)
 * Returns HE_DOUBLED_EDGE if an edge joins c and d.
 * Returns HE_REPEATED_CORNER if d is on f already, or c on g.
 * Returns HE_FEATURE_EDGE if the edge is a feature.
 * Returns HE_LOCKED_ELEMENT if the edge or one of the faces is locked (marks.h).
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_flip(he_mesh *m, he_edge e, he_error *err);

#endif
