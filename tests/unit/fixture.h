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

/* Makes a soup (a list of unconnected faces). Each face is a string of one-character vertex
 * numbers; blanks or commas separate the faces, as in "012,023". */
void fixture_soup(he_soup *soup, const char *faces);

/* Fails the test if the mesh breaks an invariant. */
void fixture_check(const he_mesh *mesh);

/* Makes a mesh of faces written as in fixture_soup(), and checks it; the caller must free the
 * mesh. */
he_mesh *fixture_mesh(const char *faces);

/* Requires that the mesh has these numbers of vertices, edges and faces that are not deleted. */
void fixture_counts(const he_mesh *mesh, unsigned v, unsigned e, unsigned f);

#endif
