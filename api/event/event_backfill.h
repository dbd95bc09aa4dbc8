/* event_backfill.h - the events a listener missed, from the history of its mesh.
 *
 * A cursor (store/history_cursor.h) steps through the revisions on the job pool and renders one
 * event each, a batch at a time: the next batch is begun when the one before was taken, so that a
 * listener costs a copy of its mesh and one batch, however much it missed. At most
 * API_MAX_BACKFILLS run at once. */
#ifndef HE_API_EVENT_EVENT_BACKFILL_H
#define HE_API_EVENT_EVENT_BACKFILL_H

#include "api/json/text.h"
#include "store/store.h"
#include "system/thread_pool.h"

#include <stdatomic.h>

typedef struct api_backfill api_backfill;

/* What the backfills of a service share. The pool runs to its end before the store is freed. */
typedef struct api_backfills {
    st_pool *pool;
    _Atomic size_t count; /* that run */
} api_backfills;

/* The revisions after info->revision up to `to`, which is durable or will be before anything is
 * taken. NULL when memory is out or too many run. */
api_backfill *api_backfill_new(api_backfills *all, st_mesh *mesh, const st_mesh_info *from,
                               uint64_t to);
/* Takes NULL. A batch that is being made is thrown away when it is done. */
void api_backfill_free(api_backfill *c);
/* What to call after API_BACKFILL_WAIT, from a thread of the job pool. Before the first take. */
void api_backfill_wake(api_backfill *c, void (*wake)(void *context), void *context);

typedef enum api_backfill_step {
    API_BACKFILL_TEXT,  /* `text`, which was empty, has events */
    API_BACKFILL_WAIT,  /* they are being made */
    API_BACKFILL_DONE,  /* all were taken */
    API_BACKFILL_FAILED /* the history does not reach back any more, or memory or jobs are out */
} api_backfill_step;

api_backfill_step api_backfill_take(api_backfill *c, api_text *text);

#endif
