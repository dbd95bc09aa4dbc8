/* seam.h - a mesh opened along edges, and closed again.
 *
 * edge_cut and edge_weld undo each other: welding an edge, as a, to the one its cut made gives back
 * every link, but for which half-edge an interior vertex stores. */
#ifndef HE_EDIT_BORDER_SEAM_H
#define HE_EDIT_BORDER_SEAM_H

#include "mesh/mesh.h"

/* What edge_cut made. */
typedef struct he_seam {
    he_ids vertices; /* by the half-edges at which their parts begin, rising */
    he_ids edges;    /* by the edges that were cut, rising */
} he_seam;

/* edge_cut: V + the parts that leave their vertex, E + count, F + 0. Interior edges become pairs of
 * boundary edges.
 *
 *        o-------v-------o             o-------v w-------o
 *        |       ^       |             |       ^ ^       |
 *        |  f   2e   g   |    --->     |   f   e e'  g   |
 *        |       |       |             |       | |       |
 *        o-------u-------o             o-------u x-------o
 *
 * The cut edges and the boundary part each fan about a vertex. A closed fan that meets one cut edge
 * opens; one that meets k falls into k parts, an open one into k + 1. Of the parts of a fan one
 * stays with the vertex: the one on the side of half-edge 2e of the lowest edge that is cut there.
 * Every other gets a new vertex at the same place, which descends from the old one and has its
 * values. Fans without a cut edge stay.
 *
 *        a   b                    a   b             where all four edges about an interior vertex
 *        |   |                    |   |             are cut, one part stays and three get a vertex
 *      --v---     v's fans:     --v w--
 *        |                      --x y--
 *
 * A cut edge keeps its id on the side of half-edge 2e, the other side is new and descends from it,
 * with the corner of the face there. Half-edge 2e of a new edge runs along its face.
 *
 * Refused, all or nothing: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT, HE_REPEATED_ELEMENT;
 * HE_BOUNDARY_EDGE; HE_DOUBLED_EDGE where both sides would join the same two vertices, since each
 * end has a closed fan and no other cut edge; HE_LOCKED_ELEMENT for an edge or face that would get
 * a new vertex (a locked edge may be cut, as may edges at a locked vertex). HE_NO_MEMORY,
 * HE_IDS_EXHAUSTED. `out` may be NULL, else he_seam_clear frees it. Costs the fans about the
 * ends. */
HE_NODISCARD he_status he_edge_cut(he_mesh *m, const uint32_t *edges, size_t count, he_seam *out,
                                   he_error *err);
void he_seam_clear(he_seam *seam);

/* Where the ends of welded edges come to lie. */
typedef enum he_keep { HE_KEEP_MEAN, HE_KEEP_A, HE_KEEP_B } he_keep;

/* edge_weld: V - 1 where a and b have an end in common, else V - 2; E - 1, F + 0. Two boundary
 * edges become one, so that their faces are on its two sides.
 *
 *        o-------q r-------o            o-------q-------o
 *        |       ^ |       |            |       |       |
 *        |       a b       |    --->    |       a       |
 *        |       | v       |            |       |       |
 *        o-------p s-------o            o-------p-------o
 *
 * r is merged into q and s into p, b into a: a's ids stay. They lie half-way between, or where they
 * did with HE_KEEP_A, or where those of b did with HE_KEEP_B. What the ends say goes to their
 * corners where it differs (keep.h), and is counted in `moved`, which may be NULL; edge a keeps its
 * values. An end in common stays as it is. At a bow-tie the chain of fans is rearranged where
 * others lie between a and b (ring.h).
 *
 * Refused: HE_NO_SUCH_ELEMENT, HE_DELETED_ELEMENT; HE_REPEATED_ELEMENT when a = b; HE_NOT_BOUNDARY;
 * HE_REPEATED_CORNER when a face has two corners that would become one; HE_DOUBLED_EDGE when other
 * edges would join the same two vertices; HE_CLOSED_FAN when the fan at the common end would close
 * beside another; HE_LOCKED_ELEMENT for what would go, move, or get another end or corner
 * (marks.h). HE_NO_MEMORY. Costs the faces about the ends of b. */
HE_NODISCARD he_status he_edge_weld(he_mesh *m, he_edge a, he_edge b, he_keep keep, uint64_t *moved,
                                    he_error *err);

#endif
