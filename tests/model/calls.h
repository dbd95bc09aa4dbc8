/* calls.h - draws random calls of the operations in hedge's table, with valid and invalid
 * arguments, and gives the oracle's result for each.
 *
 * Every operation must have a line in the tables of rows.h: md_missing names one that has none. */
#ifndef TESTS_MODEL_CALLS_H
#define TESTS_MODEL_CALLS_H

#include "model/arguments.h"

/* Returns the name of an operation that has no line in the tables of rows.h, or NULL. */
const char *md_missing(void);
/* Draws an operation and its arguments. Returns false if the mesh has no arguments for the
 * operation: then the caller must draw again. If `far` is true, coordinates may be as large as the
 * largest double; `room` is false if the mesh should not grow. */
bool md_draw(md_call *c, const or_mesh *o, const he_mesh *m, md_random *r, bool far, bool room);
/* Runs the call on the oracle, before hedge runs it. Returns the set of refusals that apply. */
uint64_t md_play(const md_call *c, or_mesh *o, const he_mesh *m);
/* Must be called after hedge succeeded. If hedge may choose the order of the operation's steps,
 * applies to the oracle the steps that hedge reported. Returns false, and writes the reason to
 * `text`, if a step is wrong. */
bool md_follow(const md_call *c, or_mesh *o, const he_results *results, char text[OR_TEXT]);

#endif
