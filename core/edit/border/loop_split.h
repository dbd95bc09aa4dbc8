/* loop_split.h - a mesh cut around a triangle of edges, and both sides capped. */
#ifndef HE_EDIT_BORDER_LOOP_SPLIT_H
#define HE_EDIT_BORDER_LOOP_SPLIT_H

#include "mesh/mesh.h"

/* What loop_split made, in the order of the cycle from the origin of half-edge 2a on. */
typedef struct he_loop_parts {
    he_vertex vertices[3];
    he_edge edges[3];
    he_face faces[2]; /* the cap of the old vertices, then that of the new ones */
} he_loop_parts;

/* loop_split: V + 3, E + 3, F + 2. The edges a, b and c make up a cycle u, v, w, which runs as
 * half-edge 2a does.
 *
 *        \  |  /                    \  |  /
 *         \ | /                      \ | /
 *      ----u=v=w----     --->      ---u v w---      left of 2a: old vertices and edges, a cap below
 *         / | \                       =====
 *        /  |  \                      =====
 *                                  ---x y z---      right of it: new ones, a cap above
 *                                    / | \
 *
 * It takes a neck apart, or a handle away, and is the inverse of loop_join: joining the caps by
 * the twin of a half-edge of the cycle and by the half-edge at the same place of the other cap
 * gives back all links, but for which half-edge a vertex stores.
 *
 * The new vertices lie where the old ones do, have their values and descend from them, as do the
 * new edges, whose half-edges 2e run as those of their parents. What lies to the right of the cycle
 * gets the new vertices as its ends and corners. Caps have no parents; the values of their corners
 * are those of the half-edges at their place.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_NOT_A_CYCLE, also when an edge is named
 * twice; HE_BOUNDARY_VERTEX; HE_SHARED_FACE unless the faces at the edges are six;
 * HE_LOCKED_ELEMENT for edges and faces that would get a new vertex (marks.h; a locked vertex or
 * edge of the cycle may be cut). HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL. Costs what is
 * about the three vertices. */
HE_NODISCARD he_status he_loop_split(he_mesh *m, he_edge a, he_edge b, he_edge c,
                                     he_loop_parts *out, he_error *err);

#endif
