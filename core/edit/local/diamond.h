/* diamond.h - reads the links of an edge between two triangles.
 *
 * Nearly all edges of most meshes are between two triangles. Edits that are made very often read
 * the links of such a diamond at once and then write with a pen (pen.h); all other edges take the
 * general code of these edits.
 *
 *                 c
 *                 o
 *               /   \
 *          ca  /  f  \  bc          h runs from a to b, t from b to a
 *             /   h   \
 *          a o---------o b
 *             \   t   /
 *          ad  \  g  /  db
 *               \   /
 *                 o
 *                 d                                                                   */
#ifndef HE_EDIT_LOCAL_DIAMOND_H
#define HE_EDIT_LOCAL_DIAMOND_H

#include "mesh/walk.h"

typedef struct he_diamond {
    uint32_t h, t;           /* the half-edges of the edge */
    uint32_t bc, ca, ad, db; /* the other half-edges of the triangles: bc runs from b to c */
    uint32_t a, b, c, d;     /* the vertices */
    uint32_t f, g;           /* the faces to the left of h and of t */
} he_diamond;

/* Reads the links about half-edge h, which may be any id. Returns false if its edge is not live, is
 * on the boundary, or is a side of a face that is no triangle. */
static inline __attribute__((always_inline)) bool
he_diamond_read_from(const he_mesh *m, he_halfedge from, he_diamond *out)
{
    const he_content *c = &m->c;
    if (from.i >= 2 * c->edges.issued) {
        return false;
    }
    const uint32_t h = from.i, t = h ^ 1u;
    const uint32_t bc = c->next[h], ad = c->next[t], ca = c->prev[h], db = c->prev[t];
    const uint32_t f = c->face[h], g = c->face[t];
    if (bc == HE_DEAD || f == HE_NONE || g == HE_NONE || c->next[bc] != ca || c->next[ad] != db) {
        return false;
    }
    *out = (he_diamond){.h = h,
                        .t = t,
                        .bc = bc,
                        .ca = ca,
                        .ad = ad,
                        .db = db,
                        .a = c->origin[h],
                        .b = c->origin[t],
                        .c = c->origin[ca],
                        .d = c->origin[db],
                        .f = f,
                        .g = g};
    return true;
}

/* Reads the links about edge e; half-edge h is 2e. */
static inline __attribute__((always_inline)) bool he_diamond_read(const he_mesh *m, he_edge e,
                                                                  he_diamond *out)
{
    return e.i < m->c.edges.issued && he_diamond_read_from(m, he_edge_halfedge(e, 0), out);
}

#endif
