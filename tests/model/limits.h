/* limits.h - edits that are refused because they would take too long, or because the mesh would
 * exceed a maximum. The meshes are too large for the oracle, so only this is checked: the edit is
 * refused as declared, and the mesh is unchanged. */
#ifndef TESTS_MODEL_LIMITS_H
#define TESTS_MODEL_LIMITS_H

#include "model/tally.h"

/* Runs each edit in the table of limits.c once. Returns NULL, or what went wrong. */
const char *md_limits_run(md_tally *tally);

#endif
