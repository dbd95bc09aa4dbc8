/* progressive.h - a mesh as a coarse one and the splits that lead back to it.
 *
 * H. Hoppe, "Progressive meshes", 1996: a decimation is remembered collapse by collapse, and each
 * collapse is undone by a vertex split. Undone in reverse order, they lead through all levels of
 * detail to the mesh that was, with the same ids, ends of edges, corners of faces and positions.
 *
 *              c                               c
 *              o                               o
 *            /   \                           / | \
 *       m1 /       \                    m1 / f | g \       `moved` faces have `vertex` where
 *        o     o     o      --->         o u o-->o v o     they had `from`; `left_face` is
 *          \   v   /                       \   h   /       u, v, c and `right_face` v, u, d
 *       m2   \   /                      m2   \ | /
 *              o                               o
 *              d                               d */
#ifndef HE_ALGO_PROGRESSIVE_H
#define HE_ALGO_PROGRESSIVE_H

#include "algo/decimate.h"
#include "mesh/column.h"
#include "mesh/mesh.h"

/* What makes one collapse undone. A side without a face has HE_NONE in all it says. */
typedef struct he_progressive_split {
    uint32_t vertex, from;   /* u comes back beside v */
    uint32_t left, right;    /* the third corners, c and d */
    uint32_t halfedge;       /* from u to v */
    uint32_t left_halfedge;  /* from u to c */
    uint32_t right_halfedge; /* from u to d */
    uint32_t left_face, right_face;
    uint32_t moved;      /* faces that go over to u: so many */
    size_t first_moved;  /* from this one on, in he_progressive.moved */
    he_vec3 at, from_at; /* where u and v are then */
} he_progressive_split;

/* Open for reading; written by the decimation. {0} is empty. */
typedef struct he_progressive {
    he_mesh *base;
    he_progressive_split *splits; /* the first is the last to be done */
    size_t count, capacity;
    he_ids moved;
} he_progressive;

/* Decimate a copy, and remember how. What decimate refuses, HE_NO_MEMORY; HE_CANCELLED by the
 * watch, which may be NULL and is not the mesh's: others may read that one meanwhile. The base is
 * what decimate makes of the mesh by the same options. */
HE_NODISCARD he_status he_progressive_new(const he_mesh *m, const he_decimate_options *options,
                                          he_watch *watch, he_progressive *out, he_error *err);
void he_progressive_clear(he_progressive *progressive);

#endif
