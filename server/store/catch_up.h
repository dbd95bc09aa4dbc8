/* catch_up.h - the events a listener missed, from the history of its mesh.
 *
 * A walk (replay_walk.h) steps through the revisions on the job pool and renders one event each, a
 * batch at a time: the next batch is begun when the one before was taken, so that a listener costs
 * a copy of its mesh and one batch, however much it missed. At most SRV_MAX_CATCH_UPS run at
 * once. */
#ifndef HE_SERVER_STORE_CATCH_UP_H
#define HE_SERVER_STORE_CATCH_UP_H

#include "api/json/text.h"
#include "server/store/mesh_events.h"

typedef struct srv_catch_up srv_catch_up;

/* The revisions after info->revision up to `to`, which is durable or will be before anything is
 * taken. NULL when memory is out or too many run. */
srv_catch_up *srv_catch_up_new(api_mesh *mesh, const api_mesh_info *from, uint64_t to);
/* Takes NULL. A batch that is being made is thrown away when it is done. */
void srv_catch_up_free(srv_catch_up *c);
/* What to call after SRV_CATCH_UP_WAIT, from a thread of the job pool. Before the first take. */
void srv_catch_up_wake(srv_catch_up *c, void (*wake)(void *context), void *context);

typedef enum srv_catch_up_step {
    SRV_CATCH_UP_TEXT,  /* `text`, which was empty, has events */
    SRV_CATCH_UP_WAIT,  /* they are being made */
    SRV_CATCH_UP_DONE,  /* all were taken */
    SRV_CATCH_UP_FAILED /* the history does not reach back any more, or memory or jobs are out */
} srv_catch_up_step;

srv_catch_up_step srv_catch_up_take(srv_catch_up *c, api_text *text);

#endif
