/* durability_wait.h - answers that wait until what they show is durable.
 *
 * D1: no answer shows a change that a crash could lose. Whoever is about to send one that the
 * journal has not caught up with adds a wait, and is called back, once, from another thread when
 * the journal has, or when the server stops (then `abandoned` is set and the answer must not be
 * sent). */
#ifndef HE_STORE_DURABILITY_WAIT_H
#define HE_STORE_DURABILITY_WAIT_H

#include "store/store.h"

#include <stdbool.h>

typedef struct st_waits st_waits;

/* In the caller's storage, which outlives the wait. */
typedef struct st_wait {
    const st_mesh *mesh; /* with a reference of the caller's */
    uint64_t record;     /* st_mesh_info */
    void (*resume)(struct st_wait *wait);
    bool abandoned;
    struct st_wait *next, *previous;
} st_wait;

/* Listens to the store. NULL when memory is out. */
st_waits *st_waits_new(st_store *store);
/* Nothing may be waits. */
void st_waits_free(st_waits *waits);

/* False when there is nothing to wait for: resume is not called then. */
bool st_waits_add(st_waits *waits, st_wait *wait);
/* Resume all as abandoned, and from now on whatever is added. */
void st_waits_abandon(st_waits *waits);

#endif
