/* shapes.h - random small meshes to start from: closed and open, triangles to 12-gons, with
 * handles, bow-ties, several components, isolated vertices, or nothing at all. */
#ifndef TESTS_MODEL_SHAPES_H
#define TESTS_MODEL_SHAPES_H

#include "model/random.h"
#include "oracle/oracle.h"

/* Fill an empty oracle. Edges get the ids he_build promises: by first appearance, running as that
 * face does. */
void md_shape(or_mesh *o, md_random *r);
/* The same through he_build; NULL when it refuses. */
he_mesh *md_build(const or_mesh *o);

#endif
