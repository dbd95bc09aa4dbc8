/* event_backfill.h - events that a listener has missed, made from the history of the mesh.
 *
 * Tasks on the job pool step through the revisions with a cursor (store/history_cursor.h) and make
 * one event for each, in batches. The next batch is begun when the listener has taken the last one,
 * so a listener needs memory for a copy of the mesh and for one batch, however many events it
 * missed. At most API_MAX_BACKFILLS backfills run at once. */
#ifndef HE_API_EVENT_EVENT_BACKFILL_H
#define HE_API_EVENT_EVENT_BACKFILL_H

#include "api/json/text.h"
#include "store/store.h"
#include "system/thread_pool.h"

#include <stdatomic.h>

typedef struct api_backfill api_backfill;

/* What all backfills of a service share. The job pool must have ended its tasks before the store is
 * freed. */
typedef struct api_backfills {
    st_pool *pool;
    _Atomic size_t count; /* number of backfills that exist */
} api_backfills;

/* Begins to make the events of the revisions after from->revision up to `to`. Revision `to` must be
 * durable before the first event is taken. Returns NULL when memory is out or too many backfills
 * run. */
api_backfill *api_backfill_new(api_backfills *all, st_mesh *mesh, const st_mesh_info *from,
                               uint64_t to);
/* Frees a backfill, which may be NULL. A batch in progress is discarded when it is done. */
void api_backfill_free(api_backfill *c);
/* Sets the callback that a thread of the job pool calls when the events are ready after
 * API_BACKFILL_WAIT. It must be set before the first api_backfill_take. */
void api_backfill_wake(api_backfill *c, void (*wake)(void *context), void *context);

typedef enum api_backfill_step {
    API_BACKFILL_TEXT, /* `text`, which must be empty before the call, now has events */
    API_BACKFILL_WAIT, /* the events are being made; `wake` will be called */
    API_BACKFILL_DONE, /* there are no more events */
    /* The history does not reach back far enough, memory is out, or the pool accepts no task. */
    API_BACKFILL_FAILED
} api_backfill_step;

api_backfill_step api_backfill_take(api_backfill *c, api_text *text);

#endif
