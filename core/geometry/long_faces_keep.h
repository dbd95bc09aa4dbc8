/* long_faces_keep.h - fills a mesh's cache of long faces (long_faces.h). */
#ifndef HE_GEOMETRY_LONG_FACES_KEEP_H
#define HE_GEOMETRY_LONG_FACES_KEEP_H

#include "mesh/mesh.h"

/* Triangulates the long faces into the cache, if the mesh is allowed to have it and it is empty.
 * Any number of threads may call this function at the same time: the first result is kept. Progress
 * is reported to `progress`, which may be NULL, and not to the watch of the mesh. On failure the
 * cache stays empty.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_long_faces_keep(const he_mesh *mesh, he_progress *progress,
                                          he_error *err);

#endif
