/* event_follow.h - the events of a mesh as an answer without end (api/live.h).
 *
 * A stream first gives its opening messages. Then it gives the events that its listener missed,
 * from the queue of the mesh or from the history (event_backfill.h), or one `resync` if neither
 * reaches back that far. Then it gives events as they happen. */
#ifndef HE_API_EVENT_EVENT_FOLLOW_H
#define HE_API_EVENT_EVENT_FOLLOW_H

#include "api/event/event_backfill.h"
#include "api/live.h"
#include "store/followers.h"

/* Renders a change of a mesh as an event, for the listeners of the store (st_render). */
bool api_event_render(const st_mesh_info *info, const st_change *change, char **bytes,
                      size_t *length);

/* Opens a stream of the changes after `since`, or, if that is NULL, after the present revision. The
 * description of the mesh is copied to `info`. The caller frees the source.
 * Returns ST_ABSENT if the mesh was deleted.
 * Returns ST_LISTENERS if the mesh has too many listeners.
 * Returns ST_NO_MEMORY if memory is out. */
st_status api_event_follow(st_mesh *mesh, const st_since *since, api_backfills *backfills,
                           st_mesh_info *info, api_source *out);

#endif
