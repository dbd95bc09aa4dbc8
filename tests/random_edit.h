/* random_edit.h - requests with random operations, made from the table of operations and from a
 * client's copy of the mesh. The arguments are elements near each other, so that many of the
 * operations succeed. */
#ifndef TESTS_RANDOM_EDIT_H
#define TESTS_RANDOM_EDIT_H

#include "tests/mirror.h"
#include "tests/model/random.h"

#include <stddef.h>

enum { RANDOM_EDIT_TEXT = 1024 };

/* Writes a request for an edit with the operation in row `row` of the table of operations. The mesh
 * must have an edge. If the operation needs another mesh, the edit names the mesh "m". */
void random_edit(md_random *r, const mirror *m, size_t row, char text[RANDOM_EDIT_TEXT]);

#endif
