/* seam.h - opens a mesh along edges (edge_cut), and merges two boundary edges (edge_weld).
 *
 * The two edits are inverse: if edge_cut splits edge a into edges a and a', edge_weld of a and a'
 * restores every link, except which half-edge an interior vertex stores. */
#ifndef HE_EDIT_BORDER_SEAM_H
#define HE_EDIT_BORDER_SEAM_H

#include "mesh/mesh.h"

/* The results of edge_cut. */
typedef struct he_seam {
    /* The new vertices. Each belongs to a part of a fan; they are sorted by the ids of the first
     * half-edges of these parts. */
    he_ids vertices;
    he_ids edges; /* the new edges, in the order of the ids of the edges that were cut */
} he_seam;

/* edge_cut opens the mesh along interior edges, which become pairs of boundary edges: V + the
 * number of parts that get a new vertex (see below), E + count, F + 0.
 *
 *        o-------v-------o             o-------v w-------o
 *        |       ^       |             |       ^ ^       |
 *        |  f   2e   g   |    --->     |   f   e e'  g   |
 *        |       |       |             |       | |       |
 *        o-------u-------o             o-------u x-------o
 *
 * The cut edges divide each fan around a vertex into parts. A closed fan with one cut edge becomes
 * an open fan; a closed fan with k cut edges falls into k parts, an open fan into k + 1. One part
 * of a fan keeps the vertex: among the cut edges of the fan, e is the one with the lowest id, and
 * the part on the side of half-edge 2e keeps the vertex. Every other part gets a new vertex, which
 * descends from the old vertex and has its position and values. Fans without a cut edge keep the
 * vertex.
 *
 *        a   b                    a   b             where all four edges about an interior vertex
 *        |   |                    |   |             are cut, one part stays and three get a vertex
 *      --v---     v's fans:     --v w--
 *        |                      --x y--
 *
 * A cut edge e keeps its id on the side of half-edge 2e. The face on the side of half-edge 2e + 1
 * gets a new edge, which descends from e; the corner values that this face had along e move to the
 * new edge. The half-edge with the even id of the new edge belongs to this face.
 *
 * If the edit is refused, nothing changes. `out` may be NULL; otherwise he_seam_clear frees it.
 * Takes time linear in the size of the fans at the ends of the edges.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if an element is listed twice.
 * Returns HE_BOUNDARY_EDGE if the edge is on the boundary.
 * Returns HE_DOUBLED_EDGE if a cut edge and its copy would join one pair of vertices. This happens
 * if each end of the edge has a closed fan and no other cut edge, so that no end is divided.
 * Returns HE_LOCKED_ELEMENT if an edge or face that would get a new vertex is locked (a locked edge
 * may be cut, and so may edges at a locked vertex).
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_edge_cut(he_mesh *m, const uint32_t *edges, size_t count, he_seam *out,
                                   he_error *err);
void he_seam_clear(he_seam *seam);

/* Where edge_weld puts the merged ends of edges a and b: half-way between their two positions, at
 * the position of the end of a, or at that of the end of b. */
typedef enum he_keep { HE_KEEP_MEAN, HE_KEEP_A, HE_KEEP_B } he_keep;

/* edge_weld makes one edge of two boundary edges, so that their faces are on its two sides: V - 1
 * if a and b have an end in common, else V - 2; E - 1, F + 0.
 *
 *        o-------q r-------o            o-------q-------o
 *        |       ^ |       |            |       |       |
 *        |       a b       |    --->    |       a       |
 *        |       | v       |            |       |       |
 *        o-------p s-------o            o-------p-------o
 *
 * Vertex r is merged into q, s into p, and edge b into a, so the ids of a, q and p stay. With
 * HE_KEEP_MEAN, p and q move half-way to s and r; with HE_KEEP_A they do not move; with HE_KEEP_B
 * they move to s and r. Values in which the merged ends differ move to their corners (keep.h);
 * `moved`, which may be NULL, gets the number of these values. Edge a keeps its attribute values.
 * An end that a and b have in common stays as it is. At a bow-tie the order of the fans is changed
 * if other fans are between a and b (ring.h).
 *
 * Takes time linear in the size of the faces at the ends of b.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_REPEATED_ELEMENT if a = b.
 * Returns HE_NOT_BOUNDARY if an element is not on the boundary.
 * Returns HE_REPEATED_CORNER if a face has two corners that would become one.
 * Returns HE_DOUBLED_EDGE if two edges other than a and b would join one pair of vertices.
 * Returns HE_CLOSED_FAN if a and b have an end in common which would get a closed fan beside other
 * fans.
 * Returns HE_LOCKED_ELEMENT if an element is locked that would be deleted, move, or get another end
 * or corner (marks.h).
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_edge_weld(he_mesh *m, he_edge a, he_edge b, he_keep keep, uint64_t *moved,
                                    he_error *err);

#endif
