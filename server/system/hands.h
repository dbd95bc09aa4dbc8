/* hands.h - a few threads that take parts of other threads' work: fills in core/base/exec.h.
 *
 * Whoever has work in parts goes through them himself; hands that have nothing else to do take
 * some of them. So nobody waits for a hand to come: with all of them busy, or none, the work is
 * done by its owner alone, and work inside a part may be cut into parts again. Only parts that a
 * hand has begun are waited for, and none takes long.
 *
 * Hands take a part of each work in turn, so that a large import does not keep them from another.
 * One lock, held for as long as it takes to give out a part. */
#ifndef HE_SERVER_SYSTEM_HANDS_H
#define HE_SERVER_SYSTEM_HANDS_H

#include "base/exec.h"

#include <stddef.h>

typedef struct srv_hands srv_hands;

/* NULL when memory or threads are out. `threads` may be 0. */
srv_hands *srv_hands_new(size_t threads);
/* Nobody may have work in parts any more. */
void srv_hands_free(srv_hands *hands);
/* Lives as long as the hands. */
const he_exec *srv_hands_exec(const srv_hands *hands);

#endif
