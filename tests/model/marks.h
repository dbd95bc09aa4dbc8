/* marks.h - feature edges, locks and other attributes, on some meshes of the model test. */
#ifndef TESTS_MODEL_MARKS_H
#define TESTS_MODEL_MARKS_H

#include "model/random.h"
#include "oracle/oracle.h"

/* To some new meshes, adds feature edges and locks (each set for a few elements), attributes of
 * numbers, and an attribute `material` of faces whose values name no materials. Returns false when
 * memory is out. */
bool md_mark(he_mesh *m, md_random *r);
/* Copies the locks and features of hedge's mesh to the oracle. */
void md_read_marks(or_mesh *o, const he_mesh *m);

#endif
