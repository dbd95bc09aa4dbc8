/* event_follow.h - the event stream of a mesh, an answer without a known end (api/live.h).
 *
 * A stream first sends its opening messages. Then it sends the events that the listener has missed,
 * from the mesh's queue of recent events or from the history (event_backfill.h), or one event
 * `resync` if neither reaches back that far. Then it sends events as they happen, and, whenever no
 * event is left to send, what other clients show of themselves (api/presence/presences.h). */
#ifndef HE_API_EVENT_EVENT_FOLLOW_H
#define HE_API_EVENT_EVENT_FOLLOW_H

#include "api/event/event_backfill.h"
#include "api/live.h"
#include "api/presence/presences.h"
#include "store/followers.h"

/* What all event streams of a service share. */
typedef struct api_event_shared {
    api_backfills *backfills;
    api_presences *presences;
} api_event_shared;

/* Renders a change of a mesh as an event. The store calls it (st_render) and passes the bytes to
 * the mesh's listeners. */
bool api_event_render(const st_mesh_info *info, const st_change *change, char **bytes,
                      size_t *length);

/* Opens a stream of the changes of a mesh after the revision in `since`, or after the present
 * revision if `since` has none. `info` gets the description of the mesh. The caller frees the
 * stream.
 * Returns ST_ABSENT if the mesh was deleted.
 * Returns ST_LISTENERS if the mesh has too many listeners.
 * Returns ST_NO_MEMORY if memory is out. */
st_status api_event_follow(st_mesh *mesh, const st_since *since, const api_event_shared *shared,
                           st_mesh_info *info, api_source *out);

#endif
