/* stored_trip.h - meshes and edits go through their bytes (stored/stored.h) and come back. */
#ifndef TESTS_UNIT_STORED_TRIP_H
#define TESTS_UNIT_STORED_TRIP_H

#include "mesh/delta.h"

#include <stddef.h>

/* Bytes in a block of just their size; the caller frees. */
typedef struct stored_bytes {
    unsigned char *bytes;
    size_t size;
} stored_bytes;

stored_bytes stored_content(const he_mesh *mesh);
/* `after` is the mesh as the delta has left it. */
stored_bytes stored_edit(const he_delta *delta, const he_mesh *after);
/* A mesh that must be readable; the caller frees. */
he_mesh *stored_load(stored_bytes content);

/* The content of `before` is loaded and goes forward over the bytes of the edit: it is `after`,
 * undo gives `before`, redo `after` again, and the delta that was read has the same bytes. */
void stored_trip(const he_mesh *before, const he_delta *delta, const he_mesh *after);

#endif
