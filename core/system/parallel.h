/* parallel.h - threads that take parts of other threads' work: fills in core/base/exec.h.
 *
 * A thread that has work in parts goes through them itself, and idle threads of this pool take some
 * of them. The owner never waits for one to come: with all of them busy, or none, it does the work
 * alone, and work inside a part may be cut into parts again. Only parts that another thread has
 * begun are waited for, and none takes long.
 *
 * Idle threads take a part of each work in turn, so that a large import does not keep them from
 * another. One lock, held for as long as it takes to give out a part. */
#ifndef HE_SYSTEM_PARALLEL_H
#define HE_SYSTEM_PARALLEL_H

#include "base/exec.h"

#include <stddef.h>

typedef struct st_parallel st_parallel;

/* NULL when memory or threads are out. `threads` may be 0. */
st_parallel *st_parallel_new(size_t threads);
/* Nobody may have work in parts any more. */
void st_parallel_free(st_parallel *parallel);
/* Lives as long as `parallel`. */
const he_exec *st_parallel_exec(const st_parallel *parallel);

#endif
