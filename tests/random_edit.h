/* random_edit.h - random operations as requests spell them, made from the operation table and from
 * a client's copy of the mesh. The arguments lie close together, so that many operations
 * succeed. */
#ifndef TESTS_RANDOM_EDIT_H
#define TESTS_RANDOM_EDIT_H

#include "tests/mirror.h"
#include "tests/model/random.h"

#include <stddef.h>

enum { RANDOM_EDIT_TEXT = 1024 };

/* Makes an edit with the row of this index. The mesh must have an edge; operations that need
 * another mesh name the mesh m.
 */
void random_edit(md_random *r, const mirror *m, size_t row, char text[RANDOM_EDIT_TEXT]);

#endif
