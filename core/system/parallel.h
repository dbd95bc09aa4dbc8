/* parallel.h - threads that help other threads with parallel loops: a host for
 * core/base/parallel.h.
 *
 * A thread that has work in parts does them itself, and idle threads of this pool take some of
 * them. The thread never waits for help: if all pool threads are busy, or there are none, it does
 * the work alone. Work inside a part may be cut into parts again. The thread only waits for parts
 * that another thread has begun, and each part is short.
 *
 * Idle threads take one part of each work in turn, so that a large import cannot keep them from
 * other work. There is one lock, held for as long as it takes to hand out a part. */
#ifndef HE_SYSTEM_PARALLEL_H
#define HE_SYSTEM_PARALLEL_H

#include "base/parallel.h"

#include <stddef.h>

typedef struct st_parallel st_parallel;

/* Makes a pool of helping threads. Returns NULL if memory or threads are out. `threads` may be
 * 0. */
st_parallel *st_parallel_new(size_t threads);
/* Frees the pool. No thread may have work in parts any more. */
void st_parallel_free(st_parallel *parallel);
/* Returns the pool as a host (parallel.h), which lives as long as `parallel`. */
const he_parallel *st_parallel_host(const st_parallel *parallel);

#endif
