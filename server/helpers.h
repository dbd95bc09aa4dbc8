/* helpers.h - a few threads that take parts of other threads' work: fills in core/mesh/exec.h.
 *
 * Whoever has work in parts goes through them himself; helpers that have nothing else to do take
 * some of them. So nobody waits for a helper to come: with all of them busy, or none, the work is
 * done by its owner alone, and work inside a part may be cut into parts again. Only parts that a
 * helper has begun are waited for, and none takes long.
 *
 * Helpers take a part of each work in turn, so that a large import does not keep them from another.
 * One lock, held for as long as it takes to give out a part. */
#ifndef HE_SERVER_HELPERS_H
#define HE_SERVER_HELPERS_H

#include "mesh/exec.h"

#include <stddef.h>

typedef struct srv_helpers srv_helpers;

/* NULL when memory or threads are out. `threads` may be 0. */
srv_helpers *srv_helpers_new(size_t threads);
/* Nobody may have work in parts any more. */
void srv_helpers_free(srv_helpers *helpers);
/* Lives as long as the helpers. */
const he_exec *srv_helpers_exec(const srv_helpers *helpers);

#endif
