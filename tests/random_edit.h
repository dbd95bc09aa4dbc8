/* random_edit.h - random operations as a request spells them, drawn from the operation table and
 * from a client's copy of the mesh, with arguments that lie close together so that many succeed. */
#ifndef TESTS_RANDOM_EDIT_H
#define TESTS_RANDOM_EDIT_H

#include "tests/mirror.h"
#include "tests/model/random.h"

#include <stddef.h>

enum { RANDOM_EDIT_TEXT = 1024 };

/* Rows of the table by index. The mesh has an edge; its id is m, where another mesh is asked for.
 */
void random_edit(md_random *r, const mirror *m, size_t row, char text[RANDOM_EDIT_TEXT]);

#endif
