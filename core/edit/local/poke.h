/* poke.h - fills a loop, the border of a face or a hole, with triangles around a new vertex. */
#ifndef HE_EDIT_LOCAL_POKE_H
#define HE_EDIT_LOCAL_POKE_H

#include "mesh/write.h"

/* face_poke divides a face of n corners into triangles around a new vertex w: V + 1, E + n,
 * F + (n - 1).
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
 * of a new edge runs from the old corner to w. New ids are in the order of the loop, from the
 * stored half-edge on. Vertex w is at `position`, or at the mean of the corners if `position` is
 * NULL. Interpolated attributes of w, and of the corners at w, are the mean of the values around
 * the loop of f.
 *
 * `vertex` is w; the ids of new edges and faces are appended to `edges` and `faces`. Each of the
 * three may be NULL.
 * Returns HE_NO_SUCH_ELEMENT or HE_DELETED_ELEMENT if an element is not live.
 * Returns HE_NOT_FINITE if the position is not finite.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_IDS_EXHAUSTED if no ids are left. */
HE_NODISCARD he_status he_face_poke(he_mesh *m, he_face f, const he_vec3 *position,
                                    he_vertex *vertex, he_ids *edges, he_ids *faces, he_error *err);

/* A plan to fill a loop, the border of a face or a hole, with triangles around a new vertex. If
 * `keep` is true, the first triangle keeps the id of the face of half-edge `first`; else, as in a
 * hole, all n triangles are new faces. */
typedef struct he_poke {
    he_halfedge first;
    bool keep;
    uint32_t corners;
    he_vec3 position;
    he_ids around,
        /* `around` lists the vertices of the loop, `loop` its half-edges. Both are empty if
         * vertices and half-edges have no attributes. */
        loop;
} he_poke;

/* Plans to fill the loop of `first`, and adds the memory that he_poke_commit needs to `need`. The
 * caller must reserve this memory. he_poke_clear frees the plan.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_poke_plan(const he_mesh *m, he_halfedge first, bool keep, he_poke *out,
                                    he_reservation *need, he_error *err);
void he_poke_clear(he_poke *poke);
/* Writes the planned triangles and cannot fail. The lists `edges` and `faces` must have memory for
 * all new ids, or be NULL. If the loop was a hole, the caller must then call he_ring_settle for its
 * vertices. */
he_vertex he_poke_commit(he_mesh *m, const he_poke *poke, he_ids *edges, he_ids *faces);

#endif
