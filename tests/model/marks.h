/* marks.h - features and locks on some of the model's meshes. */
#ifndef TESTS_MODEL_MARKS_H
#define TESTS_MODEL_MARKS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* Now and then add columns of marks to a new mesh, with a few set. False when memory is out. */
bool md_mark(he_mesh *m, md_random *r);
/* Tell the oracle which elements are marked. */
void md_read_marks(or_mesh *o, const he_mesh *m);

#endif
