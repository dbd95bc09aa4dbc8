/* fixture.h - small meshes for unit tests. */
#ifndef TESTS_UNIT_FIXTURE_H
#define TESTS_UNIT_FIXTURE_H

#include "build/build.h"
#include "mesh/check.h"
#include "mesh/delta.h"
#include "mesh/walk.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Makes a soup of faces, which are strings of one-character vertex numbers, separated by blanks or
 * commas, as in "012,023". */
void fixture_soup(he_soup *soup, const char *faces);

/* Fails the test if the mesh breaks an invariant. */
void fixture_check(const he_mesh *mesh);

/* Makes a mesh of faces as in fixture_soup(), and checks it; the caller must free it. */
he_mesh *fixture_mesh(const char *faces);

/* Requires these numbers of live vertices, edges and faces. */
void fixture_counts(const he_mesh *mesh, unsigned v, unsigned e, unsigned f);

#endif
