/* stored_trip.h - converts meshes and edits to bytes (stored/stored.h) and back. */
#ifndef TESTS_UNIT_STORED_TRIP_H
#define TESTS_UNIT_STORED_TRIP_H

#include "mesh/delta.h"

#include <stddef.h>

/* Encoded bytes, in a block of exactly their size, which the caller must free. */
typedef struct stored_bytes {
    unsigned char *bytes;
    size_t size;
} stored_bytes;

stored_bytes stored_content(const he_mesh *mesh);
/* Encodes an edit; `after` is the mesh after it. */
stored_bytes stored_edit(const he_delta *delta, const he_mesh *after);
/* Decodes a mesh, which must succeed; the caller must free it. */
he_mesh *stored_load(stored_bytes content);

/* Decodes the content of `before` and applies the bytes of the edit: the result must equal `after`,
 * undo must give `before`, redo must give `after` again, and the delta that was read must be
 * encoded to equal bytes. */
void stored_trip(const he_mesh *before, const he_delta *delta, const he_mesh *after);

#endif
