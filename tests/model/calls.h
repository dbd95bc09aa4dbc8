/* calls.h - random calls of the operation table, with valid and invalid arguments, and the oracle's
 * result for each.
 *
 * Every row of the table must have a line here: md_missing names one that has none. */
#ifndef TESTS_MODEL_CALLS_H
#define TESTS_MODEL_CALLS_H

#include "model/arguments.h"

/* Returns NULL, or the name of a row without a line. */
const char *md_missing(void);
/* Chooses a row and its arguments. Returns false if the row does not suit the mesh: draw again.
 * `far`: coordinates are as large as doubles get; `room` is false if the mesh should not grow. */
bool md_draw(md_call *c, const or_mesh *o, const he_mesh *m, md_random *r, bool far, bool room);
/* Runs the call on the oracle, before hedge runs it. Returns the set of refusals that apply. */
uint64_t md_play(const md_call *c, or_mesh *o, const he_mesh *m);
/* Follows operations whose steps hedge may order freely: after hedge succeeded, applies the
 * reported steps to the oracle. Returns false with a sentence if they are wrong. */
bool md_follow(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT]);

#endif
