/* vertex_split.h - a vertex drawn apart into an edge: edge_collapse backwards. */
#ifndef HE_EDIT_LOCAL_VERTEX_SPLIT_H
#define HE_EDIT_LOCAL_VERTEX_SPLIT_H

#include "mesh/mesh.h"

typedef struct he_vertex_parts {
    he_vertex vertex; /* u */
    he_edge edges[3]; /* u-v, then u-left and u-right as far as there are */
    he_face faces[2]; /* left and right of u -> v */
    unsigned sides;   /* faces: 2, or 1 with a null; edges are one more */
} he_vertex_parts;

/* vertex_split: V + 1, E + 3, F + 2; with one null V + 1, E + 2, F + 1.
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
 * `left` and `right` are neighbours of v. The sectors about v from left to right, counter-
 * clockwise (a and b), go to the new vertex u, which lies at `to`; the others stay with v, and v
 * stays where it is. Two triangles fill the gap: u, v, left and v, u, right. edge_collapse of
 * u -> v is the exact inverse: all links are as they were, but for which half-edge an interior v
 * stores.
 *
 * On the boundary one of the two may be null, {HE_NONE}: it stands for the hole at v, which then
 * comes to lie on that side of the new edge, and there is a triangle on the other side only.
 *
 * The edges v-left and v-right keep their ids; the edges of u to the same vertices are new and
 * descend from them, as u does from v. Half-edge 2e of a new edge leaves u.
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_BOWTIE when v has several fans;
 * HE_NOT_NEIGHBOUR; HE_REPEATED_ELEMENT when left = right; HE_NOT_BOUNDARY for a null at an
 * interior vertex; HE_NO_SECTOR when no face lies from left to right; HE_BAD_VALUE when both are
 * null; HE_NOT_FINITE for `to`. HE_NO_MEMORY, HE_IDS_EXHAUSTED. `out` may be NULL. */
HE_NODISCARD he_status he_vertex_split(he_mesh *m, he_vertex v, he_vertex left, he_vertex right,
                                       he_vec3 to, he_vertex_parts *out, he_error *err);

#endif
