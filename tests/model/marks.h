/* marks.h - features, locks and other values on some of the meshes of the model. */
#ifndef TESTS_MODEL_MARKS_H
#define TESTS_MODEL_MARKS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* Now and then add columns of marks to a new mesh, with a few set, columns of numbers, and an
 * attribute `material` of faces that names no materials. False when memory is out. */
bool md_mark(he_mesh *m, md_random *r);
/* Tell the oracle which elements are marked. */
void md_read_marks(or_mesh *o, const he_mesh *m);

#endif
