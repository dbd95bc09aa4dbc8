/* progressive.h - a progressive mesh: a coarse mesh and the vertex splits that lead back to the
 * original.
 *
 * H. Hoppe, "Progressive meshes", 1996: a decimation is recorded collapse by collapse, and each
 * collapse is undone by a vertex split. Undoing the collapses in reverse order leads through all
 * levels of detail to the original mesh, with equal ids, ends of edges, corners of faces and
 * positions.
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

/* The data needed to undo one collapse. If a side of the collapsed edge has no face, the fields of
 * that side are HE_NONE. */
typedef struct he_progressive_split {
    /* `vertex` is u, which the split makes; `from` is v, which stays and from which u is split
     * off */
    uint32_t vertex, from;
    /* `left` and `right` are c and d, the third corners of the two faces beside the edge u-v */
    uint32_t left, right;
    uint32_t halfedge;       /* half-edge from u to v */
    uint32_t left_halfedge;  /* half-edge from u to c */
    uint32_t right_halfedge; /* half-edge from u to d */
    uint32_t left_face, right_face;
    uint32_t moved;      /* number of faces that get the corner u in place of v */
    size_t first_moved;  /* index of the first of these faces in he_progressive.moved */
    he_vec3 at, from_at; /* positions of u and v after the split */
} he_progressive_split;

/* A progressive mesh. All code may read the fields, but only the decimation writes them. {0} is
 * empty. */
typedef struct he_progressive {
    he_mesh *base;
    /* The splits in the order of the collapses that they undo, so the last split of the array is
     * applied first. */
    he_progressive_split *splits;
    size_t count, capacity;
    he_ids moved;
} he_progressive;

/* Decimates a copy of `m` and records the collapses; the coarsest level is what he_decimate makes
 * with these options. Progress is reported to `progress`, which may be NULL, and not to the watch
 * of the mesh, so other threads may read the mesh meanwhile. Returns the errors of he_decimate,
 * too.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_progressive_new(const he_mesh *m, const he_decimate_options *options,
                                          he_progress *progress, he_progressive *out,
                                          he_error *err);
void he_progressive_clear(he_progressive *progressive);

#endif
