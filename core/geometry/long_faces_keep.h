/* long_faces_keep.h - fills a mesh's cache of long faces (long_faces.h). */
#ifndef HE_GEOMETRY_LONG_FACES_KEEP_H
#define HE_GEOMETRY_LONG_FACES_KEEP_H

#include "mesh/mesh.h"

/* Triangulates the long faces, if the cache is allowed and empty. Any number of threads may call
 * this at the same time: the first result stays. `progress`, which may be NULL, need not be that of
 * the mesh. On failure the cache stays empty.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_long_faces_keep(const he_mesh *mesh, he_progress *progress,
                                          he_error *err);

#endif
