/* random_edit.h - random operations in the form of requests, made from the table of operations and
 * from a client's copy of the mesh. Their arguments are elements near each other, so that many of
 * the operations succeed. */
#ifndef TESTS_RANDOM_EDIT_H
#define TESTS_RANDOM_EDIT_H

#include "tests/mirror.h"
#include "tests/model/random.h"

#include <stddef.h>

enum { RANDOM_EDIT_TEXT = 1024 };

/* Writes an edit with the operation in this row of the table. The mesh must have an edge; an
 * operation that needs another mesh names the mesh "m". */
void random_edit(md_random *r, const mirror *m, size_t row, char text[RANDOM_EDIT_TEXT]);

#endif
