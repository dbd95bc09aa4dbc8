/* parallel.h - a pool of threads that help other threads with parallel loops
 * (core/base/parallel.h).
 *
 * A thread that has a loop in parts runs the parts itself, and idle threads of this pool run some
 * of them. The thread never waits for help: if all pool threads are busy, or there are none, it
 * does the work alone. Work inside a part may be cut into parts again. The thread only waits for
 * parts that another thread has already begun, and each part is short.
 *
 * If several loops run, idle threads take one part of each in turn, so that one large loop does not
 * keep the pool for itself. There is one lock, which is held only while a thread takes a part. */
#ifndef HE_SYSTEM_PARALLEL_H
#define HE_SYSTEM_PARALLEL_H

#include "base/parallel.h"

#include <stddef.h>

typedef struct st_parallel st_parallel;

/* Makes a pool of helping threads. Returns NULL if memory or threads are out. `threads` may be
 * 0. */
st_parallel *st_parallel_new(size_t threads);
/* Frees the pool. No loop may be running. */
void st_parallel_free(st_parallel *parallel);
/* Returns the pool as an he_parallel (core/base/parallel.h), which is valid as long as the pool
 * `parallel`. */
const he_parallel *st_parallel_host(const st_parallel *parallel);

#endif
