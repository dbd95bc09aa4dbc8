/* giants.h - meshes on which some edits take more work than they are allowed, or that hold as much
 * as a mesh may. */
#ifndef TESTS_GIANTS_H
#define TESTS_GIANTS_H

#include "mesh/mesh.h"

/* Each is NULL when there is no memory. */

/* A star of very many points. */
he_mesh *giant_star(void);
/* Two rows of points, joined so that flips grow with the square of their number. */
he_mesh *giant_rows(void);
/* A triangle whose table has `count` materials, called PREFIX0, PREFIX1 and so on; no face has one.
 */
he_mesh *giant_palette(const char *prefix, size_t count);

#endif
