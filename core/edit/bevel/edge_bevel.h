/* edge_bevel.h - bevels an edge: replaces it by a face. */
#ifndef HE_EDIT_BEVEL_EDGE_BEVEL_H
#define HE_EDIT_BEVEL_EDGE_BEVEL_H

#include "mesh/mesh.h"

typedef struct he_bevel {
    he_face face;
    he_ids vertices, edges; /* the new vertices and edges, in the order along the new face */
} he_bevel;

/* edge_bevel replaces an edge, whose ends have d1 and d2 edges, by a face: V + d1 + d2 - 4,
 * E + d1 + d2 - 3, F + 1; each end on the boundary adds V + 1, E + 1. Every other edge that meets
 * the edge at an end gets a new vertex at the distance `width` from that end. A new face joins the
 * new vertices. The bevelled edge and those of its ends that are interior are deleted.
 *
 *        o           o             o           o
 *         \    f    /               \    f    /          the face f left of half-edge 2e, u -> v,
 *          \       /                 1-------6           has 1 and 6 in place of u and v; the faces
 *      o----u--->-v----o   --->  o--2|  new  |5--o       between two edges of an end have a side
 *          /       \                 3-------4           more
 *         /    g    \               /    g    \
 *        o           o             o           o
 *
 *      u on the boundary:            1---          An end on the boundary has two boundary edges
 *          \   f                      \            in its fan. It stays where it is, between the
 *           u--->-v        --->        u  new      cuts of these: u is a corner of the new face
 *          /   g                      /            and the stubs from it to the cuts are sides.
 *                                    2---
 *
 * If an end on the boundary has several fans, only the fan of the bevelled edge changes, and d1 and
 * d2 count only the edges of this fan.
 *
 * No new vertex is farther from the end than 0.99 of the length of its edge, so none reaches the
 * far end. An edge of length 0 is cut half-way (bevel.h).
 *
 * The new vertices are listed in the order of the new face. The first is the one that follows the
 * edge counter-clockwise about the origin of half-edge 2e; in the drawing the order is 1 to 6. Each
 * new vertex descends from the near end of the edge that was cut, and has values interpolated along
 * that edge. The new edges are listed in the order of the new face as well. An edge that was cut
 * keeps its id at its far end. The two long sides of the new face descend from the bevelled edge,
 * the stubs from the boundary edges that were cut, and the new face from the face left of half-edge
 * 2e. Half-edge 2e of a new edge runs along the new face, whose stored half-edge leaves the first
 * vertex.
 *
 * `out` may be NULL; otherwise he_bevel_clear frees it. Takes time linear in the size of the fans
 * at the two ends.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_BOUNDARY_EDGE if the edge is on the boundary.
 * Returns HE_BAD_VALUE unless width > 0.
 * Returns HE_LOW_DEGREE if an interior end has two edges.
 * Returns HE_LOCKED_ELEMENT if an element is locked that would be deleted, or get another end or
 * corner (marks.h).
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_bevel(he_mesh *m, he_edge e, double width, he_bevel *out,
                                     he_error *err);
void he_bevel_clear(he_bevel *bevel);

#endif
