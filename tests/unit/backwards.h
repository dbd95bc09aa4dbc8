/* backwards.h - a host of parallel loops (base/parallel.h) that runs the parts one after another,
 * the last one first: no part may need what an earlier one has found. */
#ifndef TESTS_UNIT_BACKWARDS_H
#define TESTS_UNIT_BACKWARDS_H

#include "base/parallel.h"

/* Makes `progress` lend this host. It counts the parts in `*parts`. */
void backwards_lend(he_progress *progress, uint32_t *parts);

#endif
