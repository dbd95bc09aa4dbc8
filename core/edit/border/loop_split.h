/* loop_split.h - cuts a mesh along a cycle of three edges, and caps the two holes. */
#ifndef HE_EDIT_BORDER_LOOP_SPLIT_H
#define HE_EDIT_BORDER_LOOP_SPLIT_H

#include "mesh/mesh.h"

/* The results of loop_split, in the order of the cycle of the three edges, from the origin of
 * half-edge 2a on. */
typedef struct he_loop_parts {
    he_vertex vertices[3];
    he_edge edges[3];
    /* The two caps (faces that close the cut): first the one at the old vertices, then the one at
     * the new vertices. */
    he_face faces[2];
} he_loop_parts;

/* loop_split cuts a mesh along a cycle of three edges and closes (caps) the hole on each side by a
 * triangle: V + 3, E + 3, F + 2. The edges a, b and c form the cycle u, v, w, which runs in the
 * direction of half-edge 2a.
 *
 *        \  |  /                    \  |  /
 *         \ | /                      \ | /
 *      ----u=v=w----     --->      ---u v w---      left of 2a: old vertices and edges, a cap below
 *         / | \                       =====
 *        /  |  \                      =====
 *                                  ---x y z---      right of it: new ones, a cap above
 *                                    / | \
 *
 * The edit cuts a neck, or removes a handle, and is the inverse of loop_join: if loop_join joins
 * the two caps, given the twin of a half-edge of the cycle and the corresponding half-edge of the
 * other cap, all links are restored, except which half-edge a vertex stores.
 *
 * Each new vertex descends from a vertex of the cycle, and has its position and values. Each new
 * edge descends from an edge of the cycle, and its half-edge 2e has the direction of the old
 * half-edge 2e. Elements to the right of the cycle get the new vertices as ends and corners. The
 * caps have no parents. A corner of a cap gets the value that the half-edge along that edge of the
 * cycle, in that direction, had before the cut.
 *
 * `out` may be NULL. Takes time linear in the degrees of the three vertices.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_NOT_A_CYCLE if the edges form no cycle, or if one is given twice.
 * Returns HE_BOUNDARY_VERTEX if a vertex is on the boundary.
 * Returns HE_SHARED_FACE if a face touches two of the edges.
 * Returns HE_LOCKED_ELEMENT if an edge or face that would get a new vertex is locked (marks.h); a
 * locked vertex or edge of the cycle is allowed.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_loop_split(he_mesh *m, he_edge a, he_edge b, he_edge c,
                                     he_loop_parts *out, he_error *err);

#endif
