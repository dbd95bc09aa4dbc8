/* event_follow.h - the events of a mesh as an answer that goes on.
 *
 * A stream gives in turn what was prepared when it began, what its listener missed (from the queue
 * of the mesh, from the history (event_backfill.h) or, when neither reaches that far, one
 * `resync`), and what happens. */
#ifndef HE_API_EVENT_EVENT_FOLLOW_H
#define HE_API_EVENT_EVENT_FOLLOW_H

#include "api/event/event_backfill.h"
#include "api/live.h"
#include "store/followers.h"

/* The st_render of the store: a change as an event. */
bool api_event_render(const st_mesh_info *info, const st_change *change, char **bytes,
                      size_t *length);

/* The changes of a mesh as messages of events.h, from after `since`, or from the present revision,
 * whose facts go to `info`. The caller frees the source. ST_ABSENT, ST_LISTENERS, ST_NO_MEMORY. */
st_status api_event_follow(st_mesh *mesh, const st_since *since, api_backfills *backfills,
                           st_mesh_info *info, api_source *out);

#endif
