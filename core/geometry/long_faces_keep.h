/* long_faces_keep.h - makes the triangulations that a mesh keeps (long_faces.h). */
#ifndef HE_GEOMETRY_LONG_FACES_KEEP_H
#define HE_GEOMETRY_LONG_FACES_KEEP_H

#include "mesh/mesh.h"

/* Triangulates the long faces, unless that is done, where the mesh may keep them. Any number of
 * threads may call this at the same time: the first result stays. The watch, which may be NULL, is
 * not the mesh's. Returns HE_NO_MEMORY or HE_CANCELLED, and nothing is kept then. */
HE_NODISCARD he_status he_long_faces_keep(const he_mesh *mesh, he_watch *watch, he_error *err);

#endif
