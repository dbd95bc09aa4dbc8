/* stored_trip.h - converts meshes and edits to bytes (stored/stored.h) and back. */
#ifndef TESTS_UNIT_STORED_TRIP_H
#define TESTS_UNIT_STORED_TRIP_H

#include "mesh/delta.h"

#include <stddef.h>

/* Bytes in a block of exactly their size; the caller frees. */
typedef struct stored_bytes {
    unsigned char *bytes;
    size_t size;
} stored_bytes;

stored_bytes stored_content(const he_mesh *mesh);
/* `after` is the mesh after the delta. */
stored_bytes stored_edit(const he_delta *delta, const he_mesh *after);
/* Loads a mesh, which must succeed; the caller frees. */
he_mesh *stored_load(stored_bytes content);

/* Loads the content of `before` and applies the bytes of the edit: the result must equal `after`,
 * undo must give `before`, redo `after` again, and the delta read must have equal bytes. */
void stored_trip(const he_mesh *before, const he_delta *delta, const he_mesh *after);

#endif
