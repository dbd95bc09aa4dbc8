/* giants.h - meshes on which some edits take more work than they are allowed. */
#ifndef TESTS_GIANTS_H
#define TESTS_GIANTS_H

#include "mesh/mesh.h"

/* Both are NULL when there is no memory. */

/* A star of very many points. */
he_mesh *giant_star(void);
/* Two rows of points, joined so that flips grow with the square of their number. */
he_mesh *giant_rows(void);

#endif
