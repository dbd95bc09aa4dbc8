/* long_faces_keep.h - fills a mesh's cache of the triangulations of long faces (long_faces.h). */
#ifndef HE_GEOMETRY_LONG_FACES_KEEP_H
#define HE_GEOMETRY_LONG_FACES_KEEP_H

#include "mesh/mesh.h"

/* Triangulates all faces of more than HE_EXACT_CORNERS corners, and puts the triangulations into
 * the mesh's cache, if the mesh may have a cache (he_long_faces_allow) and the cache is empty. Any
 * number of threads may call this function at the same time; the cache keeps the result that is
 * ready first. Progress is reported to `progress`, which may be NULL, and not to the mesh's own
 * watch (he_mesh_set_progress). On failure the cache stays empty.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_long_faces_keep(const he_mesh *mesh, he_progress *progress,
                                          he_error *err);

#endif
