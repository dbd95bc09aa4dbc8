/* limits.h - edits that are refused because they would take too long, or because a mesh would hold
 * more than it may. That needs meshes so large that the oracle has nothing to say of them: only
 * that the refusal comes, is declared, and leaves the mesh as it was. */
#ifndef TESTS_MODEL_LIMITS_H
#define TESTS_MODEL_LIMITS_H

#include "model/tally.h"

/* Once each. NULL, or what went wrong. */
const char *md_limits_run(md_tally *tally);

#endif
