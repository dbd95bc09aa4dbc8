/* calls.h - random calls of the operation table, with right and wrong arguments, and what the
 * oracle says to each.
 *
 * Every row of the table must have its line here: md_missing names one that has none. */
#ifndef TESTS_MODEL_CALLS_H
#define TESTS_MODEL_CALLS_H

#include "model/arguments.h"

/* NULL, or the name of a row without a line here. */
const char *md_missing(void);
/* Choose a row and its arguments. False when this one does not suit the mesh: draw again. `far` is
 * true when coordinates are as large as doubles get, `room` false when the mesh should not grow any
 * more. */
bool md_draw(md_call *c, const or_mesh *o, const he_mesh *m, md_random *r, bool far, bool room);
/* Play the call on the oracle, before hedge runs it: the set of refusals that apply. */
uint64_t md_play(const md_call *c, or_mesh *o, const he_mesh *m);
/* Where the order of the steps is hedge's choice: after it succeeded, take the ones it reports on
 * the oracle too. False with a sentence when they are not right. */
bool md_follow(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT]);

#endif
