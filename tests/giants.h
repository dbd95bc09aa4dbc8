/* giants.h - meshes on which some edits exceed their limit of work, or that are as large as a mesh
 * may be. */
#ifndef TESTS_GIANTS_H
#define TESTS_GIANTS_H

#include "mesh/mesh.h"

/* All functions return NULL when memory is out. */

/* A star of very many points. */
he_mesh *giant_star(void);
/* Two rows of points, connected so that the number of flips grows with the square of their
 * number. */
he_mesh *giant_rows(void);
/* A triangle whose table has `count` materials with the names PREFIX0, PREFIX1 and so on; no face
 * uses one.
 */
he_mesh *giant_palette(const char *prefix, size_t count);

#endif
