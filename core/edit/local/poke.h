/* poke.h - a loop filled with triangles about a new vertex. */
#ifndef HE_EDIT_LOCAL_POKE_H
#define HE_EDIT_LOCAL_POKE_H

#include "mesh/write.h"

/* face_poke: V + 1, E + n, F + (n - 1) for a face of n corners.
 *
 *        o-----------o               o-----------o
 *        |           |               | \   f2  / |
 *        |           |               |   \   /   |
 *        |     f     |      --->     | f3  w  f1 |
 *        |           |               |   /   \   |
 *        |           |               | /   f   \ |
 *        o---------->o               o---------->o
 *         halfedge(f)                 halfedge(f)
 *
 * The triangle of the stored half-edge keeps the id of f; the others descend from it. Half-edge 2e
 * of a new edge runs from the old corner to w. Ids follow the loop from the stored half-edge.
 * w lies at `position`, or at the mean of the corners when that is NULL; its interpolated
 * attributes, corners included, are the mean of those about it.
 *
 * New ids are appended to `edges` and `faces`; outputs may be NULL. Refused: HE_NO_SUCH_ELEMENT,
 * HE_DELETED_ELEMENT; HE_NOT_FINITE for the position. HE_NO_MEMORY, HE_IDS_EXHAUSTED. */
HE_NODISCARD he_status he_face_poke(he_mesh *m, he_face f, const he_vec3 *position,
                                    he_vertex *vertex, he_ids *edges, he_ids *faces, he_error *err);

/* The same for any loop, face or hole. Without `keep` all n triangles are new faces, as in a
 * hole; with it the first keeps the id of the face of `first`. */
typedef struct he_poke {
    he_halfedge first;
    bool keep;
    uint32_t corners;
    he_vec3 position;
    he_ids around, loop; /* the corners' vertices and half-edges: filled where there are columns */
} he_poke;

/* CHECK and RESERVE: `need` grows by what COMMIT writes. HE_NO_MEMORY. he_poke_clear frees. */
HE_NODISCARD he_status he_poke_plan(const he_mesh *m, he_halfedge first, bool keep, he_poke *out,
                                    he_need *need, he_error *err);
void he_poke_clear(he_poke *poke);
/* `edges` and `faces` have room, or are NULL. The vertices of a hole's loop are left for
 * he_ring_settle. */
he_vertex he_poke_commit(he_mesh *m, const he_poke *poke, he_ids *edges, he_ids *faces);

#endif
