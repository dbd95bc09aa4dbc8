/* event_backfill.h - the events a listener missed, made from the history of its mesh.
 *
 * A cursor (store/history_cursor.h) steps through the revisions on the job pool and renders one
 * event for each, in batches. The next batch begins when the last one was taken, so that a listener
 * costs a copy of its mesh and one batch, however many events it missed. At most API_MAX_BACKFILLS
 * run at once. */
#ifndef HE_API_EVENT_EVENT_BACKFILL_H
#define HE_API_EVENT_EVENT_BACKFILL_H

#include "api/json/text.h"
#include "store/store.h"
#include "system/thread_pool.h"

#include <stdatomic.h>

typedef struct api_backfill api_backfill;

/* State that the backfills of a service share. The pool finishes before the store is freed. */
typedef struct api_backfills {
    st_pool *pool;
    _Atomic size_t count; /* backfills that are running */
} api_backfills;

/* Makes the events of the revisions after from->revision up to `to`, which must be durable before
 * an event is taken. Returns NULL when memory is out or too many backfills run. */
api_backfill *api_backfill_new(api_backfills *all, st_mesh *mesh, const st_mesh_info *from,
                               uint64_t to);
/* Frees a backfill, which may be NULL. A batch in progress is discarded when it is done. */
void api_backfill_free(api_backfill *c);
/* Sets the callback that follows an API_BACKFILL_WAIT; a thread of the job pool calls it. It must
 * be set before the first take. */
void api_backfill_wake(api_backfill *c, void (*wake)(void *context), void *context);

typedef enum api_backfill_step {
    API_BACKFILL_TEXT,  /* `text`, which was empty, now holds events */
    API_BACKFILL_WAIT,  /* the events are being made */
    API_BACKFILL_DONE,  /* there are no more */
    API_BACKFILL_FAILED /* failed: the history does not reach back, or no memory or job is free */
} api_backfill_step;

api_backfill_step api_backfill_take(api_backfill *c, api_text *text);

#endif
