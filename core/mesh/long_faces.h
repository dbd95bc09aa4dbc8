/* long_faces.h - a cache of the triangulations of long faces, which are the faces of more than
 * HE_EXACT_CORNERS corners.
 *
 * Triangulating a face of very many corners takes long, and several readers of one revision of a
 * mesh need the result: the arrays for a renderer, each file format of triangles and the tree of
 * boxes. A mesh that many threads read and none writes, such as a snapshot (replay.h), may have
 * this cache. It is filled with the triangulations of all long faces the first time that a caller
 * needs them (he_long_faces_keep). he_triangulation_make reads the cache.
 *
 * The cache belongs to the mesh. Its memory comes from he_mem, so it counts in the
 * memory budget. */
#ifndef HE_MESH_LONG_FACES_H
#define HE_MESH_LONG_FACES_H

#include "mesh/mesh.h"

/* Allows a mesh to have a cache of long faces. Otherwise it has none.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_long_faces_allow(he_mesh *mesh, he_error *err);
/* Empties the cache of long faces of a mesh. Must be called before the mesh is changed, while no
 * other thread reads the mesh. The cache may be filled again after the change. */
void he_long_faces_forget(he_mesh *mesh);
/* Frees the cache of long faces of a mesh; he_mesh_free calls this function. */
void he_long_faces_clear(he_mesh *mesh);
/* Returns the bytes of memory of a mesh's cache of long faces. */
size_t he_long_faces_bytes(const he_mesh *mesh);

/* A cached triangulation of one face, made with the flag HE_ANY_DIAGONALS (triangulation.h).
 * Callers borrow it. */
typedef struct he_long_face {
    uint32_t face, n; /* id of the face, and its number of corners */
    bool degenerate;
    uint32_t *corners; /* three corners for each triangle, as in triangulation.h */
} he_long_face;

/* All cached triangulations of a mesh, sorted by the ids of the faces. long_faces_keep.c makes
 * them. */
typedef struct he_long_faces {
    size_t count;
    he_long_face face[];
} he_long_faces;

/* Frees triangulations of long faces. `all` may be NULL. */
void he_long_faces_free(he_long_faces *all);
/* Returns true if the mesh may have a cache of long faces, and the cache is still empty. */
bool he_long_faces_are_wanted(const he_mesh *mesh);
/* Fills the mesh's cache of long faces with `all`, which the cache then owns. If another thread has
 * filled the cache already, `all` is freed. The mesh must be allowed to have a cache. */
void he_long_faces_put(const he_mesh *mesh, he_long_faces *all);

/* Finds the cached triangulation of the face whose stored half-edge is `first`. Returns NULL if
 * `first` is not the stored half-edge of a face, or if that face is not in the cache. */
const he_long_face *he_long_faces_find(const he_mesh *mesh, he_halfedge first);

#endif
