/* triangles.h - makes the triangles that fill a loop. */
#ifndef HE_EDIT_PIECE_TRIANGLES_H
#define HE_EDIT_PIECE_TRIANGLES_H

#include "geometry/triangulation.h"
#include "mesh/write.h"

typedef struct he_triangles {
    he_triangulation of;
    /* Used while the triangles are made (COMMIT): the half-edge that leaves each corner in the part
     * of the loop that is not filled yet. */
    uint32_t *side;
} he_triangles;

/* Plans the triangles that fill the loop of half-edge `first`. Diagonals avoid existing edges.
 * Passes `work`, which may be NULL if only one loop is filled, to he_triangulation_make, and fails
 * if that function fails. he_triangles_clear frees the plan. */
HE_NODISCARD he_status he_triangles_plan(const he_mesh *m, he_halfedge first,
                                         he_triangulation_work *work, he_triangles *out,
                                         he_error *err);
void he_triangles_clear(he_triangles *plan);

/* he_triangles_reservation adds the memory that he_triangles_commit needs to `need`;
 * he_triangles_commit makes the planned triangles and cannot fail. If `keep` is true, the loop is
 * the border of a face: the triangle of its stored half-edge keeps the face's id, the other
 * triangles descend from the face, and corners copy the values of its corners. If `keep` is false,
 * the loop is that of a hole and all triangles are new; the caller must then call he_ring_settle
 * for the vertices of the loop. Half-edge 2e of a new edge belongs to the triangle that the edge
 * cuts off from the rest of the loop. The lists `edges` and `faces` must have memory for all new
 * ids, or be NULL. */
void he_triangles_reservation(const he_triangles *plan, bool keep, he_reservation *need);
void he_triangles_commit(he_mesh *m, he_triangles *plan, bool keep, he_ids *edges, he_ids *faces);

#endif
