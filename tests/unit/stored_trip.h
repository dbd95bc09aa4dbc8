/* stored_trip.h - converts meshes and edits to bytes (stored/stored.h) and back. */
#ifndef TESTS_UNIT_STORED_TRIP_H
#define TESTS_UNIT_STORED_TRIP_H

#include "mesh/delta.h"

#include <stddef.h>

/* The encoding of a mesh or an edit, in a block of exactly its size, which the caller must free. */
typedef struct stored_bytes {
    unsigned char *bytes;
    size_t size;
} stored_bytes;

stored_bytes stored_content(const he_mesh *mesh);
/* Encodes an edit; `after` is the mesh after the edit. */
stored_bytes stored_edit(const he_delta *delta, const he_mesh *after);
/* Decodes a stored mesh, and fails the test if this is impossible. The caller must free the
 * mesh. */
he_mesh *stored_load(stored_bytes content);

/* Encodes and decodes `before`, then applies the encoded edit to it: the result must equal `after`,
 * undo must give `before`, redo must give `after` again, and the decoded edit must be encoded to
 * equal bytes. */
void stored_trip(const he_mesh *before, const he_delta *delta, const he_mesh *after);

#endif
