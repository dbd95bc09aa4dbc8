/* long_faces.h - the triangulations of the long faces of a mesh that stays as it is, kept with it.
 *
 * To cut a face of very many corners takes a while, and the arrays for a renderer, each format of
 * triangles and the tree of boxes of one revision all need it cut. A mesh that many readers share
 * and nobody writes to, such as a copy at a revision (replay.h), KEEPS the triangulations of its
 * faces of more than HE_EXACT_CORNERS corners from the first time that somebody wants them all.
 * he_triangulation_make takes them from there.
 *
 * What is kept belongs to the mesh. It comes from he_mem, so it is counted. */
#ifndef HE_MESH_LONG_FACES_H
#define HE_MESH_LONG_FACES_H

#include "mesh/mesh.h"

/* Lets the mesh keep triangulations. Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_long_faces_allow(he_mesh *mesh, he_error *err);
/* Before the mesh changes, while no one else reads it. It may keep them again afterwards. */
void he_long_faces_forget(he_mesh *mesh);
/* Frees all that `allow` and `keep` made: for he_mesh_free. */
void he_long_faces_clear(he_mesh *mesh);
/* Bytes that are kept. */
size_t he_long_faces_bytes(const he_mesh *mesh);

/* A triangulation that is kept, with HE_ANY_DIAGONALS alone; borrowed. */
typedef struct he_long_face {
    uint32_t face, n; /* corners */
    bool degenerate;
    uint32_t *corners; /* three a triangle, as in triangulation.h */
} he_long_face;

/* In the order of faces. Made by long_faces_keep.c. */
typedef struct he_long_faces {
    size_t count;
    he_long_face face[];
} he_long_faces;

/* Accepts NULL. */
void he_long_faces_free(he_long_faces *all);
/* May the mesh keep them, and does not yet? */
bool he_long_faces_are_wanted(const he_mesh *mesh);
/* Keeps `all`, which is taken, for a mesh that may keep them; where another thread was first, its
 * stay and `all` is freed. */
void he_long_faces_put(const he_mesh *mesh, he_long_faces *all);

/* NULL when the loop is not that of a face, from its stored half-edge, or none is kept. */
const he_long_face *he_long_faces_find(const he_mesh *mesh, he_halfedge first);

#endif
