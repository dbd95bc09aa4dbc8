/* giants.h - meshes on which some edits exceed their limit of work, and meshes that are as large as
 * a mesh may be. */
#ifndef TESTS_GIANTS_H
#define TESTS_GIANTS_H

#include "mesh/mesh.h"

/* The functions below return NULL if memory is out. */

/* Returns a star: a polygon with very many points. */
he_mesh *giant_star(void);
/* Returns a strip of triangles between two rows of points, for which the number of Delaunay flips
 * grows with the square of the number of points. */
he_mesh *giant_rows(void);
/* Returns a flat disc of triangles around vertex 0, which has very many neighbours. */
he_mesh *giant_hub(void);
/* Returns a mesh of one triangle with a table of `count` materials that no face uses; their names
 * are PREFIX0, PREFIX1 and so on. */
he_mesh *giant_palette(const char *prefix, size_t count);

#endif
