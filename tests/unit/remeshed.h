/* remeshed.h - remeshing for tests that expect it to succeed. */
#ifndef TESTS_UNIT_REMESHED_H
#define TESTS_UNIT_REMESHED_H

#include "mesh/column.h"
#include "remesh/remesh.h"

/* Returns the usual options for a length of edges or, if it is 0, for a number of faces, which the
 * caller sets. */
he_remesh_options remesh_options(double edge_length);

/* Adds an attribute to the mesh, with the default values, and returns its column. */
he_column *remesh_add_column(he_mesh *m, const he_column_schema *schema);

/* Remeshes, and fails the test if that is refused or the mesh is not valid afterwards. */
he_remeshed remesh_mesh(he_mesh *m, const he_remesh_options *options);

#endif
