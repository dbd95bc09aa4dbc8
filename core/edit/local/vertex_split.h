/* vertex_split.h - splits a vertex into an edge: the inverse of edge_collapse. */
#ifndef HE_EDIT_LOCAL_VERTEX_SPLIT_H
#define HE_EDIT_LOCAL_VERTEX_SPLIT_H

#include "mesh/mesh.h"

typedef struct he_vertex_parts {
    he_vertex vertex; /* u, the new vertex */
    /* The edge u-v, then the edges from u to `left` and to `right`, if these are not null. */
    he_edge edges[3];
    he_face faces[2]; /* the new triangles left and right of the edge from u to v */
    /* The number of new faces: 2, or 1 if `left` or `right` was null. `edges` has one entry
     * more. */
    unsigned sides;
} he_vertex_parts;

/* vertex_split splits a vertex v into an edge with a triangle on each side: V + 1, E + 3, F + 2; if
 * `left` or `right` is null, V + 1, E + 2, F + 1.
 *
 *            left                         left
 *              o                            o
 *              |                          / | \
 *         a    |   c                    /   |   \
 *              |         --->      a  u o-------->o v  c
 *              o v                      \   |   /
 *         b    |   d                    b \ | /   d
 *              |                            o
 *              o                          right
 *            right
 *
 * `left` and `right` are neighbours of v. The faces and edges around v that lie counter-clockwise
 * from left to right (a and b) move to the new vertex u, which lies at `to`. All other edges and
 * faces stay with v, which does not move. Two triangles fill the gap: u, v, left and v, u, right.
 * The inverse is edge_collapse of u -> v: it restores all links exactly, except which half-edge v
 * stores if v is interior.
 *
 * If v is on the boundary, `left` or `right` may be null ({HE_NONE}) and then stands for the hole
 * at v. Afterwards the hole is on that side of the new edge, and there is a triangle on the other
 * side only.
 *
 * The edges v-left and v-right keep their ids; the edges u-left and u-right are new and descend
 * from v-left and v-right; u descends from v. Half-edge 2e of a new edge leaves u.
 *
 * `out` may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BOWTIE if v has several fans.
 * Returns HE_NOT_NEIGHBOUR if left or right is no neighbour of v.
 * Returns HE_REPEATED_ELEMENT if left = right.
 * Returns HE_NOT_BOUNDARY if left or right is null and v is interior.
 * Returns HE_NO_SECTOR if no face lies counter-clockwise between left and right.
 * Returns HE_BAD_VALUE if `left` and `right` are null.
 * Returns HE_NOT_FINITE if `to` is not finite.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_vertex_split(he_mesh *m, he_vertex v, he_vertex left, he_vertex right,
                                       he_vec3 to, he_vertex_parts *out, he_error *err);

#endif
