/* marks.h - features, locks and other attributes on some meshes of the model. */
#ifndef TESTS_MODEL_MARKS_H
#define TESTS_MODEL_MARKS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* Sometimes adds marks to a new mesh, with a few set, columns of numbers, and an attribute
 * `material` of faces that names no materials. Returns false when memory is out. */
bool md_mark(he_mesh *m, md_random *r);
/* Passes the marked elements to the oracle. */
void md_read_marks(or_mesh *o, const he_mesh *m);

#endif
