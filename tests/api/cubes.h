/* cubes.h - a bench with two equal cubes, for tests that compare edits of both or look at what an
 * edit has changed. */
#ifndef TESTS_API_CUBES_H
#define TESTS_API_CUBES_H

#include "tests/api/request.h"

/* Makes a bench with the cubes "m" and "n"; the caller must free it. */
api_bench *cubes_begin(void);
/* Returns a copy of a mesh, including the number of ids that it has issued; the caller must free
 * it. */
he_mesh *cubes_copy(api_bench *b, const char *id);
/* Requires that the mesh `id` of the bench equals `mesh` in every bit. */
void cubes_expect(api_bench *b, const he_mesh *mesh, const char *id);

#endif
