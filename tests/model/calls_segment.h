/* calls_segment.h - draws calls of the operation segment, and checks the patches that it makes. */
#ifndef TESTS_MODEL_CALLS_SEGMENT_H
#define TESTS_MODEL_CALLS_SEGMENT_H

#include "model/arguments.h"

/* Draws the arguments of a call of `segment`; always returns true. */
bool md_segment_draw(md_draft *d);
/* Returns the set of refusals of a call on the mesh `m`. */
uint64_t md_segment_refusals(const md_call *c, const he_mesh *m);
/* Returns whether a call has made the right patches and marks, which the mesh `after` has; if not,
 * writes the reason to `text`. The oracle must know the marks from before the call. */
bool md_segment_is_right(const md_call *c, const or_mesh *o, const he_mesh *after,
                         char text[OR_TEXT]);

#endif
