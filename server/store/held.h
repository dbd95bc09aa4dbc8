/* held.h - answers that wait until what they show is durable.
 *
 * D1: no answer shows a change that a crash could lose. Whoever is about to send one that the
 * journal has not caught up with adds a hold, and is called back, once, from another thread when
 * the journal has, or when the server stops (then `abandoned` is set and the answer must not be
 * sent). */
#ifndef HE_SERVER_STORE_HELD_H
#define HE_SERVER_STORE_HELD_H

#include "server/store/store.h"

#include <stdbool.h>

typedef struct srv_held srv_held;

/* In the caller's storage, which outlives the hold. */
typedef struct srv_hold {
    const api_mesh *mesh; /* with a reference of the caller's */
    uint64_t record;      /* api_mesh_info */
    void (*resume)(struct srv_hold *hold);
    bool abandoned;
    struct srv_hold *next, *previous;
} srv_hold;

/* Listens to the store. NULL when memory is out. */
srv_held *srv_held_new(srv_store *store);
/* Nothing may be held. */
void srv_held_free(srv_held *held);

/* False when there is nothing to wait for: resume is not called then. */
bool srv_held_add(srv_held *held, srv_hold *hold);
/* Resume all as abandoned, and from now on whatever is added. */
void srv_held_abandon(srv_held *held);

#endif
